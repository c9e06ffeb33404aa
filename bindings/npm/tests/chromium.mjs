// Pages that use the package as `npm pack` makes it, for tests in Chromium.

import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { cpSync, existsSync, mkdirSync, readFileSync } from 'node:fs';
import { createServer } from 'node:http';
import { extname, join, normalize } from 'node:path';
import { fileURLToPath } from 'node:url';

const here = fileURLToPath(new URL('.', import.meta.url));
export const models = fileURLToPath(new URL('../../../tests/c/models/', import.meta.url));
export const executablePath = process.env.WISP_CHROMIUM ?? ['/usr/bin/chromium', '/usr/bin/chromium-browser', '/usr/bin/google-chrome'].find(existsSync) ?? '/usr/bin/chromium';
export const quiet = ['--no-sandbox', '--disable-background-networking', '--disable-component-update', '--disable-sync',
  '--disable-quic', '--no-first-run'];
/** Flags for drawing on the processor, where there is no graphics card. */
export const drawing = ['--use-angle=swiftshader', '--enable-unsafe-swiftshader'];

const types = { '.css': 'text/css', '.html': 'text/html', '.js': 'text/javascript', '.mjs': 'text/javascript', '.wasm': 'application/wasm',
  '.svg': 'image/svg+xml', '.jpg': 'image/jpeg', '.png': 'image/png', '.webmanifest': 'application/manifest+json' };
const policy = "default-src 'self'; script-src 'self' 'wasm-unsafe-eval'; object-src 'none'";

/** Serves a folder, under a strict policy unless its pages have one of their own. */
export function serve(folder, strict = true) {
  const server = createServer((request, response) => {
    const path = join(folder, normalize(new URL(request.url, 'http://localhost').pathname));
    const file = path.endsWith('/') ? join(path, 'index.html') : path;
    if (path.endsWith('favicon.ico')) return response.writeHead(204).end();
    if (!existsSync(file)) return response.writeHead(404).end();
    response.writeHead(200, {
      'content-type': types[extname(file)] ?? 'application/octet-stream',
      ...(strict ? { 'content-security-policy': policy } : {}),
    });
    response.end(readFileSync(file));
  });
  return new Promise((resolve, reject) => server.once('error', reject).listen(0, 'localhost', () => resolve(server)));
}

export const skip = existsSync(executablePath) ? false : `there is no ${executablePath}`;

/** The package as npm packs it, in a folder. */
export function pack(work) {
  const packed = execFileSync('npm', ['pack', '--silent', '--pack-destination', work], { cwd: join(here, '..') });
  return join(work, packed.toString().trim());
}

/** Timeout of every wait, milliseconds: many times what any step takes on a busy machine. */
export const patience = 180_000;

/** Waits until `holds()` returns true; after the timeout fails with the words `what`. */
export async function seen(what, holds) {
  for (const end = Date.now() + patience; !(await holds()); ) {
    if (Date.now() > end) assert.fail(`never: ${what}`);
    await new Promise((resolve) => setTimeout(resolve, 15));
  }
}

/** Waits until an expression is true in a page. Polls from here, since the page's policy forbids Playwright's own wait. */
export const until = (page, expression) => seen(expression, () => page.evaluate(`Boolean(${expression})`));

/** A new page that keeps its errors in `page.errors`, and requests to other addresses in `page.strangers`. */
export async function watched(browser, address, options = {}) {
  const page = await browser.newPage(options);
  page.setDefaultTimeout(patience);
  Object.assign(page, { errors: [], strangers: [] });
  page.on('pageerror', (error) => page.errors.push(error.message));
  page.on('console', (message) => message.type() === 'error' && page.errors.push(message.text()));
  page.on('request', (request) => request.url().startsWith('blob:') || request.url().startsWith(address) || page.strangers.push(request.url()));
  return page;
}

/** Sound of one channel, 16 bits, as a WAV file. */
export function wavOf(samples, rate) {
  const header = Buffer.alloc(44);
  header.write('RIFF', 0);
  header.writeUInt32LE(36 + samples.byteLength, 4);
  header.write('WAVEfmt ', 8);
  header.writeUInt32LE(16, 16);
  header.writeUInt16LE(1, 20);
  header.writeUInt16LE(1, 22);
  header.writeUInt32LE(rate, 24);
  header.writeUInt32LE(2 * rate, 28);
  header.writeUInt16LE(2, 32);
  header.writeUInt16LE(16, 34);
  header.write('data', 36);
  header.writeUInt32LE(samples.byteLength, 40);
  return Buffer.concat([header, Buffer.from(samples.buffer)]);
}

/** A folder with the packed package installed, a page, and the scripts that pages share; the caller adds models. */
export function furnish(work, tarball, name) {
  const folder = join(work, name);
  const installed = join(folder, 'node_modules/@wisp/player');
  mkdirSync(installed, { recursive: true });
  execFileSync('tar', ['-xzf', tarball, '-C', installed, '--strip-components=1']);
  cpSync(join(here, 'pages', name), folder, { recursive: true });
  for (const shared of ['pages/exercise.js', 'pages/life_worker.js', 'lives.mjs']) {
    cpSync(join(here, shared), join(folder, shared.split('/').at(-1)));
  }
  return folder;
}
