// Size of the package and cost of a frame: the same models and work as wisp_bench_player runs natively.
//
//   node bindings/npm/bench.mjs

import { readdirSync, readFileSync } from 'node:fs';
import { brotliCompressSync, gzipSync } from 'node:zlib';

import { load } from './dist/index.js';

const dist = new URL('./dist/', import.meta.url);
const models = new URL('../../tests/c/models/', import.meta.url);

function weigh(name, bytes) {
  const [gzip, brotli] = [gzipSync(bytes, { level: 9 }), brotliCompressSync(bytes)];
  console.log(`${name.padEnd(20)} ${bytes.length} bytes, gzip ${gzip.length}, brotli ${brotli.length}`);
}

function bank(wisp, name, capacity) {
  const model = wisp.model(readFileSync(new URL(`${name}.wisp`, models)));
  const made = model.bank({ capacity });
  model.free();
  for (let k = 0; k < capacity; ++k) made.spawn();
  return made;
}

/** Processor milliseconds of one call: the minimum of five runs of a tenth of a second. */
function time(work) {
  work();
  let best = Infinity;
  for (let round = 0; round < 5; ++round) {
    let calls = 0;
    const began = process.cpuUsage().user;
    let spent = 0;
    while (spent < 100e3) {
      for (let k = 0; k < 10; ++k) work();
      calls += 10;
      spent = process.cpuUsage().user - began;
    }
    best = Math.min(best, spent / 1e3 / calls);
  }
  return best;
}

const scripts = readdirSync(dist).filter((name) => name.endsWith('.js'));
for (const name of ['wisp.wasm', 'wisp-simd.wasm']) weigh(name, readFileSync(new URL(name, dist)));
weigh('all scripts', Buffer.concat(scripts.map((name) => readFileSync(new URL(name, dist)))));

for (const simd of ['off', 'on']) {
  const wisp = await load({ simd });
  const flames = bank(wisp, 'flame', 64);
  const step = time(() => {
    flames.setCommonInputs([0.3]);
    flames.step();
  });
  const leaves = bank(wisp, 'leaf', 10000);
  const frame = time(() => {
    leaves.setCommonInputs([0.3, 0.3, 0.3]);
    leaves.advance(16666667);
    leaves.outputsView();
  });
  console.log(`SIMD ${simd.padEnd(3)}: ${(64 / step / 1e3).toFixed(2)} million flame steps a second, ` +
    `10 000 leaves ${frame.toFixed(2)} ms a frame`);
}
