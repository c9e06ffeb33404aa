// What people send to each other: a link with a model, a picture, a film; and the overlay for other programs.

import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { describe, it } from 'node:test';
import { blowOut, drop, framesPass, onPage, openCard, openDrawer, saved, says, skip, until } from './browser.js';

const clipboard = ['clipboard-read', 'clipboard-write'];
const bytesOf = (name) => readFileSync(new URL(`../public/models/${name}`, import.meta.url));

/** The canvas's next frame: red, green, blue, opacity of each pixel, from the lower left. */
async function canvasOf(page) {
  const [text, width, height] = await page.evaluate(
    () =>
      new Promise((resolve) =>
        requestAnimationFrame(() => {
          const canvas = document.getElementById('stage');
          const { width, height } = canvas;
          const gl = canvas.getContext('webgl2');
          const picture = new Uint8Array(4 * width * height);
          gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, picture);
          let text = '';
          for (let at = 0; at < picture.length; at += 4096) text += String.fromCharCode(...picture.subarray(at, at + 4096));
          resolve([btoa(text), width, height]);
        }),
      ),
  );
  return { picture: Buffer.from(text, 'base64'), width, height };
}

describe('sharing', { skip }, () => {
  let opened, page;
  onPage('#scene=candle&seed=3&detail=0.2', (...made) => ([page, opened] = made));

  it('a dropped flame fits in a link, and the link plays it bit for bit', async () => {
    const flame = bytesOf('flame-2.wisp');
    await drop(page, 'mine.wisp', flame);
    await until(page, 'it plays', () => /Playing mine.wisp/.test(document.getElementById('notices').textContent));
    await openCard(page);
    await page.fill('#card-name', 'Ada');
    await page.click('[data-file=send]');
    await until(page, 'it says where the link is', () => /Copied|address/.test(document.querySelector('[data-file=send]').textContent));
    const link = page.url();
    assert.match(link, /model=packed/);
    assert.ok(link.length < 16_000, `${link.length} letters`);
    const other = await opened.page(link.slice(link.indexOf('#')));
    await openDrawer(other);
    const download = await saved(other, '[data-file=save]');
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

  it('the round button opens what something is made with, and copies a link to it', async () => {
    const plain = await opened.page('#scene=candle&seed=9&detail=0.2', { permissions: clipboard });
    await openCard(plain);
    await plain.fill('#card-name', 'Ada');
    await plain.fill('#card-from', 'Ben');
    await plain.fill('#card-wish', 'Happy birthday, dear Ada!');
    await plain.fill('#card-age', '36');
    await until(plain, '36 candles', () => window.wisp.burning.of === 36);
    await plain.check('#card-figures');
    await until(plain, 'two figures', () => window.wisp.burning.of === 2);
    await plain.click('[data-file=send]');
    await until(plain, 'it says so', () => document.querySelector('[data-file=send]').textContent === 'Copied');
    const copied = new URL(await plain.evaluate(() => navigator.clipboard.readText()));
    const said = Object.fromEntries(new URLSearchParams(copied.hash.slice(1)));
    assert.deepEqual({ ...said, detail: undefined }, { scene: 'candle', seed: '9', candles: '36', age: '36', name: 'Ada', from: 'Ben', wish: 'Happy birthday, dear Ada!', detail: undefined });
    assert.deepEqual(plain.errors, []);
    await plain.close();
  });

  it('whoever gets it blows it out, reads the wish, and sends one back by one button', async () => {
    const got = await opened.page('#scene=candle&seed=9&age=7&name=Ada&from=Ben&wish=Happy+birthday&detail=0.2', { permissions: clipboard });
    assert.match(await got.getAttribute('#stage', 'aria-label'), /A cake for Ada with candles that say 7/);
    assert.equal(await got.textContent('#greeting'), 'from Ben');
    assert.equal(await got.isVisible('#back'), false);
    await blowOut(got);
    await until(got, 'the wish', () => document.getElementById('greeting').textContent === 'Happy birthday');
    await until(got, 'all is here', () => document.querySelector('#card button') !== null);
    await got.click('#back');
    await until(got, 'it says so', () => /your thanks in its smoke/.test(document.getElementById('notices').textContent));
    const back = new URLSearchParams(new URL(await got.evaluate(() => navigator.clipboard.readText())).hash.slice(1));
    assert.deepEqual([back.get('name'), back.get('from'), back.get('wish'), back.get('age')], ['Ben', 'Ada', 'Thank you', null]);
    assert.deepEqual(got.errors, []);
    await got.close();
  });

  it('smoke writes the wish: where letters are there is light', async () => {
    const dense = async (wish) => {
      const got = await opened.page(`#scene=candle&seed=9&noise=0&detail=0.25${wish}`, { viewport: { width: 480, height: 480 } });
      await until(got, 'the air is here', () => window.wisp.firstPicture > 0 && document.querySelector('#card button') !== null && window.wisp.frames > 20);
      await blowOut(got);
      // At least 25 frames, as a frame advances the scene by at most a tenth of a second.
      await Promise.all([got.waitForTimeout(2500), framesPass(got, 25)]);
      const { picture, width, height } = await canvasOf(got);
      // Left of the wick, where no other smoke is.
      let [sum, many] = [0, 0];
      for (let k = Math.round(0.6 * height) * width; k < Math.round(0.9 * height) * width; ++k) {
        if (k % width < 0.12 * width || k % width > 0.36 * width) continue;
        sum += picture[4 * k + 2];
        many += 1;
      }
      const light = sum / many;
      await got.close();
      return light;
    };
    const [plain, written] = [await dense(''), await dense('&wish=A+WISH+COMES+TRUE')];
    assert.ok(written > 1.15 * plain, `light ${written}, without a wish ${plain}`);
  });

  it('a tune sounds only when somebody asks for it, and ends when all is out', async () => {
    const before = () => {
      window.notes = 0;
      const real = OscillatorNode.prototype.start;
      OscillatorNode.prototype.start = function (...when) {
        window.notes += 1;
        return real.apply(this, when);
      };
    };
    const sung = await opened.page('#scene=candle&candles=3&tune=1&detail=0.2', { before });
    await until(sung, 'all is here', () => document.querySelector('#card button') !== null);
    assert.equal(await sung.evaluate(() => window.notes), 0);
    await sung.click('#tune-play');
    assert.ok((await sung.evaluate(() => window.notes)) > 70);
    assert.equal(await sung.getAttribute('#tune-play', 'aria-pressed'), 'true');
    await blowOut(sung);
    await until(sung, 'it is silent', () => document.getElementById('tune-play').getAttribute('aria-pressed') === 'false');
    assert.deepEqual(sung.errors, []);
    await sung.close();
  });

  it('a preference for less motion is in nobody else\'s link', async () => {
    const calm = await opened.page('#scene=candle&seed=9&detail=0.2', { reducedMotion: 'reduce', permissions: clipboard });
    await openCard(calm);
    await calm.click('[data-file=send]');
    await until(calm, 'it says so', () => document.querySelector('[data-file=send]').textContent === 'Copied');
    assert.doesNotMatch(await calm.evaluate(() => navigator.clipboard.readText()), /noise|leaves=/);
    // With that preference there is a button, for a finger too, that pauses the scene.
    assert.equal(await calm.isVisible('#pause'), true);
    await calm.click('#pause');
    const wick = () => calm.evaluate(() => window.wisp.answer);
    const still = await wick();
    await calm.waitForTimeout(600);
    assert.equal(await wick(), still);
    await calm.click('#pause');
    await until(calm, 'it goes on', (before) => window.wisp.answer !== before, still);
    await calm.close();
  });

  it('shows a card where its link is pasted: title, words, and a picture that is there', async () => {
    const html = await (await fetch(opened.address)).text();
    const told = Object.fromEntries([...html.matchAll(/<meta (?:property|name)="(og:[^"]+|twitter:card|description)" content="([^"]+)"/g)].map(([, name, words]) => [name, words]));
    assert.equal(told['twitter:card'], 'summary_large_image');
    assert.ok(told['og:title'].length < 60 && told['og:description'].length < 160, JSON.stringify(told));
    const picture = Buffer.from(await (await fetch(new URL(told['og:image'], opened.address))).arrayBuffer());
    assert.ok(picture.length > 10_000 && picture.length < 300_000, `${picture.length} bytes`);
    const shown = await opened.browser.newPage();
    await shown.setContent(`<img src="data:image/jpeg;base64,${picture.toString('base64')}">`);
    assert.deepEqual(await shown.$eval('img', (image) => image.decode().then(() => [image.naturalWidth, image.naturalHeight])), [1200, 630]);
    await shown.close();
    for (const [, address] of html.matchAll(/<link rel="(?:icon|apple-touch-icon|manifest)" href="([^"]+)"/g)) assert.equal((await fetch(new URL(address, opened.address))).status, 200, address);
  });

  it('a picture is saved, and a film and a GIF in which it is blown out', async () => {
    await page.evaluate(() => (location.hash = '#scene=candle&seed=3&detail=0.2'));
    if (await page.evaluate(() => document.getElementById('card').hidden)) await openCard(page);
    const picture = await saved(page, '[data-file=picture]');
    assert.deepEqual([...readFileSync(await picture.path()).subarray(1, 4)], [...Buffer.from('PNG')]);
    const wasOut = page.evaluate(
      () =>
        new Promise((resolve) => {
          const look = () => (window.wisp.burning.lit === 0 ? resolve(true) : requestAnimationFrame(look));
          look();
        }),
    );
    const [loop] = await Promise.all([saved(page, '[data-file=loop]'), wasOut.then(() => page.evaluate(() => (location.hash = '#scene=candle&seed=4&detail=0.2')))]);
    assert.match(loop.suggestedFilename(), /^wisp\.(webm|mp4)$/);
    const film = readFileSync(await loop.path());
    assert.ok(film.length > 1_000, `${film.length} bytes`);
    assert.equal(await wasOut, true, 'it was blown out while it was filmed');
    await until(page, 'it burns again', () => window.wisp.burning.lit === 1);
    const gif = await saved(page, '[data-file=gif]');
    const bytes = readFileSync(await gif.path());
    assert.equal(bytes.subarray(0, 6).toString('latin1'), 'GIF89a');
    assert.ok(bytes.includes('NETSCAPE2.0'), 'it goes on for ever');
    // Each picture has a graphic control extension: 130 in 6.5 s, of which few differ on a busy machine.
    const pictures = bytes.toString('latin1').split('\x21\xf9\x04').slice(1);
    assert.equal(pictures.length, 130);
    assert.ok(new Set(pictures).size > 1, 'it moves');
  });

  it("as an overlay it shows what burns on nothing, and no control; a cake's candles fill the picture, with no room left for the cake", async () => {
    const over = await opened.page('#overlay&scene=candle&candles=7&seed=3&detail=0.2');
    await until(over, 'seven candles', () => window.wisp.firstPicture > 0 && window.wisp.burning?.of === 7);
    assert.equal(await over.locator('button:visible:not(#notices button)').count(), 0);
    const { picture, width, height } = await canvasOf(over);
    const corner = picture[4 * (Math.round(0.97 * height) * width + Math.round(0.03 * width)) + 3];
    assert.ok(corner < 20, `corner ${corner}`);
    let left = 1;
    for (let k = 0; k < width * height; ++k) if (picture[4 * k + 3] === 255) left = Math.min(left, (k % width) / width);
    await says(over, '#notices', 'microphone');
    assert.doesNotMatch(await over.textContent('#notices'), /press Blow|address bar/i);
    assert.ok(left < 0.25, `the leftmost wax is at ${left} of the picture's width`);
    await over.close();
  });
});
