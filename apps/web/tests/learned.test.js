// What the page says of models, and what it makes of one that has never felt wind.
// tests/models/calm.wisp: 15 s of the simulated candle without any wind (WindKind::kCalm, seed 2), without its sound, through `wisp learn flame`.

import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { after, before, describe, it } from 'node:test';
import { chromiumPath, drop, openBrowser, openDrawer, until } from './browser.js';

const skip = chromiumPath === undefined && 'there is no Chromium here';
const calm = readFileSync(new URL('models/calm.wisp', import.meta.url));

const noticed = (page, words) => until(page, `it says ${words}`, (source) => new RegExp(source).test(document.getElementById('notices').textContent), words);
const hold = async (page, code, what, holds) => {
  await page.focus('#stage');
  await page.keyboard.down(code);
  await until(page, what, holds);
  await page.keyboard.up(code);
};

describe('what was learned', { skip }, () => {
  let opened, page;
  before(async () => {
    opened = await openBrowser(['--autoplay-policy=no-user-gesture-required']);
    page = await opened.page('#scene=candle&seed=3&detail=0.1');
    await openDrawer(page);
  });
  after(() => opened?.close());

  it('says that the simulator taught the shipped flame, and claims no film', async () => {
    const said = await page.textContent('.introduction');
    assert.match(said, /taught by the candle simulator/);
    assert.doesNotMatch(said, /fitted to a film/);
  });

  it('says figures in words, with units and what a good one is', async () => {
    const figures = await page.textContent('.figures');
    for (const words of [/Fit of the tip, one frame ahead.{30,50}9\d\.\d %/, /Overlap of the outlines.*good: 85 % or more9\d/, /Largest pole.*0\.8/, /cross themselves/, /217 px/, /played freely/]) assert.match(figures, words);
    assert.doesNotMatch(figures, /fpe|fit\.1|sd_ratio|rows|share/);
  });

  it('keeps figures on one line each', async () => {
    const heights = await page.$$eval('.figures dd', (cells) => cells.map((cell) => cell.getBoundingClientRect().width));
    assert.ok(heights.every((width) => width > 10), heights.join());
  });

  it('saves the last minute as a table', async () => {
    const frames = await page.evaluate(() => window.wisp.frames);
    await until(page, 'some frames', (before) => window.wisp.frames > before + 3, frames);
    const [download] = await Promise.all([page.waitForEvent('download'), page.click('[data-file=csv]')]);
    assert.equal(download.suggestedFilename(), 'wisp.csv');
    const [head, ...rows] = readFileSync(await download.path(), 'utf8').trim().split('\n');
    assert.equal(head, 'time,wind,"tip, sideways"');
    assert.ok(rows.length > 2);
    const times = rows.map((row) => Number(row.split(',')[0]));
    assert.ok(times.every((time, k) => k === 0 || time >= times[k - 1]));
    assert.ok(rows.every((row) => row.split(',').length === 3));
  });

  it('shows three orders and one without noise in the same wind, and puts them away', async () => {
    await page.click('[data-knob=lesson]');
    await until(page, 'four flames', () => document.querySelectorAll('.lesson canvas').length === 4);
    const widest = () =>
      page.$$eval('.lesson canvas', (all) =>
        all.map((canvas) => {
          // How far to the right of the middle a flame's colour is found.
          const { data } = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height * 0.7);
          let right = 0;
          for (let k = 0; k < data.length; k += 4) if (data[k] > 200) right = Math.max(right, (k / 4) % canvas.width);
          return right;
        }),
      );
    await until(page, 'they are drawn', () => document.querySelector('.lesson canvas').getContext('2d').getImageData(75, 140, 1, 1).data[0] > 200);
    const still = await widest();
    await page.focus('#stage');
    await page.keyboard.down('ArrowRight');
    await until(page, 'wind', () => window.wisp.answer > 0.3);
    const blown = await widest();
    await page.keyboard.up('ArrowRight');
    assert.ok(blown.every((right, k) => right > still[k] + 8), `${still} ${blown}`);
    await page.click('[data-knob=lesson]');
    assert.equal(await page.locator('.lesson').count(), 0);
  });

  it('makes sound when it is asked to, and is quiet again', async () => {
    const pressed = () => page.getAttribute('[data-knob=senses]', 'aria-pressed');
    assert.equal(await pressed(), 'false');
    await page.click('[data-knob=senses]');
    assert.equal(await pressed(), 'true');
    await page.focus('#stage');
    await page.keyboard.press('a');
    assert.equal(await pressed(), 'false');
  });

  it('offers its answer to wind to a flame that has none, and says that it is borrowed', async () => {
    await drop(page, 'calm.wisp', calm);
    await noticed(page, 'Playing calm.wisp');
    assert.match(await page.textContent('.introduction'), /learned from mute.mp4 by wisp.*never felt wind|learned from mute.mp4 by wisp.*no input/s);
    await hold(page, 'ArrowRight', 'it is offered', () => /calm.wisp was learned without wind/.test(document.getElementById('notices').textContent));
    assert.equal(await page.evaluate(() => window.wisp.burning.lit), 1);
    await page.click('.notice .tool');
    await until(page, 'it is said to be borrowed', () => /borrowed from the flame/.test(document.querySelector('.introduction').textContent));
    await hold(page, 'ArrowRight', 'it leans', () => window.wisp.answer > 0.15);
    await hold(page, 'Space', 'it goes out', () => window.wisp.burning.lit === 0);
    await page.keyboard.press('l');
    await until(page, 'it burns again', () => window.wisp.burning.lit === 1);
  });

  it('keeps messages beside the drawer', async () => {
    await openDrawer(page);
    await page.setViewportSize({ width: 1280, height: 800 });
    await drop(page, 'letter.txt', Buffer.from('Dear Sir'));
    await noticed(page, 'letter.txt');
    const [notice, drawer] = await page.evaluate(() => ['.notice', '#drawer'].map((name) => document.querySelector(name).getBoundingClientRect().toJSON()));
    assert.ok(notice.right <= drawer.left, `${notice.right} ${drawer.left}`);
    const words = await page.$$eval('.notice p', (all) => all.map((one) => one.textContent));
    assert.ok(words.every((text) => /[.!?]$/.test(text) && !/[^.!?] What plays/.test(text)), words.join(' | '));
  });

  it('made no error and asked no other host', () => assert.deepEqual([page.errors, page.strangers], [[], []]));
});
