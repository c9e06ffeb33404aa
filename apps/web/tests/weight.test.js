// The built page: download sizes of its parts, its policy, its cached files, and the number of source lines.

import assert from 'node:assert/strict';
import { readdirSync, readFileSync } from 'node:fs';
import { describe, it } from 'node:test';
import { brotliCompressSync, gzipSync } from 'node:zlib';

const dist = new URL('../dist/', import.meta.url);
const MOST_LINES = 18_906;
const packed = (name) => gzipSync(readFileSync(new URL(name, dist)), { level: 9 }).length;

describe('the built page', () => {
  const html = readFileSync(new URL('index.html', dist), 'utf8');
  const assets = readdirSync(new URL('assets/', dist)).filter((name) => name.includes('.'));
  const studio = readdirSync(new URL('assets/studio/', dist));

  // One of the two modules is fetched: the larger counts.
  const modules = assets.filter((name) => name.endsWith('.wasm')).map((name) => packed(`assets/${name}`));
  const first = () => {
    const named = [...html.matchAll(/(?:src|href)="\.\/([^"]+\.(?:js|css|svg|webmanifest))"/g)].map(([, name]) => name);
    assert.ok(named.some((name) => name.endsWith('.js')) && named.some((name) => name.endsWith('.css')));
    assert.equal(modules.length, 2);
    return ['index.html', ...named, 'models/flame.wisp'].map(packed).reduce((sum, part) => sum + part, Math.max(...modules));
  };

  it('weighs at most 200 kB until its first flame burns', () => {
    const total = first();
    assert.ok(total <= 200_000, `${total} bytes`);
  });

  it('fetches no more than 400 kB in all, for all that is not the leaf or the studio', () => {
    const list = /const files = (\[.*?\]);/s.exec(readFileSync(new URL('sw.js', dist), 'utf8'))[1];
    const kept = JSON.parse(list).filter((name) => !name.endsWith('.wasm') && !/^models\/(leaf|filmed)/.test(name));
    const total = kept.map((name) => packed(name === './' ? 'index.html' : name)).reduce((sum, part) => sum + part, Math.max(...modules));
    assert.ok(kept.length > 10 && total <= 400_000, `${total} bytes`);
  });

  // Kept, since brotli at its maximum level takes seconds for two megabytes.
  const sizes = new Map();
  const brotliOf = (name) => {
    if (!sizes.has(name)) sizes.set(name, brotliCompressSync(readFileSync(new URL(`assets/studio/${name}`, dist))).length);
    return sizes.get(name);
  };
  const brotli = (names) => names.map(brotliOf).reduce((sum, part) => sum + part, 0);
  const later = (kind) => studio.filter((name) => name.startsWith(`${kind}-`));

  it('fetches no more than 700 kB by brotli for the studio, 900 kB by gzip, and only when somebody goes in', () => {
    const first = studio.filter((name) => !/^(chains|export)-/.test(name));
    const gzip = first.map((name) => packed(`assets/studio/${name}`)).reduce((sum, part) => sum + part, 0);
    assert.ok(gzip <= 900_000 && brotli(first) <= 700_000, `${gzip} bytes, ${brotli(first)} by brotli`);
    assert.doesNotMatch(html, /studio/);
  });

  it('fetches no more than 300 kB to learn what falls, and 160 kB for files for other tools, when somebody wants them', () => {
    for (const [kind, most] of [['chains', 300_000], ['export', 160_000]]) {
      assert.equal(later(kind).length, 1);
      assert.ok(brotli(later(kind)) <= most, `${kind}: ${brotli(later(kind))} bytes by brotli`);
    }
  });

  it('ships flames of a few kilobytes and a leaf of less than a megabyte', () => {
    const size = (name) => readFileSync(new URL(`models/${name}`, dist)).length;
    assert.ok(size('flame.wisp') < 60_000);
    for (const order of [2, 4, 6]) assert.ok(size(`flame-${order}.wisp`) < 20_000);
    assert.ok(size('leaf.wisp') < 1_000_000);
  });

  it('is written in no more lines than before', () => {
    // Lines of the page, its packages, tests and benches. The bound only falls.
    const roots = ['../', '../../../bindings/'].map((path) => new URL(path, import.meta.url));
    const mine = (path) => /\.(?:ts|js|mjs)$/.test(path) && !/(?:^|\/)(?:dist|node_modules)\//.test(path);
    const lines = roots.flatMap((root) => readdirSync(root, { recursive: true }).filter(mine).map((path) => readFileSync(new URL(path, root), 'utf8').split('\n').length - 1));
    const total = lines.reduce((sum, one) => sum + one, 0);
    assert.ok(lines.length > 150 && total <= MOST_LINES, `${total} lines in ${lines.length} files`);
  });

  it('forbids itself every other host', () => {
    const policy = /Content-Security-Policy" content="([^"]+)"/.exec(html)?.[1].replaceAll('&#39;', "'") ?? '';
    assert.match(policy, /default-src 'none'/);
    assert.doesNotMatch(policy, /https?:|\*|unsafe-inline|'unsafe-eval'/);
    assert.doesNotMatch(html, /(?:src|href)="(?:https?:)?\/\//);
  });

  it('knows all of its files but the studio, to keep them for when there is no network', () => {
    const worker = readFileSync(new URL('sw.js', dist), 'utf8');
    for (const name of assets) assert.ok(worker.includes(`assets/${name}`), name);
    assert.ok(worker.includes('models/leaf.wisp'));
    for (const name of studio) assert.ok(!worker.includes(name), `${name} is not kept before it is wanted`);
  });
});
