// The package as `npm pack` makes it, used by a plain page and by a Vite project, in Chromium.

import assert from 'node:assert/strict';
import { readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { after, before, describe, test } from 'node:test';

import { executablePath, models, quiet, serveInstalled, skip, until, watched, wavOf } from './chromium.mjs';
import { load } from '../dist/index.js';
import { gusts, hashOfLife } from './lives.mjs';

describe('in Chromium', { skip }, () => {
  let pages, browser, listening;

  before(async () => {
    const { chromium } = await import('playwright-core');
    pages = await serveInstalled('plain', 'vite');
    const sound = join(pages.work, 'breath.wav');
    const samples = [...gusts(4)].flatMap((block) => [...block]);
    writeFileSync(sound, wavOf(Int16Array.from(samples, (sample) => 32767 * Math.max(-1, Math.min(1, sample))), 48000));
    const hears = ['--use-fake-device-for-media-stream', `--use-file-for-fake-audio-capture=${sound}`, '--autoplay-policy=no-user-gesture-required'];
    browser = await chromium.launch({ executablePath, args: quiet });
    listening = await chromium.launch({ executablePath, args: [...quiet, ...hears] });
  });

  after(async () => {
    await browser?.close();
    await listening?.close();
    pages?.close();
  });

  async function open(browser, name, permissions) {
    const address = pages.address(name);
    const page = await watched(browser, address, { permissions });
    await page.goto(address);
    await until(page, 'window.page');
    page.started = await page.evaluate("page.start('models/flame.wisp')");
    return page;
  }

  // 1000 frames only, as bits.test.mjs runs the full check; the expected hash is computed in Node.js.
  for (const name of ['plain', 'vite']) {
    test(`a page made with ${name} plays with the bits that Node.js has, in a worker too`, async (t) => {
      const expected = hashOfLife(await load(), readFileSync(join(models, 'leaf.wisp')), 1000);
      const page = await open(browser, name, []);
      const { started } = page;
      assert.equal(started.points, 64);
      assert.equal(started.simd, true);
      t.diagnostic(`library ready in ${started.load.toFixed(1)} ms, first outline in ${started.first.toFixed(1)} ms`);
      assert.equal(await page.evaluate("page.life('models/leaf.wisp', 1000)"), expected);
      assert.equal(await page.evaluate("page.lifeInWorker('models/leaf.wisp', 1000)"), expected);
      assert.deepEqual([page.errors, page.strangers], [[], []]);
    });

    test(`a page made with ${name} hears a breath, raw, and notices that the microphone is gone`, async () => {
      const page = await open(listening, name, ['microphone']);
      await page.evaluate(`(() => {
        const media = navigator.mediaDevices, ask = media.getUserMedia.bind(media);
        window.resumes = AudioContext.prototype.resume;
        window.AudioContext = class extends AudioContext { constructor(options) { super(options); window.heardBy = this; } };
        media.getUserMedia = async (wish) => (window.stream = await ask(window.wish = wish));
      })()`);
      const opened = await page.evaluate('page.listen({ frameRate: 30 })');
      assert.equal(opened.trouble, undefined, opened.message);
      assert.equal(opened.raw, true);
      const { echoCancellation, noiseSuppression, autoGainControl } = opened.settings;
      assert.deepEqual([echoCancellation, noiseSuppression, autoGainControl], [false, false, false]);
      await until(page, 'page.strongest() > 0.3');
      await assert.rejects(page.evaluate("page.calibrate('blow hard', NaN)"), /RangeError/);
      const known = await page.evaluate('page.calibration()'); // it is still open
      assert.ok(known.gustRms > 0);
      // An interruption, as by a telephone call, is reported; a key resumes the sound.
      await page.evaluate('AudioContext.prototype.resume = () => new Promise(() => {}), heardBy.suspend()');
      await until(page, 'page.slept.at(-1) === true');
      await page.evaluate('delete AudioContext.prototype.resume, AudioContext.prototype.resume = resumes');
      await page.keyboard.press('x');
      await until(page, 'page.slept.at(-1) === false');
      await page.evaluate(`page.reopen(${JSON.stringify({ ...known, gustRms: 0.25 })})`);
      assert.ok(Math.abs((await page.evaluate('page.calibration()')).gustRms - 0.25) < 0.05); // kept
      await page.evaluate("stream.getTracks()[0].dispatchEvent(new Event('ended'))");
      assert.equal(await page.evaluate('page.lost'), 'lost');
      assert.equal(await page.evaluate('page.calibration().catch(({ trouble }) => trouble)'), 'lost');
      assert.equal(await page.evaluate('stream.getTracks()[0].readyState'), 'ended');
      assert.deepEqual(page.errors, []);
    });
  }

  test('a microphone that is denied, or is not there, is told apart', async () => {
    const denied = await open(listening, 'plain', []);
    const refused = await denied.evaluate('page.listen({})');
    assert.equal(refused.trouble, 'denied', refused.message);
    const bare = await open(browser, 'plain', ['microphone']);
    const missing = await bare.evaluate('page.listen({})');
    assert.equal(missing.trouble, 'none', missing.message);
  });

  test('a microphone whose sound cannot be used is released', async () => {
    const page = await open(listening, 'plain', ['microphone']);
    await page.evaluate(`(() => {
      const media = navigator.mediaDevices, ask = media.getUserMedia.bind(media);
      media.getUserMedia = async (wish) => (window.stream = await ask(wish));
      AudioContext.prototype.createMediaStreamSource = () => { throw new DOMException('another rate', 'NotSupportedError'); };
    })()`);
    const refused = await page.evaluate('page.listen({})');
    assert.deepEqual([refused.trouble, await page.evaluate('stream.getTracks()[0].readyState')], ['failed', 'ended']);
  });
});
