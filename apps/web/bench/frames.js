// Measures the milliseconds per frame of the page's own work (models, poses, data for the graphics card) with one
// candle, a cake, one leaf and 400 leaves, and the time to the first picture.
//
//     npm run bench --workspace apps/web [-- SECONDS]      seconds per scene; default 6
//
// Pictures are small (detail 0.02), and instanced draw calls, those of leaves, do nothing: without a graphics card the
// processor would draw every instance, which is not the page's work.

import { openBrowser, skip, until } from '../tests/browser.js';

const seconds = Number(process.argv[2] ?? 6);
const scenes = [
  ['one candle', '#scene=candle', 1],
  ['a cake of 12', '#scene=candle&candles=12', 12],
  ['1 leaf', '#scene=leaves&leaves=1', 1],
  ['400 leaves', '#scene=leaves&leaves=400', 400],
];

if (skip) throw new Error(skip);

function drawNoLeaves() {
  for (const call of ['drawElementsInstanced', 'drawArraysInstanced']) WebGL2RenderingContext.prototype[call] = () => {};
}

function quantile(values, share) {
  const sorted = [...values].sort((a, b) => a - b);
  return sorted[Math.min(sorted.length - 1, Math.floor(share * sorted.length))] ?? NaN;
}

const opened = await openBrowser();
console.log('scene            first picture ms   update ms: median  95 %   draw ms: median  95 %   frames');
for (const [name, hash, many] of scenes) {
  const page = await opened.page(`${hash}&seed=1&detail=0.02`, { before: drawNoLeaves });
  await until(page, `${name} complete`, (count) => (window.wisp.leaves?.count ?? window.wisp.burning?.of) >= count, many, 300_000);
  const from = await page.evaluate(() => window.wisp.frames);
  await page.waitForTimeout(1000 * seconds);
  const { costs, frames, first } = await page.evaluate(() => ({ costs: window.wisp.costs(), frames: window.wisp.frames, first: window.wisp.firstPicture }));
  const counted = costs.slice(-Math.min(costs.length, frames - from));
  const figure = (part, share) => quantile(counted.map((cost) => cost[part]), share).toFixed(2).padStart(6);
  console.log(
    `${name.padEnd(16)} ${first.toFixed(0).padStart(16)} ${figure('update', 0.5).padStart(19)} ${figure('update', 0.95)}` +
      ` ${figure('draw', 0.5).padStart(16)} ${figure('draw', 0.95)} ${String(frames - from).padStart(7)}`,
  );
  await page.close();
}
await opened.close();
