// What people send to each other: a link that carries a model, a picture, three seconds; and what other pages take over.

import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { after, before, describe, it } from 'node:test';
import { chromiumPath, drop, openBrowser, openDrawer, until } from './browser.js';

const skip = chromiumPath === undefined && 'there is no Chromium here';
const bytesOf = (name) => readFileSync(new URL(`../public/models/${name}`, import.meta.url));

describe('sharing', { skip }, () => {
  let opened, page;
  before(async () => {
    opened = await openBrowser();
    page = await opened.page('#scene=candle&seed=3&detail=0.2');
  });
  after(() => opened?.close());

  it('a dropped flame fits in a link, and the link plays it bit for bit', async () => {
    const flame = bytesOf('flame-2.wisp');
    await drop(page, 'mine.wisp', flame);
    await until(page, 'it plays', () => /Playing mine.wisp/.test(document.getElementById('notices').textContent));
    await openDrawer(page);
    await page.click('[data-file=link]');
    await until(page, 'it says where the link is', () => /Copied|address/.test(document.querySelector('[data-file=link]').textContent));
    const link = page.url();
    assert.match(link, /model=packed/);
    assert.ok(link.length < 16_000, `${link.length} letters`);
    const other = await opened.page(link.slice(link.indexOf('#')));
    await openDrawer(other);
    const [download] = await Promise.all([other.waitForEvent('download'), other.click('[data-file=save]')]);
    assert.deepEqual(readFileSync(await download.path()), flame);
    assert.deepEqual(other.errors, []);
    await other.close();
  });

  it('a link that was cut says so, and the shipped flame burns', async () => {
    const cut = await opened.page('#scene=candle&detail=0.2&model=packed,AAAA');
    await until(cut, 'it says so', () => /this link is damaged/.test(document.getElementById('notices').textContent));
    assert.equal(await cut.evaluate(() => window.wisp.burning.lit), 1);
    await cut.close();
  });

  it('a link names a model of the same origin, and of no other', async () => {
    const own = await opened.page('#scene=candle&detail=0.2&model=./models/flame-6.wisp');
    await openDrawer(own);
    assert.match(await own.textContent('#drawer'), /Looks back6 steps/);
    await own.close();
    const far = await opened.page('#scene=candle&detail=0.2&model=https://example.com/flame.wisp');
    await until(far, 'it says so', () => /not of example.com/.test(document.getElementById('notices').textContent));
    assert.deepEqual(far.strangers, []);
    await far.close();
  });

  it('the round button copies a link to what plays', async () => {
    const plain = await opened.page('#scene=candle&seed=9&candles=5&detail=0.2');
    await plain.context().grantPermissions(['clipboard-read', 'clipboard-write']);
    await plain.click('#share');
    await until(plain, 'it says so', () => /link is copied/.test(document.getElementById('notices').textContent));
    const copied = await plain.evaluate(() => navigator.clipboard.readText());
    assert.match(copied, /candles=5/);
    assert.match(copied, /seed=9/);
    await plain.close();
  });

  it('a picture is saved, and three seconds that move', async () => {
    const [picture] = await Promise.all([page.waitForEvent('download'), page.click('[data-file=picture]')]);
    assert.deepEqual([...readFileSync(await picture.path()).subarray(1, 4)], [...Buffer.from('PNG')]);
    const [loop] = await Promise.all([page.waitForEvent('download'), page.click('[data-file=loop]')]);
    assert.match(loop.suggestedFilename(), /^wisp\.(webm|mp4)$/);
    const film = readFileSync(await loop.path());
    assert.ok(film.length > 1_000, `${film.length} bytes`);
    const [gif] = await Promise.all([page.waitForEvent('download'), page.click('[data-file=gif]')]);
    const bytes = readFileSync(await gif.path());
    assert.equal(bytes.subarray(0, 6).toString('latin1'), 'GIF89a');
    assert.ok(bytes.includes('NETSCAPE2.0'), 'it goes on for ever');
    // Its own blocks of timing: sixty pictures, of which a busy machine draws few anew.
    const pictures = bytes.toString('latin1').split('\x21\xf9\x04').slice(1);
    assert.equal(pictures.length, 60);
    assert.ok(new Set(pictures).size > 1, 'it moves');
  });

  it('as an overlay it shows what burns on nothing, and no control', async () => {
    const over = await opened.page('#overlay&scene=candle&seed=3&detail=0.5');
    await until(over, 'some pictures', () => window.wisp.frames > 8);
    assert.equal(await over.locator('button:visible').count(), 0);
    const alpha = await over.evaluate(
      () =>
        new Promise((resolve) => {
          const canvas = document.getElementById('stage');
          requestAnimationFrame(() => {
            const gl = canvas.getContext('webgl2');
            const at = (x, y) => {
              const out = new Uint8Array(4);
              gl.readPixels(Math.round(x * canvas.width), Math.round(y * canvas.height), 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, out);
              return out[3];
            };
            resolve({ corner: at(0.03, 0.97), wax: at(0.5, 0.4) });
          });
        }),
    );
    assert.ok(alpha.corner < 20, `corner ${alpha.corner}`);
    assert.equal(alpha.wax, 255);
    await over.close();
  });

  it("as an overlay a cake's candles fill the picture, with no room left for the cake", async () => {
    const over = await opened.page('#overlay&scene=candle&candles=7&detail=0.2');
    await until(over, 'a picture', () => window.wisp.firstPicture > 0);
    await until(over, 'seven candles', () => window.wisp.burning?.of === 7);
    const left = await over.evaluate(
      () =>
        new Promise((resolve) => {
          requestAnimationFrame(() => {
            const canvas = document.getElementById('stage');
            const gl = canvas.getContext('webgl2');
            const { width, height } = canvas;
            const picture = new Uint8Array(4 * width * height);
            gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, picture);
            let leftmost = width;
            for (let k = 0; k < width * height; ++k) if (picture[4 * k + 3] === 255) leftmost = Math.min(leftmost, k % width);
            resolve(leftmost / width);
          });
        }),
    );
    assert.ok(left < 0.25, `the leftmost wax is at ${left} of the picture's width`);
    await over.close();
  });

  it('made no error, and asked no other host', () => assert.deepEqual([page.errors, page.strangers], [[], []]));
});
