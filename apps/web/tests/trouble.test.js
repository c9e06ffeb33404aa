// Failures outside the page: each is reported by a helpful sentence, and the scene continues.

import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { describe, it } from 'node:test';
import { drop, framesPass, loud, onPage, says, seen, skip, until } from './browser.js';

const flame = readFileSync(new URL('../public/models/flame-4.wisp', import.meta.url));

describe('trouble', { skip }, () => {
  let opened;
  let page;

  // Runs in the page: a microphone that is real, absent, or made here.
  function stubMicrophone() {
    const real = navigator.mediaDevices.getUserMedia.bind(navigator.mediaDevices);
    window.microphone = 'real';
    navigator.mediaDevices.getUserMedia = async (wanted) => {
      window.asked = wanted;
      if (window.microphone === 'real') return real(wanted);
      if (window.microphone === 'none') throw new DOMException('no device', 'NotFoundError');
      const context = new AudioContext();
      window.stream = context.createMediaStreamDestination().stream;
      return window.stream;
    };
  }

  const flags = () => ['--use-fake-device-for-media-stream', '--use-fake-ui-for-media-stream=deny', loud];
  onPage('#scene=candle&seed=3&detail=0.5', (...made) => ([page, opened] = made), { before: stubMicrophone, flags });

  const said = async (words) => {
    await says(page, '#notices', words);
    await framesPass(page);
    await until(page, 'it burns', () => window.wisp.burning.lit === 1);
    await page.evaluate(() => document.getElementById('notices').replaceChildren());
  };

  it('says that a microphone was not allowed, having asked for raw sound and only then', async () => {
    assert.equal(await page.evaluate(() => window.asked), undefined);
    await page.click('#blow');
    await said('not allowed');
    const { audio } = await page.evaluate(() => window.asked);
    assert.deepEqual([audio.echoCancellation, audio.noiseSuppression, audio.autoGainControl], [false, false, false]);
    assert.equal(await page.textContent('#blow-word'), 'Blow');
  });

  it('says that there is no microphone', async () => {
    await page.evaluate(() => (window.microphone = 'none'));
    await page.keyboard.press('b');
    await said('no microphone was found');
  });

  it('says that the microphone is gone when it is unplugged', async () => {
    await page.evaluate(() => (window.microphone = 'made'));
    await page.keyboard.press('b');
    await until(page, 'it listens', () => window.wisp.hearing === 'listening');
    await page.evaluate(() => window.stream.getAudioTracks()[0].dispatchEvent(new Event('ended')));
    await said('microphone is gone');
    assert.equal(await page.evaluate(() => window.wisp.hearing), 'off');
  });

  for (const [name, bytes, words] of [
    ['empty.wisp', 0, 'is empty'],
    ['heap.bin', 50_000_000, 'is 50 MB large'],
    ['broken.wisp', flame.map((value, k) => (k < 400 ? value : value ^ 1)), 'is not a model that can be played'],
    ['short.wisp', flame.subarray(0, 100), 'is not a model that can be played'],
    ['letter.txt', Buffer.from('Dear Sir or Madam'), 'is not a model that can be played'],
  ]) {
    it(`says that ${name} ${words}`, async () => {
      await drop(page, name, bytes);
      await said(`${name} ${words}`);
    });
  }

  it('says that the picture is gone, and goes on when it is back', async () => {
    await page.evaluate(() => {
      window.card = document.getElementById('stage').getContext('webgl2').getExtension('WEBGL_lose_context');
      window.card.loseContext();
    });
    await until(page, 'it says so', () => /graphics card/.test(document.getElementById('absent').textContent));
    await page.evaluate(() => window.card.restoreContext());
    await until(page, 'the picture is back', () => document.getElementById('absent').hidden);
    await framesPass(page);
  });

  it('says that there is no WebGL', async () => {
    const bare = await opened.page('#detail=0.5', {
      before: () => {
        const real = HTMLCanvasElement.prototype.getContext;
        HTMLCanvasElement.prototype.getContext = function (kind, ...more) {
          return kind === 'webgl2' ? null : real.call(this, kind, ...more);
        };
      },
    });
    assert.match(await bare.textContent('#absent'), /WebGL 2/);
    assert.equal(await bare.isVisible('#absent'), true);
    await bare.close();
  });

  it('works without a network once it was loaded', async () => {
    const context = await opened.browser.newContext({ viewport: { width: 200, height: 200 } });
    const kept = await context.newPage();
    await kept.goto(`${opened.address}#detail=0.25`);
    await kept.evaluate(async () => {
      const registration = await navigator.serviceWorker.ready;
      if (registration.active.state !== 'activated') {
        await new Promise((resolve) => registration.active.addEventListener('statechange', resolve, { once: true }));
      }
    });
    // Cached: one of the two modules, and the leaf's model only once Leaves is opened.
    const names = () =>
      kept.evaluate(async () => {
        const all = await Promise.all((await caches.keys()).map(async (name) => (await caches.open(name)).keys()));
        return all.flat().map(({ url }) => new URL(url).pathname);
      });
    const first = await names();
    assert.equal(first.filter((name) => name.endsWith('.wasm')).length, 1);
    assert.ok(!first.some((name) => name.includes('leaf.wisp')));
    await context.setOffline(true);
    await kept.reload();
    await until(kept, 'a candle burns', () => window.wisp?.burning?.lit === 1);
    await context.setOffline(false);
    await kept.goto(`${opened.address}#detail=0.25&scene=leaves&leaves=5`);
    await until(kept, 'leaves fall', () => window.wisp?.leaves?.count === 5);
    await seen('the leaf is kept', async () => (await names()).some((name) => name.includes('leaf.wisp')));
    await context.setOffline(true);
    await kept.reload();
    await until(kept, 'leaves fall', () => window.wisp?.leaves?.count === 5);
    await context.close();
  });
});
