// A browser with the built page in it, for tests and measurements.

import { existsSync } from 'node:fs';
import { readFile } from 'node:fs/promises';
import { createServer } from 'node:http';
import { fileURLToPath } from 'node:url';
import { chromium } from 'playwright-core';

const dist = fileURLToPath(new URL('../dist/', import.meta.url));

const types = {
  html: 'text/html',
  js: 'text/javascript',
  css: 'text/css',
  wasm: 'application/wasm',
  svg: 'image/svg+xml',
  jpg: 'image/jpeg',
  png: 'image/png',
  webmanifest: 'application/manifest+json',
};

/** Chromium, or undefined where there is none: tests skip then. */
export const chromiumPath = ['/usr/bin/chromium', '/usr/bin/chromium-browser', '/usr/bin/google-chrome'].find(existsSync);

const quiet = [
  '--headless=new',
  '--no-sandbox',
  '--disable-background-networking',
  '--disable-component-update',
  '--disable-sync',
  '--disable-quic',
  '--no-first-run',
  '--use-angle=swiftshader',
  '--enable-unsafe-swiftshader',
];

/** Serves apps/web/dist on localhost. */
export async function serve() {
  const server = createServer(async (request, response) => {
    const path = new URL(request.url, 'http://localhost').pathname.replace(/\/$/, '/index.html').slice(1);
    try {
      const body = await readFile(dist + path);
      response.setHeader('content-type', types[path.split('.').pop()] ?? 'application/octet-stream');
      response.end(body);
    } catch {
      response.statusCode = 404;
      response.end();
    }
  });
  await new Promise((resolve, reject) => server.once('error', reject).listen(0, 'localhost', resolve));
  return { address: `http://localhost:${server.address().port}/`, close: () => server.close() };
}

/** A server, a browser, and pages in it. `close()` ends all of it. */
export async function openBrowser(flags = []) {
  const server = await serve();
  const browser = await chromium.launch({ executablePath: chromiumPath, args: [...quiet, ...flags], headless: true });
  return {
    browser,
    address: server.address,
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
        if (protocol !== 'blob:' && !href.startsWith(server.address)) page.strangers.push(href);
      });
      if (options.before) await page.addInitScript(options.before);
      await page.goto(`${server.address}${hash}`);
      await until(page, 'the page plays', () => window.wisp?.frames > 2);
      return page;
    },
    async close() {
      await browser.close();
      server.close();
    },
  };
}

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
