// Whether hard blows at the microphone put the page's candle out, in Chromium, with recorded breath.
//
//     wisp_verify_wind --blows blows.wav > blows.txt
//     node bench/blows.js blows.wav blows.txt         ends with status 1 when fewer than 95 % do, within 0.7 s

import { readFileSync } from 'node:fs';
import { resolve } from 'node:path';
import { chromiumPath, openBrowser, until } from '../tests/browser.js';

const [sound, list] = process.argv.slice(2);
const soon = 0.7;

if (chromiumPath === undefined) throw new Error('there is no Chromium here');
const blows = readFileSync(list, 'utf8')
  .trim()
  .split('\n')
  .map((line) => line.split(' '))
  .map(([at, rms, from]) => ({ at: Number(at), rms: Number(rms), from }));

const opened = await openBrowser(hears(resolve(sound)));
const page = await opened.page('#scene=candle&seed=1&noise=1&detail=0.3', { viewport: { width: 320, height: 280 } });
await page.evaluate(() => {
  // Timed by the sound itself: there are sixty frames of wind a second from when it listens. What is out
  // is lit again after a second.
  window.deaths = [];
  let out = 0;
  let pressed = false;
  setInterval(() => {
    const { burning, sound } = window.wisp;
    const now = sound.heard / 60;
    if (burning.lit === 1) [out, pressed] = [0, false];
    else if (out === 0) window.deaths.push((out = now));
    if (out > 0 && now > out + 1 && !pressed) {
      pressed = true;
      document.dispatchEvent(new KeyboardEvent('keydown', { key: 'l', code: 'KeyL', bubbles: true }));
    }
  }, 10);
});
await page.click('#blow');
const end = blows.at(-1).at + 2;
await until(page, 'all was blown', (seconds) => window.wisp.sound.heard / 60 > seconds, end, 1000 * (end + 60));
const deaths = await page.evaluate(() => window.deaths);
await opened.close();

// The fake microphone's sound begins a little before or after the page's: the first death tells by how much at most.
const late = Math.min(0.3, Math.max(0, (deaths[0] ?? 0) - blows[0].at - 0.2));
let out = 0;
for (const { at, rms, from } of blows) {
  const death = deaths.find((time) => time >= at - 0.2 && time <= at + late + soon);
  if (death !== undefined) out += 1;
  console.log(`${rms.toFixed(2)}  ${from.padEnd(28)} ${death === undefined ? 'burns on' : `out after ${(death - at).toFixed(2)} s`}`);
}
const other = deaths.length - out;
console.log(`${out} of ${blows.length} blows put it out within ${soon} s; ${other} times it went out otherwise`);
process.exitCode = out >= 0.95 * blows.length && other === 0 ? 0 : 1;
