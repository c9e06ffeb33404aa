// The same model, seed and wind give the same bits in WebAssembly, with SIMD and without, as natively: tests/c compares
// the native library with the same file of hashes.

import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { test } from 'node:test';

import { load } from '../dist/index.js';
import { hashOfLife, hashOfWind } from './lives.mjs';

const models = new URL('../../../tests/c/models/', import.meta.url);
const golden = readFileSync(new URL('bits.txt', models), 'utf8')
  .trim()
  .split('\n')
  .map((line) => line.split(' '))
  .map(([name, count, ...hash]) => ({ name, count: Number(count), hash: hash.join(' ') }));

for (const simd of ['off', 'on']) {
  for (const { name, count, hash } of golden) {
    test(`${name}, ${count} of it, has its bits with SIMD ${simd}`, async () => {
      const wisp = await load({ simd });
      const found =
        name === 'wind' ? hashOfWind(wisp, count) : hashOfLife(wisp, readFileSync(new URL(`${name}.wisp`, models)), count);
      assert.equal(found, hash);
    });
  }
}
