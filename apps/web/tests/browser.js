// A browser with the built page in it, for tests and measurements.

import assert from 'node:assert/strict';
import { mkdtempSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before } from 'node:test';
import { fileURLToPath } from 'node:url';
import { chromium } from 'playwright-core';
import { drawing, executablePath, quiet, seen, serve, skip, watched } from '../../../bindings/npm/tests/chromium.mjs';

const dist = fileURLToPath(new URL('../dist/', import.meta.url));

export { seen, skip };

/** Creates a folder for the files of a test, removed after the test. */
export function temporaryFolder() {
  const folder = mkdtempSync(join(tmpdir(), 'wisp-page-'));
  after(() => rmSync(folder, { recursive: true }));
  return folder;
}

/** Starts a server of the built page, and a browser. `close()` ends both. */
export async function openBrowser(flags = []) {
  const server = await serve(dist, false);
  const address = `http://localhost:${server.address().port}/`;
  const browser = await chromium.launch({ executablePath, args: ['--headless=new', ...quiet, ...drawing, ...flags], headless: true });
  return {
    browser,
    address,
    /** Opens the page and waits until it plays. `page.errors`: errors; `page.strangers`: requests to other hosts. */
    async page(hash = '', options = {}) {
      const page = await watched(browser, address, { viewport: { width: 360, height: 360 }, serviceWorkers: 'block', ...options });
      if (options.before) await page.addInitScript(options.before);
      await page.goto(`${address}${hash}`);
      await until(page, 'the page plays', () => window.wisp?.frames > 2);
      return page;
    },
    async close() {
      await browser.close();
      server.close();
    },
  };
}

/**
 * Opens a page before the tests of a `describe` and passes it to `ready`. After them it asserts that the page had no
 * error and requested nothing from other hosts. `flags`: returns the browser's flags when it starts.
 */
export function onPage(hash, ready, { flags = () => [], ...options } = {}) {
  let opened, page;
  before(async () => {
    opened = await openBrowser(flags());
    page = await opened.page(hash, options);
    await ready(page, opened);
  });
  after(async () => {
    const found = page === undefined ? [] : [...page.errors, ...page.strangers];
    await opened?.close();
    assert.deepEqual(found, []);
  });
}

const fakes = ['--use-fake-ui-for-media-stream', '--use-fake-device-for-media-stream'];
/** Flags of a browser whose microphone is a sound file, played once. */
export const hears = (file) => [...fakes, `--use-file-for-fake-audio-capture=${file}%noloop`];
/** Flags of a browser whose camera and microphone are files, played again and again. */
export const filmsWith = ({ picture, sound }) => [...fakes, `--use-file-for-fake-video-capture=${picture}`, `--use-file-for-fake-audio-capture=${sound}`, loud];
/** Flag that lets pages play sound before anything is pressed. */
export const loud = '--autoplay-policy=no-user-gesture-required';

/** Waits until something holds in the page. Polls, as the page's policy forbids Playwright's own wait. */
export const until = (page, what, holds, argument = null) => seen(what, () => page.evaluate(holds, argument));

export async function framesPass(page, many = 2) {
  const frames = await page.evaluate(() => window.wisp.frames);
  await until(page, `${many} frames`, (most) => window.wisp.frames > most, frames + many);
}

export const allLit = () => window.wisp.burning?.lit === window.wisp.burning?.of;
export const noneLit = () => window.wisp.burning?.lit === 0;

/** Drops a file on the page. `bytes`: its contents, or a number of zeros. */
export const drop = (page, name, bytes) => dropAll(page, { [name]: bytes });

/** Drops files by name. Their bytes are passed as text, since a film as a list of numbers takes a minute. */
export const dropAll = (page, files) =>
  page.evaluate(
    (all) => {
      const carried = new DataTransfer();
      const bytesOf = (given) => (typeof given === 'number' ? new Uint8Array(given) : Uint8Array.from(atob(given), (letter) => letter.charCodeAt(0)));
      for (const [called, given] of all) carried.items.add(new File([bytesOf(given)], called));
      for (const type of ['dragenter', 'dragover', 'drop']) window.dispatchEvent(new DragEvent(type, { dataTransfer: carried, bubbles: true, cancelable: true }));
    },
    Object.entries(files).map(([name, bytes]) => [name, typeof bytes === 'number' ? bytes : Buffer.from(bytes).toString('base64')]),
  );

/** Opens the drawer, if it is not open. */
export async function openDrawer(page) {
  if (await page.evaluate(() => document.getElementById('drawer').hidden)) await page.click('#open-drawer');
  await until(page, 'the drawer is open', () => !document.getElementById('drawer').hidden);
}

export async function openCard(page) {
  await page.click('#share');
  await until(page, 'the card is open', () => !document.getElementById('card').hidden);
}

export async function hold(page, code, what, holds) {
  await page.focus('#stage');
  await page.keyboard.down(code);
  await until(page, what, holds);
  await page.keyboard.up(code);
}
/** Blows by the space bar until nothing burns. */
export const blowOut = (page) => hold(page, 'Space', 'it is out', noneLit);

/** For tests of the studio: its panel, its step, and the words in a place. */
export const panel = '#studio .panel';
export const step = (page, name) => until(page, `step ${name}`, (wanted) => document.getElementById('studio')?.dataset.step === wanted, name);
export const says = (page, where, words) =>
  until(page, `${where} says ${words}`, ([place, source]) => new RegExp(source, 'i').test(document.querySelector(place)?.textContent ?? ''), [where, words]);
export const complete = (page) => until(page, 'the page has all of its parts', () => document.querySelector('[data-scene=yours]') !== null);
export async function enterStudio(page) {
  await complete(page);
  await page.click('[data-scene=yours]');
  await step(page, 'gather');
}
export const chooses = (page) => until(page, 'what there is to choose', () => document.querySelector('[data-gather=camera]') !== null);
export const toLearn = (page) => until(page, 'it can be learned', () => document.querySelector('[data-act=learn]') !== null);
/** Presses an element and returns the download that begins. */
export const saved = async (page, pressed) => (await Promise.all([page.waitForEvent('download'), page.click(pressed)]))[0];

/** Number of bright, blue or orange pixels of each canvas, right of `left` and in the upper `share` of its height. */
export const painted = (page, canvases, kind, left = 0, share = 1) =>
  page.$$eval(
    canvases,
    (all, [wanted, from, upper]) =>
      all.map((canvas) => {
        const { data } = canvas.getContext('2d').getImageData(from, 0, canvas.width - from, canvas.height * upper);
        const is = { bright: (r) => r > 200, blue: (r, b, a) => a > 128 && b > r + 8, orange: (r, b, a) => a > 128 && r > b + 8 }[wanted];
        let many = 0;
        for (let k = 0; k < data.length; k += 4) if (is(data[k], data[k + 2], data[k + 3])) many += 1;
        return many;
      }),
    [kind, left, share],
  );
