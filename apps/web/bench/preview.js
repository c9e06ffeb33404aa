// Makes the pictures that represent the page elsewhere: icons from icon.svg and, from the page itself, the preview in
// messages and the README's animation, in which the shipped flame burns, is blown out, smokes, and is lit again.
//
//     npm run preview --workspace apps/web        after script/web build; then build once more

import { execFileSync } from 'node:child_process';
import { mkdtempSync, readdirSync, readFileSync, rmSync, statSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { openBrowser } from '../tests/browser.js';

const published = (name) => fileURLToPath(new URL(`../public/${name}`, import.meta.url));
const README = fileURLToPath(new URL('../../../docs/pictures/blown-out.webp', import.meta.url));
const MOST_BYTES = 1_000_000;
/** CSS pixels that the page keeps free for its controls below the picture. */
const COVERED = 118;
const RATE = 15;
/** Times of the actions in the animation, seconds. */
const ACTS = { blow: 1.2, breathe: 2, light: 4.4, end: 6.6 };

/** Runs in the page: time advances by calls of step(), so that a slow machine films what a fast one shows. */
function steps() {
  const real = window.requestAnimationFrame.bind(window);
  let waiting = [];
  let clock = 0;
  window.requestAnimationFrame = (act) => waiting.push(act);
  window.cancelAnimationFrame = () => undefined;
  window.step = (seconds) => {
    clock += 1000 * seconds;
    const now = waiting;
    waiting = [];
    for (const act of now) act(clock);
    return new Promise((drawn) => real(() => drawn(window.wisp?.frames ?? 0)));
  };
  const free = setInterval(() => window.wisp?.firstPicture > 0 ? clearInterval(free) : window.step(1 / 60), 30);
}

const opened = await openBrowser();
const open = async (hash, width, height) => {
  const page = await opened.page(hash, { viewport: { width, height: height + COVERED }, bypassCSP: true, before: steps });
  await page.addStyleTag({ content: 'body > :not(#stage) { display: none !important; }' });
  // Low detail while the scene settles, then full detail for the pictures that are kept.
  const pass = async (seconds) => {
    for (let k = 0; k < seconds * 30; ++k) await page.evaluate(() => window.step(1 / 30));
  };
  const fine = async () => {
    await page.evaluate(() => (location.hash = location.hash.replace('detail=0.1', 'detail=1')));
    await page.waitForTimeout(300);
    await page.evaluate(() => window.step(1 / 60));
  };
  await page.waitForFunction(() => window.wisp.firstPicture > 0);
  await page.waitForTimeout(3000);
  await pass(2);
  await fine();
  return { page, clip: { x: 0, y: 0, width, height } };
};

async function icons() {
  const svg = readFileSync(published('icon.svg'), 'utf8');
  for (const side of [180, 192, 512]) {
    const page = await opened.browser.newPage({ viewport: { width: side, height: side } });
    await page.setContent(`<style>body { margin: 0; background: #0b0b11 } svg { display: block }</style>${svg}`);
    await page.screenshot({ path: published(`icon-${side}.png`) });
    await page.close();
  }
}

async function inMessages() {
  const { page, clip } = await open('#scene=candle&seed=3&candles=5&detail=0.1', 1200, 630);
  await page.screenshot({ path: published('preview.jpg'), type: 'jpeg', quality: 84, clip, timeout: 180_000 });
  await page.close();
}

/**
 * Joins pictures into one endlessly repeated WebP of whole frames: encoders of differences leave visible rectangles in
 * dark pictures. Container: https://developers.google.com/speed/webp/docs/riff_container
 */
function animated(pictures, width, height) {
  const chunk = (name, ...parts) => {
    const body = Buffer.concat(parts);
    const head = Buffer.alloc(8);
    head.write(name);
    head.writeUInt32LE(body.length, 4);
    return Buffer.concat([head, body, Buffer.alloc(body.length % 2)]);
  };
  const size = Buffer.alloc(6);
  size.writeUIntLE(width - 1, 0, 3);
  size.writeUIntLE(height - 1, 3, 3);
  const lasts = Buffer.alloc(4);
  lasts.writeUIntLE(Math.round(1000 / RATE), 0, 3);
  lasts[3] = 2;  // nothing of the frame before shows through
  const frames = pictures.map((picture) => chunk('ANMF', Buffer.alloc(6), size, lasts, picture.subarray(12)));
  return chunk('RIFF', Buffer.from('WEBP'), chunk('VP8X', Buffer.from([2, 0, 0, 0]), size), chunk('ANIM', Buffer.alloc(6)), ...frames);
}

async function moving() {
  const folder = mkdtempSync(join(tmpdir(), 'wisp-preview-'));
  const { page, clip } = await open('#scene=candle&seed=3&detail=0.1', 540, 420);
  await page.focus('#stage');
  for (let k = 0; k < ACTS.end * RATE; ++k) {
    const at = k / RATE;
    if (at === ACTS.blow) await page.keyboard.down('Space');
    if (at === ACTS.breathe) await page.keyboard.up('Space');
    if (at === ACTS.light) await page.keyboard.press('l');
    await page.evaluate((seconds) => window.step(seconds), 1 / RATE);
    await page.screenshot({ path: join(folder, `${String(k).padStart(4, '0')}.png`), clip, timeout: 180_000 });
  }
  for (let quality = 80; ; quality -= 10) {
    execFileSync('ffmpeg', ['-y', '-loglevel', 'error', '-i', join(folder, '%04d.png'), '-c:v', 'libwebp', '-pix_fmt', 'yuv420p', '-q:v', String(quality), join(folder, '%04d.webp')]);
    const frames = readdirSync(folder).filter((name) => name.endsWith('.webp')).sort();
    writeFileSync(README, animated(frames.map((name) => readFileSync(join(folder, name))), clip.width, clip.height));
    if (statSync(README).size <= MOST_BYTES || quality < 30) break;
  }
  rmSync(folder, { recursive: true });
  await page.close();
}

const wanted = process.argv.slice(2);
for (const [name, make] of Object.entries({ icons, inMessages, moving })) {
  if (wanted.length > 0 && !wanted.includes(name)) continue;
  await make();
  console.log(`${name}: made`);
}
await opened.close();
for (const name of ['preview.jpg', 'icon-180.png', 'icon-192.png', 'icon-512.png']) console.log(`${name}: ${statSync(published(name)).size} bytes`);
console.log(`${README}: ${statSync(README).size} bytes`);
