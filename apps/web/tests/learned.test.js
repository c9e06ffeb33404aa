// What the page says about models, and how it plays one that was learned without wind.
// models/calm.wisp: by `wisp learn flame` from 15 s of the simulated candle without wind (kCalm, seed 2) or sound.

import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { describe, it } from 'node:test';
import { drop, hold, loud, onPage, openDrawer, says, skip, until } from './browser.js';

const calm = readFileSync(new URL('models/calm.wisp', import.meta.url));

describe('what was learned', { skip }, () => {
  let page;
  onPage('#scene=candle&seed=3&detail=0.1', (made) => openDrawer((page = made)), { flags: () => [loud] });

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

  it('offers its answer to wind to a flame that has none, and says that it is borrowed', async () => {
    await drop(page, 'calm.wisp', calm);
    await says(page, '#notices', 'Playing calm.wisp');
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
    await says(page, '#notices', 'letter.txt');
    const [notice, drawer] = await page.evaluate(() => ['.notice', '#drawer'].map((name) => document.querySelector(name).getBoundingClientRect().toJSON()));
    assert.ok(notice.right <= drawer.left, `${notice.right} ${drawer.left}`);
    const words = await page.$$eval('.notice p', (all) => all.map((one) => one.textContent));
    assert.ok(words.every((text) => /[.!?]$/.test(text) && !/[^.!?] What plays/.test(text)), words.join(' | '));
  });

  it('says what is missing where a part does not arrive, and does not blame the model', async () => {
    await page.route(/assets\/scene-/, (route) => route.fulfill({ contentType: 'text/javascript', body: 'throw 1' }));
    await drop(page, 'leaf.wisp', readFileSync(new URL('../public/models/leaf.wisp', import.meta.url)));
    await says(page, '#notices', '(^|×)A piece of this page could not be fetched');
  });
});
