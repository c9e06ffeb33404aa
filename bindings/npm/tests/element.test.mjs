// The elements in pages of other people: plain HTML, a Vite project, a frame of another origin.

import assert from 'node:assert/strict';
import { createServer } from 'node:http';
import { after, before, describe, test } from 'node:test';

import { drawing, executablePath, quiet, serveInstalled, skip, until, watched } from './chromium.mjs';

const flags = [...quiet, ...drawing, '--use-fake-device-for-media-stream',
  '--use-fake-ui-for-media-stream', '--autoplay-policy=no-user-gesture-required'];

describe('elements in Chromium', { skip }, () => {
  let pages, browser, plain, framing;

  before(async () => {
    const { chromium } = await import('playwright-core');
    pages = await serveInstalled('element', 'element_vite');
    plain = pages.address('element');
    // Another origin, which only frames the plain page.
    framing = createServer((_request, response) => {
      response.setHeader('content-type', 'text/html');
      response.end(`<!doctype html><iframe src="${plain}" width="400" height="300"></iframe>`);
    });
    await new Promise((resolve) => framing.listen(0, '127.0.0.1', resolve));
    browser = await chromium.launch({ executablePath, args: flags });
  });

  after(async () => {
    await browser?.close();
    framing?.close();
    pages?.close();
  });

  const lit = (id, count) => `document.getElementById('${id}')?.burning?.lit === ${count}`;

  /** Opens a page, counting the modules that it fetches, and waits until a condition holds in it. */
  async function open(address, ready = lit('one', 1)) {
    const page = await watched(browser, address, { viewport: { width: 420, height: 320 } });
    page.modules = 0;
    page.on('request', (request) => (page.modules += request.url().endsWith('.wasm') ? 1 : 0));
    await page.goto(address);
    await until(page, ready);
    return page;
  }

  test('two candles on a plain page burn, and share one module', async () => {
    const page = await open(plain, `${lit('one', 1)} && ${lit('two', 3)}`);
    assert.equal(page.modules, 1);
    assert.equal(await page.evaluate('document.getElementById("one").shadowRoot.querySelector("canvas").ariaLabel'), 'A candle burns in a dark room.');
    assert.deepEqual(page.errors, []);
  });

  test('Space blows it out and says so, Enter lights it again; one without wind burns on', async () => {
    const page = await open(plain, `${lit('one', 1)} && ${lit('two', 3)}`);
    await page.evaluate(`window.heard = []; for (const kind of ['extinguish', 'light'])
      document.getElementById('one').addEventListener(kind, () => heard.push(kind))`);
    for (const id of ['one', 'two']) {
      await page.evaluate(`document.getElementById('${id}').shadowRoot.querySelector('canvas').focus()`);
      await page.keyboard.down('Space');
      if (id === 'one') await until(page, lit('one', 0) + ` && document.getElementById('one').shadowRoot.querySelector('canvas').ariaLabel === 'The candle is out.'`);
      else await page.waitForTimeout(1500);
      await page.keyboard.up('Space');
    }
    assert.equal(await page.evaluate(lit('two', 3)), true);
    await page.evaluate(`document.getElementById('one').shadowRoot.querySelector('canvas').focus()`);
    await page.keyboard.press('Enter');
    await until(page, lit('one', 1));
    await until(page, 'heard.length === 2');
    assert.deepEqual(await page.evaluate('heard'), ['extinguish', 'light']);
  });

  test('attributes act while it plays: more candles, another seed, another model, and one that is not there', async () => {
    const page = await open(plain);
    await page.evaluate(`document.getElementById('one').setAttribute('candles', '5')`);
    await until(page, lit('one', 5));
    await page.evaluate(`{ const one = document.getElementById('one'); window.kept = one.scene; one.setAttribute('seed', '4.5'); }`);
    await until(page, `document.getElementById('one').scene !== kept && ${lit('one', 5)}`);
    await page.evaluate(`(async () => { const { Model } = await import(new URL('node_modules/@wisp/player/dist/model.js', location.href).href);
      const { free } = Model.prototype; window.freed = 0; Model.prototype.free = function () { freed += 1; free.call(this); };
      document.getElementById('one').setAttribute('src', 'models/leaf.wisp'); })()`);
    await until(page, `/is no flame/.test(document.getElementById('one').shadowRoot.querySelector('p').textContent)`);
    assert.equal(await page.evaluate('freed'), 1); // the model that does not fit
    await page.evaluate(`(() => { const one = document.getElementById('one');
      one.addEventListener('error', () => (window.failed = true)); one.setAttribute('src', 'models/none.wisp'); })()`);
    await until(page, 'window.failed');
    assert.match(await page.evaluate(`document.getElementById('one').shadowRoot.querySelector('p').textContent`), /none.wisp could not be fetched \(404\)/);
  });

  test('a browser without WebGL 2 is told so, and still when the model is there', async () => {
    const page = await watched(browser, plain);
    await page.addInitScript('HTMLCanvasElement.prototype.getContext = () => null');
    await page.goto(plain);
    await until(page, lit('one', 1));
    assert.match(await page.evaluate(`document.getElementById('one').shadowRoot.querySelector('p').textContent`), /no WebGL 2/);
  });

  test('its button lies below the candle', async () => {
    const page = await open(plain, `${lit('one', 1)} && document.getElementById('one').scene.places().wick[1] > 20`);
    const wick = `document.getElementById('one').scene.places().wick[1] / document.getElementById('one').shadowRoot.querySelector('canvas').height`;
    const before = await page.evaluate(wick);
    await page.evaluate(`document.getElementById('one').setAttribute('wind', 'mic')`);
    await until(page, `${wick} > ${before + 0.05}`);
  });

  test('taken out of the page it stands still, put back it goes on', async () => {
    const page = await open(plain);
    await page.evaluate(`(() => { window.kept = document.getElementById('one'); kept.wind.keys.held.add('Space'); kept.remove();
      window.frames = 0; const real = requestAnimationFrame; kept.watch = () => { frames += 1; }; })()`);
    await page.waitForTimeout(500);
    assert.deepEqual(await page.evaluate('[frames, kept.wind.keys.held.size]'), [0, 0]);
    await page.evaluate('document.body.append(kept)');
    await until(page, 'frames > 2');
  });

  test('after twenty others came and went and freed their models, the one that stayed has its picture', async () => {
    const page = await open(plain);
    for (let k = 0; k < 20; ++k) {
      await page.evaluate(`document.body.append(window.passing = Object.assign(document.createElement('wisp-candle'), { id: 'passing' }))`);
      await until(page, lit('passing', 1));
      await page.evaluate('passing.remove()');
      await until(page, 'passing.scene === null && passing.model === null');
    }
    assert.equal(await page.evaluate(`document.getElementById('one').shadowRoot.querySelector('canvas').getContext('webgl2').isContextLost()`), false);
    await page.evaluate(`document.body.append(passing)`);
    await until(page, `!passing.shadowRoot.querySelector('canvas').getContext('webgl2').isContextLost() && ${lit('passing', 1)}`);
  });

  test('burns in a frame of another origin', async () => {
    const page = await open(`http://127.0.0.1:${framing.address().port}/`, 'true');
    const inside = () => page.frames().find((frame) => frame.url().startsWith(plain));
    await until({ evaluate: (words) => inside()?.evaluate(words) ?? false }, lit('one', 1));
    assert.deepEqual(page.errors, []);
  });

  test('a Vite project has a candle that listens when it is asked to, and leaves', async () => {
    const page = await open(pages.address('element_vite'));
    const button = `document.getElementById('one').shadowRoot.querySelector('button')`;
    assert.equal(await page.evaluate(`${button}.hidden`), false);
    assert.equal(await page.evaluate(`${button}.ariaLabel`), 'Blow: microphone on');
    await page.evaluate(`${button}.click()`);
    await until(page, `${button}.ariaPressed === 'true'`);
    await page.evaluate(`${button}.click()`);
    await until(page, `${button}.ariaPressed === 'false'`);
    // An element out of view does not start.
    assert.equal(await page.evaluate(`document.getElementById('two').scene?.leaves().count ?? 0`), 0);
    await page.evaluate(`document.getElementById('two').scrollIntoView()`);
    await until(page, `document.getElementById('two').scene?.leaves().count === 20`);
    assert.match(await page.evaluate(`document.getElementById('two').shadowRoot.querySelector('canvas').ariaLabel`), /20 of them/);
    await page.evaluate(`document.getElementById('two').removeAttribute('src')`);
    await until(page, `/wisp-leaves needs src/.test(document.getElementById('two').shadowRoot.querySelector('p').textContent)`);
    assert.deepEqual(page.errors, []);
  });
});
