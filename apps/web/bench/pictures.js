// Takes pictures of every state of the page, as on a phone, a laptop and a large screen. No test compares them.
//
//     npm run pictures --workspace apps/web -- FOLDER [STATE…] [--size 390x844]…      default: all states, all sizes

import { mkdirSync } from 'node:fs';
import { join } from 'node:path';
import { blowOut, framesPass, openBrowser, skip } from '../tests/browser.js';

const args = process.argv.slice(2);
const sizes = [];
for (let k = args.indexOf('--size'); k >= 0; k = args.indexOf('--size')) sizes.push(args.splice(k, 2)[1]);
const [folder, ...wanted] = args;
if (folder === undefined) throw new Error('which folder do the pictures go to?');
if (sizes.length === 0) sizes.push('390x844', '1280x800', '2560x1440');

const pass = (page, seconds) => page.waitForTimeout(1000 * seconds);
/** Per state: the link, and the actions before its picture is taken. */
const states = {
  candle: ['#scene=candle', (page) => pass(page, 2)],
  lean: ['#scene=candle', async (page) => {
    await page.focus('#stage');
    await page.keyboard.down('ArrowRight');
    await pass(page, 1.2);
  }],
  smoke: ['#scene=candle', async (page) => { await blowOut(page); await pass(page, 1.2); }],
  dark: ['#scene=candle', async (page) => { await blowOut(page); await pass(page, 4); }],
  match: ['#scene=candle', async (page) => { await blowOut(page); await pass(page, 1); await page.keyboard.press('l'); await pass(page, 0.7); }],
  cake: ['#scene=candle&candles=12', (page) => pass(page, 2)],
  wish: ['#scene=candle&candles=12', async (page) => { await blowOut(page); await pass(page, 1.5); }],
  after: ['#scene=candle&candles=12', async (page) => { await blowOut(page); await pass(page, 3.5); }],
  leaves: ['#scene=leaves', (page) => pass(page, 1.5)],
  many: ['#scene=leaves&leaves=10000', (page) => pass(page, 6)],
  drawer: ['#scene=candle', async (page) => { await page.click('#open-drawer'); await pass(page, 2); }],
  day: ['#scene=candle', async (page) => { await page.emulateMedia({ colorScheme: 'light' }); await page.click('#open-drawer'); await pass(page, 2); }],
  turned: ['#scene=candle&candles=7&name=Ada', async (page) => { await page.focus('#stage'); for (let k = 0; k < 4; ++k) await page.keyboard.press('.'); await pass(page, 1); }],
  overlay: ['#overlay&scene=candle&candles=7', (page) => pass(page, 2)],
  help: ['#scene=candle', async (page) => { await page.click('#open-help'); await pass(page, 0.5); }],
};

if (skip) throw new Error(skip);
mkdirSync(folder, { recursive: true });
const opened = await openBrowser();
for (const size of sizes) {
  const [width, height] = size.split('x').map(Number);
  for (const name of wanted.length > 0 ? wanted : Object.keys(states)) {
    const [hash, act] = states[name];
    // Low detail until the state is reached, so that frames are fast without a graphics card; then full detail.
    const page = await opened.page(`${hash}&seed=3&detail=0.1`, { viewport: { width, height } });
    await act(page);
    await page.evaluate(() => {
      location.hash += '&detail=1';
      location.hash = location.hash.replace('detail=0.1&', '');
    });
    await framesPass(page);
    await page.screenshot({ path: join(folder, `${name}-${size}.png`), timeout: 120_000 });
    const costs = await page.evaluate(() => window.wisp.costs());
    const mean = costs.reduce((sum, { update, draw }) => sum + update + draw, 0) / costs.length;
    console.log(`${name}-${size}: ${costs.length} frames, ${mean.toFixed(2)} ms of ours each${page.errors.length ? `, ERRORS ${page.errors.join('; ')}` : ''}`);
    await page.close();
  }
}
await opened.close();
