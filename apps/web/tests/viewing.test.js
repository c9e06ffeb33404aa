// The viewing test, in Chromium: twenty pairs, the share of right answers, and the saved file.

import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { describe, it } from 'node:test';
import { onPage, openDrawer, painted, saved, seen, skip, until } from './browser.js';

describe('which one was filmed', { skip }, () => {
  let page;
  onPage('#scene=candle&seed=3&detail=0.05', async (made) => {
    page = made;
    await openDrawer(page);
    await page.$eval('[data-file=viewing]', (button) => [button, button].forEach((pressed) => pressed.click())); // twice, as on a slow network
    await until(page, 'the first pair', () => document.querySelector('.viewing[open]') !== null);
  }, { viewport: { width: 390, height: 700 } });

  it('shows two flames that both move, in the same drawing', async () => {
    const pictures = () => page.$$eval('.viewing canvas', (all) => all.map((canvas) => canvas.toDataURL()));
    // Both canvases show a flame.
    await seen('both burn', async () => (await painted(page, '.viewing canvas', 'bright')).every((bright) => bright > 150));
    const before = await pictures();
    await seen('both move', async () => (await pictures()).every((picture, k) => picture !== before[k]));
    assert.ok(await page.$eval('.viewing', (dialog) => dialog.scrollWidth <= dialog.clientWidth));
  });

  it('asks twenty times, by button or arrow, says the share with its interval, and gives the answers away', async () => {
    for (let k = 0; k < 20; ++k) {
      await until(page, `question ${k + 1}`, (count) => document.getElementById('viewing-title').textContent === `Which one was filmed? ${count} of 20`, k + 1);
      if (k % 2 === 0) await page.click('[data-side=left]');
      else await page.keyboard.press('ArrowLeft');
    }
    assert.match(await page.textContent('#viewing-title'), /^\d+ of 20 were right$/);
    const download = await saved(page, '[data-file=answers]');
    const file = JSON.parse(readFileSync(await download.path(), 'utf8'));
    assert.equal(file.answers.length, 20);
    assert.equal(new Set(file.answers.map(({ pair }) => pair)).size, 20, 'no pair twice');
    assert.equal(file.right, file.answers.filter(({ filmed }) => filmed === 'left').length);
    // Wilson's interval, checked by its equation: its ends solve (p - share)^2 = z^2 p (1 - p) / n.
    for (const p of file.interval_95) assert.ok(Math.abs((p - file.share) ** 2 - (1.96 ** 2 * p * (1 - p)) / 20) < 1e-9, JSON.stringify(file.interval_95));
    const words = await page.textContent('.viewing p');
    const sees = file.interval_95[0] > 0.5 || file.interval_95[1] < 0.5;
    assert.match(words, sees ? /see a difference/ : /tossed a coin/);
    assert.deepEqual(page.errors, []);
  });
});
