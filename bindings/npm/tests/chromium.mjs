// Pages that use the package as `npm pack` makes it, for tests in Chromium.

import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { cpSync, existsSync, mkdirSync, mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { createServer } from 'node:http';
import { tmpdir } from 'node:os';
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

/** Serves a folder; `strict`: with a strict content security policy. */
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

/** Timeout of every wait, milliseconds: many times what any step takes on a busy machine. */
const patience = 180_000;

/** Waits until `holds()` returns true; after the timeout fails with the words `what`. */
export async function seen(what, holds) {
  for (const end = Date.now() + patience; !(await holds()); ) {
    if (Date.now() > end) assert.fail(`never: ${what}`);
    await new Promise((resolve) => setTimeout(resolve, 15));
  }
}

/** Waits until an expression is true in a page. Polls, as the page's policy forbids Playwright's own wait. */
export const until = (page, expression) => seen(expression, () => page.evaluate(`Boolean(${expression})`));

/** Opens a page that keeps its errors in `page.errors`, and requests to other addresses in `page.strangers`. */
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
  const size = samples.byteLength;
  const [riff, wave, fmt, data] = ['RIFF', 'WAVE', 'fmt ', 'data'].map((name) => Buffer.from(name).readUInt32LE());
  // Pairs of 16-bit fields are written as one number: PCM and 1 channel, 2 bytes a sample and 16 bits.
  const header = new Uint32Array([riff, 36 + size, wave, fmt, 16, 1 + (1 << 16), rate, 2 * rate, 2 + (16 << 16), data, size]);
  return Buffer.concat([Buffer.from(header.buffer), Buffer.from(samples.buffer)]);
}

/** Serves pages that use the packed package, by name, and builds those that have a configuration for Vite. */
export async function serveInstalled(...names) {
  const { build } = await import('vite');
  const work = mkdtempSync(join(tmpdir(), 'wisp-player-'));
  const packed = execFileSync('npm', ['pack', '--silent', '--pack-destination', work], { cwd: join(here, '..') });
  const servers = {};
  for (const name of names) {
    const page = furnish(work, join(work, packed.toString().trim()), name);
    const configFile = join(page, 'vite.config.js');
    const built = existsSync(configFile);
    if (built) await build({ root: page, logLevel: 'error', configFile });
    const folder = built ? join(page, 'dist') : page;
    cpSync(models, join(folder, 'models'), { recursive: true });
    servers[name] = await serve(folder);
  }
  const close = () => {
    for (const server of Object.values(servers)) server.close();
    rmSync(work, { recursive: true, force: true });
  };
  return { work, address: (name) => `http://localhost:${servers[name].address().port}/`, close };
}

/** Creates a folder with the packed package installed, a page, and the scripts that pages share. */
function furnish(work, tarball, name) {
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
