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
/** Where there is no graphics card the processor draws. */
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

/** Milliseconds until what does not happen has failed: many times what anything takes, also on a busy machine. */
export const patience = 180_000;

/** Waits until an expression is true in a page: by asking, since the policy forbids Playwright's own way. */
export async function until(page, expression) {
  for (const end = Date.now() + patience; !(await page.evaluate(`Boolean(${expression})`)); ) {
    if (Date.now() > end) assert.fail(`never: ${expression}`);
    await new Promise((resolve) => setTimeout(resolve, 50));
  }
}

/** A folder with the packed package installed, a page, what both pages share, and the models. */
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
