// A browser with the built page in it, for tests and measurements.

import assert from 'node:assert/strict';
import { existsSync } from 'node:fs';
import { after, before } from 'node:test';
import { fileURLToPath } from 'node:url';
import { chromium } from 'playwright-core';
import { drawing, executablePath, quiet, serve } from '../../../bindings/npm/tests/chromium.mjs';

const dist = fileURLToPath(new URL('../dist/', import.meta.url));

export const chromiumPath = existsSync(executablePath) ? executablePath : undefined;
export const skip = chromiumPath === undefined && 'there is no Chromium here';

/** A server, a browser, and pages in it. `close()` ends all of it. */
export async function openBrowser(flags = []) {
  const server = await serve(dist, false);
  const address = `http://localhost:${server.address().port}/`;
  const browser = await chromium.launch({ executablePath, args: ['--headless=new', ...quiet, ...drawing, ...flags], headless: true });
  return {
    browser,
    address,
    /** The page, playing; its errors are in `page.errors`, what it asked of other hosts in `page.strangers`. */
    async page(hash = '', options = {}) {
      const page = await browser.newPage({ viewport: { width: 360, height: 360 }, serviceWorkers: 'block', ...options });
      page.setDefaultTimeout(patience);
      page.errors = [];
      page.strangers = [];
      page.on('pageerror', (error) => page.errors.push(error.message));
      page.on('console', (message) => {
        if (message.type() === 'error') page.errors.push(message.text());
      });
      page.on('request', (request) => {
        const { protocol, href } = new URL(request.url());
        if (protocol !== 'blob:' && !href.startsWith(address)) page.strangers.push(href);
      });
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

/** For the tests of a `describe`: a page, of which `ready` is told before them. After them it must have made no error and asked no other host. */
export function onPage(hash, ready, { flags, ...options } = {}) {
  let opened, page;
  before(async () => {
    opened = await openBrowser(flags);
    page = await opened.page(hash, options);
    await ready(page, opened);
  });
  after(async () => {
    const found = page === undefined ? [] : [...page.errors, ...page.strangers];
    await opened?.close();
    assert.deepEqual(found, []);
  });
}

/** A browser whose microphone is a sound file, played once. */
export const hears = (file) => ['--use-fake-ui-for-media-stream', '--use-fake-device-for-media-stream', `--use-file-for-fake-audio-capture=${file}%noloop`];

/** Milliseconds until what does not happen has failed: many times what anything takes, also on a busy machine. */
const patience = 120_000;

/** Waits until something holds; `what` says so when it does not. */
export async function seen(what, holds) {
  for (const end = Date.now() + patience; !(await holds()); ) {
    if (Date.now() > end) throw new Error(`not seen: ${what}`);
    await new Promise((resolve) => setTimeout(resolve, 15));
  }
}

/** The same of the page. Asks from here, again and again: the page's policy lets no script be made inside it. */
export const until = (page, what, holds, argument = null) => seen(what, () => page.evaluate(holds, argument));

/** Drops a file on the page. */
export const drop = (page, name, bytes) => dropAll(page, { [name]: bytes });

/** Drops files, each by its name. Their bytes go as text: as a list of numbers a film takes a minute. */
export const dropAll = (page, files) =>
  page.evaluate(
    (all) => {
      const carried = new DataTransfer();
      for (const [called, text] of all) carried.items.add(new File([Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0))], called));
      window.dispatchEvent(new DragEvent('drop', { dataTransfer: carried, bubbles: true, cancelable: true }));
    },
    Object.entries(files).map(([name, bytes]) => [name, Buffer.from(bytes).toString('base64')]),
  );

/** Opens the drawer, if it is not open. */
export async function openDrawer(page) {
  if (await page.evaluate(() => document.getElementById('drawer').hidden)) await page.click('#open-drawer');
  await until(page, 'the drawer is open', () => !document.getElementById('drawer').hidden);
}

/** Opens the card with which something is sent. */
export async function openCard(page) {
  await page.click('#share');
  await until(page, 'the card is open', () => !document.getElementById('card').hidden);
}

/** Blows by the space bar until nothing burns. */
export async function blowOut(page) {
  await page.focus('#stage');
  await page.keyboard.down('Space');
  await until(page, 'it is out', () => window.wisp.burning?.lit === 0);
  await page.keyboard.up('Space');
}

/** The studio's steps and words, in the tests of the studio. */
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
/** What comes to the disk when that is pressed. */
export const saved = async (page, pressed) => (await Promise.all([page.waitForEvent('download'), page.click(pressed)]))[0];

/** How many pixels of each canvas are bright, blue or orange: right of `left`, in an upper share of it. */
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
