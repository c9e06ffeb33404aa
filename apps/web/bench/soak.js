// Checks that memory stays flat: leaves and a cake run, wind comes and goes, and the collected heap is measured.
//
//     npm run soak --workspace apps/web [-- MINUTES]      default 10; status 1 if the heap grew by over 10 %

import { openBrowser, skip } from '../tests/browser.js';

const minutes = Number(process.argv[2] ?? 10);
const looks = 12;

if (skip) throw new Error(skip);

async function heap(session) {
  await session.send('HeapProfiler.collectGarbage');
  const { metrics } = await session.send('Performance.getMetrics');
  return metrics.find(({ name }) => name === 'JSHeapUsedSize').value;
}

const opened = await openBrowser();
const page = await opened.page('#scene=leaves&leaves=500&seed=1&detail=0.05');
const session = await page.context().newCDPSession(page);
await session.send('Performance.enable');
const seen = [];
for (let look = 0; look <= looks; ++look) {
  // Every kind of action: other scenes, blowing, lighting, the drawer, other models.
  for (const key of look % 2 === 0 ? ['2', 'i', 'l', 'i'] : ['1', '+', 'l', 'i', 'n', 'i', '-']) await page.keyboard.press(key);
  await page.focus('#stage');
  await page.keyboard.down('Space');
  await page.waitForTimeout(1000);
  await page.keyboard.up('Space');
  await page.keyboard.press('2');
  await page.waitForTimeout((60_000 * minutes) / (looks + 1) - 1000);
  const now = await heap(session);
  seen.push(now);
  console.log(`${((look + 1) * minutes / (looks + 1)).toFixed(1).padStart(5)} min   heap ${(now / 1e6).toFixed(2)} MB`);
}
await opened.close();

const mean = (list) => list.reduce((sum, used) => sum + used, 0) / list.length;
const grown = mean(seen.slice(-4)) / mean(seen.slice(2, 6)) - 1;
console.log(`heap ${grown > 0 ? 'grew' : 'shrank'} by ${Math.abs(100 * grown).toFixed(1)} %`);
process.exitCode = grown > 0.1 ? 1 : 0;
