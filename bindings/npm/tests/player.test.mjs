import assert from 'node:assert/strict';
import { readFileSync, readdirSync } from 'node:fs';
import { test } from 'node:test';
import { Worker } from 'node:worker_threads';

import { hasSimd, load, noInstance, Status, WispError } from '../dist/index.js';
import { Chance } from './lives.mjs';

const models = new URL('../../../tests/c/models/', import.meta.url);
const flameBytes = readFileSync(new URL('flame.wisp', models));
const leafBytes = readFileSync(new URL('leaf.wisp', models));
const wisp = await load();

const leafRate = wisp.model(leafBytes).facts.rateHz;
const wrong = (status, words) => (error) => {
  assert.ok(error instanceof WispError, String(error));
  assert.equal(error.status, status);
  assert.match(error.message, words);
  return true;
};

const bankOf = (bytes) => (options) => {
  const model = wisp.model(bytes);
  const bank = model.bank(options);
  model.free();
  return bank;
};
const flames = bankOf(flameBytes);
const leaves = bankOf(leafBytes);

test('it takes SIMD where the engine has it, and says so', async () => {
  assert.equal(wisp.simd, hasSimd());
  assert.equal((await load({ simd: 'off' })).simd, false);
  assert.match(wisp.version, /^\d+\.\d+\.\d+$/);
});

test('it is made of bytes, of a module, or of a response', async () => {
  const bytes = readFileSync(new URL('../dist/wisp.wasm', import.meta.url));
  const typed = ['application/wasm', 'application/wasm; charset=utf-8'].map((type) => new Response(bytes, { headers: { 'content-type': type } }));
  for (const wasm of [bytes, wisp.module, new Response(bytes), ...typed]) {
    assert.equal((await load({ wasm })).version, wisp.version);
  }
  await assert.rejects(load({ wasm: new Response('', { status: 404 }) }), wrong(Status.badData, /404/));
  await assert.rejects(load({ wasm: new Uint8Array([1, 2, 3, 4]) }), WebAssembly.CompileError);
});

test('it works in a worker, from a module that is handed over', async () => {
  const source = `
    const { parentPort, workerData } = require('node:worker_threads');
    import(workerData.script).then(async ({ load }) => {
      const wisp = await load({ wasm: workerData.module });
      parentPort.postMessage(wisp.model(workerData.model).name);
    });`;
  const script = new URL('../dist/index.js', import.meta.url).href;
  const worker = new Worker(source, { eval: true, workerData: { script, module: wisp.module, model: flameBytes } });
  assert.equal(await new Promise((resolve, reject) => worker.on('message', resolve).on('error', reject)), 'made-up flame');
});

test('the shipped flame says of which components its equations are, fewer than its outputs', () => {
  const model = wisp.model(readFileSync(new URL('../../../apps/web/public/models/flame.wisp', import.meta.url)));
  const { arx, outputs } = model;
  assert.ok(arx.outputs < outputs.length, `${arx.outputs} of ${outputs.length}`);
  assert.deepEqual([arx.na.length, arx.na[0].length, arx.noise.length], [arx.outputs, arx.outputs, arx.outputs]);
  model.free();
});

test('a flame model says what it is', () => {
  const model = wisp.model(flameBytes);
  const { name, kind, view, inputs, outputs, facts, chain, arx } = model;
  assert.deepEqual([name, kind, view, chain], ['made-up flame', 'arx', 'outline', null]);
  assert.deepEqual(inputs, [{ name: 'wind', unit: '', lowest: -1, highest: 1, evenOdd: true }]);
  assert.deepEqual([outputs.length, outputs[15].name], [16, 'p7.y']);
  assert.deepEqual([facts.rateHz, facts.stepNanoseconds, facts.controlPoints, facts.metresPerUnit], [30, 33333333, 8, 0.03]);
  assert.deepEqual(facts.blowOut, { input: 0, level: 1.3, seconds: 0.15, haste: 2, recoverySeconds: 0.3 });
  // The file stores no operation counts, and the module computes none.
  assert.deepEqual([facts.multiplyAddsPerFrame, facts.operationsPerFrame], [0, 0]);
  assert.deepEqual([arx.regressors, arx.resamples, arx.noise.length], [6, false, 16]);
  assert.deepEqual(arx.na[0].slice(0, 3), [4, 4, 0]);
  assert.deepEqual(arx.nb[15], [4, 4, 4, 0, 0, 0]);
  assert.deepEqual(model.provenance, {
    program: 'wisp 0.1.0',
    sources: ['clip.mp4'],
    options: [{ name: 'order', value: '4' }],
    figures: [{ name: 'fit', value: 61.5 }],
    usable: true,
    reason: 'made up',
  });
  model.free();
  model.free();
  assert.throws(() => model.provenance, wrong(Status.badArgument, /null pointer/));
  assert.throws(() => model.bank(), wrong(Status.badArgument, /null pointer/));
});

test('a leaf model says what it is', () => {
  const model = wisp.model(leafBytes);
  const { halfWidth, halfLength, blowOut } = model.facts;
  assert.deepEqual([model.kind, model.view, model.arx, halfWidth, halfLength, blowOut], ['chain', 'pose', null, 0.0365, 0.0245, null]);
  assert.deepEqual(model.chain, {
    modes: 2,
    segments: [{ mode: 0, steps: 8 }, { mode: 0, steps: 5 }, { mode: 1, steps: 12 }],
    history: 2,
    gustOrder: 1,
    headingFree: true,
    initial: [0.75, 0.25],
    transitions: [[0.25, 0.75], [0.5, 0.5]],
  });
  model.free();
});

test('bytes that are no model are told so, and leave nothing behind', () => {
  const before = wisp.memoryBytes;
  const chance = new Chance();
  const random = Uint8Array.from({ length: 1000 }, () => 128 + 127 * chance.next());
  const flipped = Uint8Array.from(flameBytes);
  flipped[flipped.length >> 1] ^= 1;
  const cases = [
    [new Uint8Array(0), /is empty/],
    [random, /is not a .wisp model/],
    [new Uint8Array(50e6), /is not a .wisp model/],
    [new TextEncoder().encode('<!doctype html>'), /is not a .wisp model/],
    [flameBytes.subarray(0, 20), /cut short/],
    [flameBytes.subarray(0, flameBytes.length >> 1), /cut or damaged/],
    [flipped, /damaged: its contents hash to 0x[0-9a-f]{16}, the header says 0x[0-9a-f]{16};/],
  ];
  for (const [bytes, words] of cases) assert.throws(() => wisp.model(bytes), wrong(Status.badData, words));
  assert.equal(wisp.memoryBytes, before);
  assert.equal(wisp.model(flameBytes.buffer.slice(flameBytes.byteOffset, flameBytes.byteOffset + flameBytes.length)).name, 'made-up flame');
});

test('errors say numbers as the library does anywhere', () => {
  const cases = [
    [7999.5, 'is 7999.5 Hz, expected 8000 to 192000 Hz'],
    [199999.9999999, 'is 200000 Hz,'],
    [-0.25, 'is -0.25 Hz,'],
    [1e21, 'is 1000000000000000000000 Hz,'],
    [Infinity, 'is inf Hz,'],
    [NaN, 'is nan Hz,'],
  ];
  for (const [sampleRate, words] of cases) {
    assert.throws(() => wisp.windLevel({ sampleRate }), wrong(Status.badArgument, new RegExp(words)));
  }
});

test('instances are spawned, lead lives of their own and are ended', () => {
  const bank = flames({ capacity: 3, polylinePoints: 12 });
  assert.deepEqual([bank.capacity, bank.inputs, bank.outputs, bank.polylinePoints], [3, 1, 16, 12]);
  const first = bank.spawn();
  const second = bank.spawn();
  const twin = bank.spawn(0);
  assert.throws(() => bank.spawn(), wrong(Status.noInstanceLeft, /full/));
  assert.equal(bank.size, 3);
  assert.equal(bank.at(1), second);
  for (let k = 0; k < 20; ++k) bank.step();
  const all = bank.outputsView();
  assert.equal(all.length, 3 * 16);
  assert.deepEqual(bank.instanceOutputs(first), bank.instanceOutputs(twin)); // both use random stream 0
  assert.notDeepEqual(bank.instanceOutputs(first), bank.instanceOutputs(second));
  assert.deepEqual(bank.polylinesView().slice(24, 48), bank.polyline(second).slice());
  bank.end(second);
  assert.equal(bank.alive(second), false);
  assert.equal(bank.at(1), noInstance);
  assert.throws(() => bank.end(second), wrong(Status.notAlive, /not alive/));
  assert.throws(() => bank.flameState(second), wrong(Status.notAlive, /not alive/));
  assert.notEqual(bank.spawn(), second);
  assert.equal(bank.clamped().steps, 60);
  bank.free();
});

test('inputs reach all, the same all, or one', () => {
  const bank = flames({ capacity: 2 });
  const [calm, windy] = [bank.spawn(5), bank.spawn(5)];
  const outputs = (instance) => bank.instanceOutputs(instance);
  const steps = (count) => {
    for (let k = 0; k < count; ++k) bank.step();
  };
  bank.setInstanceInputs(windy, [0.8]);
  steps(10);
  assert.notDeepEqual(outputs(calm), outputs(windy));
  bank.reset();
  bank.setCommonInputs([0.8]);
  steps(10);
  assert.deepEqual(outputs(calm), outputs(windy));
  bank.reset();
  const view = bank.inputsView();
  view.set([0, 0.8]);
  bank.setInputs(view);
  steps(10);
  assert.notDeepEqual(outputs(calm), outputs(windy));
  assert.throws(() => bank.setInputs([1]), wrong(Status.badArgument, /room for 1, expected at least 2/));
  assert.throws(() => bank.setCommonInputs([1, 2, 3]), wrong(Status.badArgument, /room for 3, expected 1/));
  bank.setCommonInputs([NaN]);
  steps(1);
  assert.ok(outputs(calm).every(Number.isFinite));
  bank.free();
});

test('time passes at any frame rate', () => {
  const bank = flames({});
  bank.spawn();
  assert.equal(bank.advance(100e6), 3);
  assert.equal(bank.advance(0), 0);
  assert.equal(bank.advance(-5), 0);
  assert.equal(bank.advance(NaN), 0);
  for (const long of [1e30, 2 ** 64]) assert.equal(bank.advance(long), 300); // no more than ten seconds
  const hasty = flames({ longest: 100 });
  assert.equal(hasty.advance(5e9), 3); // at most the longest advance
  hasty.free();
  assert.throws(() => flames({ longest: 20000 }), wrong(Status.badArgument, /longest/));
  bank.setNoise(0);
  assert.equal(bank.noise, 0);
  bank.free();
});

test('a flame is blown out, smokes, and is lit again', () => {
  const bank = flames({});
  const flame = bank.spawn();
  const { light, kelvin, ...state } = bank.flameState(flame);
  assert.deepEqual(state, { lit: true, flameSize: 1, sinceLit: Infinity, sinceOut: Infinity, wentOut: false, relit: false, intensity: 1 });
  assert.ok(light[1] > 0.2 && light[1] < 0.8 && kelvin > 1500 && kelvin < 2500, `${light}, ${kelvin}`);
  bank.setCommonInputs([1.5]);
  for (let k = 0; k < 60; ++k) bank.advance(1e9 / 60);
  const out = bank.flameState(flame);
  assert.deepEqual([out.lit, out.flameSize], [false, 0]);
  assert.ok(out.sinceOut > 0.3e9 && out.sinceOut < 1e9);
  assert.deepEqual([...bank.flameSizes()], [0]);
  bank.setCommonInputs([0]);
  bank.relight(flame);
  for (let k = 0; k < 60; ++k) bank.advance(1e9 / 60);
  assert.equal(bank.flameState(flame).lit, true);
  bank.extinguish(flame);
  assert.deepEqual([bank.flameState(flame).lit, bank.flameState(flame).wentOut], [false, true]);
  for (let k = 0; k < 60; ++k) bank.advance(1e9 / 60);
  assert.deepEqual([bank.flameState(flame).intensity, bank.flameState(flame).wentOut], [0, false]);
  bank.relight(flame);
  assert.equal(bank.flameState(flame).relit, true);
  bank.step();
  assert.deepEqual([bank.flameState(flame).relit, bank.flameState(flame).wentOut], [false, false]);
  bank.free();
});

test('a leaf falls, is thrown, and comes to rest on the ground', () => {
  const bank = leaves({ capacity: 2 });
  const leaf = bank.spawn();
  bank.place(leaf, { position: [1, 2, 3], velocity: [0.6, 0, -0.75] });
  assert.ok(Math.abs(bank.instanceOutputs(leaf)[2] - 3) < 1e-4);
  assert.deepEqual([bank.chainPlace(leaf).lies, bank.chainPlace(leaf).landed], [false, false]);
  const before = bank.instanceOutputs(leaf).slice();
  bank.step();
  const after = bank.instanceOutputs(leaf), { velocity } = bank.chainPlace(leaf), rate = leafRate;
  for (let k = 0; k < 3; ++k) assert.ok(Math.abs(velocity[k] - (after[k] - before[k]) * rate) < 1e-2, `${velocity}`);
  bank.setGround(0);
  let landings = 0;
  for (let k = 0; k < 600; ++k) {
    bank.step();
    landings += bank.chainPlace(leaf).landed;
  }
  assert.deepEqual([landings, bank.chainPlace(leaf).lies], [1, true]);
  assert.deepEqual([...bank.chainPlace(leaf).velocity, ...bank.chainPlace(leaf).spin], [0, 0, 0, 0, 0, 0]);
  const rest = bank.instanceOutputs(leaf);
  bank.step();
  assert.deepEqual(bank.instanceOutputs(leaf), rest);
  assert.ok(Math.abs(rest[2]) < 0.1);
  bank.setGround(null);
  bank.reset(leaf);
  const { segment, mode } = bank.chainPlace(leaf);
  assert.equal(mode, segment === 2 ? 1 : 0);
  const placed = (body) => {
    bank.place(leaf, { position: [1, 2, 3], ...body });
    const { segment, mode } = bank.chainPlace(leaf); // leaves a velocity where the next body is written
    bank.step();
    return [segment, mode, bank.instanceOutputs(leaf)];
  };
  assert.deepEqual(placed({ orientation: undefined, velocity: undefined, spin: undefined }), placed({}));
  assert.throws(() => bank.place(leaf, { position: [NaN, 0, 0] }), wrong(Status.badArgument, /not finite/));
  assert.throws(() => bank.setGround(Infinity), wrong(Status.badArgument, /not finite/));
  bank.free();
  const flame = flames({});
  assert.equal(flame.chainPlace(flame.spawn()), null);
  assert.throws(() => flame.place(flame.at(0), { position: [0, 0, 0] }), wrong(Status.badArgument, /not a chain/));
  flame.free();
});

test('a flame in the round has a surface: vertices on its rings, and triangles between them', () => {
  const flat = wisp.model(readFileSync(new URL('../../../apps/web/public/models/flame.wisp', import.meta.url)));
  const bank = flat.inTheRound().bank();
  flat.free();
  const flame = bank.spawn();
  bank.step();
  const rings = bank.rings(flame).slice(), vertices = bank.mesh(flame, 8), triangles = bank.triangles(8);
  assert.equal(vertices.length, rings.length * 8);
  assert.equal(triangles.length, 3 * (2 * (rings.length / 6) * 8 - 4));
  assert.equal(Math.max(...triangles), vertices.length / 6 - 1);
  for (let ring = 0; ring < rings.length / 6; ++ring) {
    const middle = [0, 1, 2].map((k) => {
      let sum = 0;
      for (let v = 0; v < 8; ++v) sum += vertices[6 * (8 * ring + v) + k] / 8;
      return sum;
    });
    for (let k = 0; k < 3; ++k) assert.ok(Math.abs(middle[k] - rings[6 * ring + k]) < 1e-5);
  }
  bank.free();
});

test('a chain takes its ground, and saves it', () => {
  const bank = leaves({ capacity: 1 });
  const saved = bank.save();
  assert.equal(bank.chainSettings.ground, null);
  bank.setGround(-2);
  assert.equal(bank.chainSettings.ground, -2);
  bank.restore(saved);
  assert.equal(bank.chainSettings.ground, null);
  bank.free();
});

test('a bank is saved and goes on with the same bits; damage is told', () => {
  const bank = flames({ capacity: 2 });
  bank.spawn();
  bank.advance(1e9);
  const saved = bank.save();
  bank.advance(1e9);
  const then = bank.outputsView().slice();
  bank.restore(saved);
  bank.advance(1e9);
  assert.deepEqual(bank.outputsView(), then);
  saved[saved.length >> 1] ^= 1;
  assert.throws(() => bank.restore(saved), wrong(Status.badData, /damaged/));
  assert.throws(() => bank.restore(new Uint8Array(0)), wrong(Status.badData, /not a saved bank/));
  bank.free();
});

test('options out of their range are told, and so is a bank that was freed', () => {
  const model = wisp.model(flameBytes);
  assert.throws(() => model.bank({ capacity: 2 ** 21 }), wrong(Status.badArgument, /capacity/));
  assert.throws(() => model.bank({ polylinePoints: 1 }), wrong(Status.badArgument, /polyline/));
  const bank = model.bank();
  model.free();
  bank.free();
  bank.free();
  assert.throws(() => bank.step(), wrong(Status.badArgument, /null pointer/));
  assert.throws(() => bank.outputsView(), wrong(Status.badArgument, /null pointer/));
  assert.throws(() => bank.size, wrong(Status.badArgument, /null pointer/));
});

test('views follow when the memory grows', async () => {
  const fresh = await load();
  const model = fresh.model(flameBytes);
  const small = model.bank({ capacity: 2 });
  small.spawn();
  small.step();
  const before = small.outputsView().slice();
  const memory = fresh.memoryBytes;
  const large = model.bank({ capacity: 20000 });
  for (let k = 0; k < 20000; ++k) large.spawn();
  large.step();
  assert.equal(large.outputsView().length, 20000 * 16);
  assert.ok(fresh.memoryBytes > memory);
  assert.deepEqual(small.outputsView(), before);
  small.step();
  assert.notDeepEqual(small.outputsView(), before);
});

test('every call of every shipped model takes its own number of values, and says so of another', () => {
  const root = new URL('../../../', import.meta.url);
  let models = 0, refused = 0;
  for (const folder of ['apps/web/public/models/', 'apps/web/tests/models/', 'tests/model/golden/', 'tests/c/models/']) {
    for (const name of readdirSync(new URL(folder, root)).filter((each) => each.endsWith('.wisp'))) {
      const model = wisp.model(readFileSync(new URL(folder + name, root))), bank = model.bank({ capacity: 3 });
      const inputs = model.inputs.length, outputs = model.outputs.length;
      model.free();
      const first = bank.spawn();
      bank.spawn();
      const one = (size) => size === inputs;
      const doors = [
        [(values) => bank.setInputs(values), (size) => size >= 2 * inputs], // a row for each slot at least
        [(values) => bank.setCommonInputs(values), one],
        [(values) => bank.setInstanceInputs(first, values), one],
      ];
      for (const [call, right] of doors) {
        for (const size of [0, 1, inputs, inputs + 1, 2 * inputs, 2 * inputs + 1, 1000]) {
          const values = new Float32Array(size);
          if (right(size)) call(values);
          else assert.throws(() => call(values), WispError, `${name} ${size}`);
          refused += !right(size);
        }
      }
      bank.step();
      assert.equal(bank.outputsView().length, 2 * outputs);
      assert.equal(bank.instanceOutputs(first).length, outputs);
      if (bank.polylinePoints === 0) assert.throws(() => bank.polyline(first), WispError, name);
      else assert.ok(bank.polyline(first).every(Number.isFinite), name);
      assert.ok(bank.outputsView().every(Number.isFinite), name);
      bank.free();
      ++models;
    }
  }
  assert.ok(models > 10 && refused > 100, `${models} models, ${refused} refused`);
});

test('a bank for which there is no memory is told so, and the module goes on', async () => {
  const model = wisp.model(flameBytes);
  assert.throws(() => model.bank({ capacity: 2 ** 20 }), wrong(Status.noMemory, /no memory for a bank of \d+ bytes/));
  model.bank({ capacity: 1 }).free();
  model.free();
  const wide = flames({ capacity: 2 ** 17, polylinePoints: 4096 });
  assert.throws(() => wide.polylinesView(), wrong(Status.noMemory, /no memory for 4294967296 bytes/)); // which 32 bits wrap to 0
  wide.free();
});

test('memory stays flat over many lives', () => {
  const live = () => {
    const bank = flames({ capacity: 16 });
    for (let k = 0; k < 16; ++k) bank.spawn();
    bank.advance(1e9);
    bank.polylinesView();
    bank.restore(bank.save());
    bank.free();
    const wind = wisp.windLevel({ sampleRate: 44100 });
    wind.feed(new Float32Array(1000));
    wind.free();
    assert.throws(() => wisp.model(flameBytes.subarray(0, 100)));
  };
  live();
  const before = wisp.memoryBytes;
  for (let k = 0; k < 200; ++k) live();
  assert.equal(wisp.memoryBytes, before);
});

// A breath: noise that falls by 12 dB an octave, as wind does at a microphone. `level`: factor of its amplitude.
function breath(seconds, rate, level, chance) {
  const sound = new Float32Array(Math.round(seconds * rate));
  let slow = 0;
  let slower = 0;
  for (let k = 0; k < sound.length; ++k) {
    slow += 0.05 * (chance.next() - slow);
    slower += 0.05 * (slow - slower);
    sound[k] = level * slower + 0.0005 * chance.next();
  }
  return sound;
}

test('a breath is wind, the room is not, and blocks do not matter', () => {
  const rate = 48000;
  const chance = new Chance();
  const room = breath(3, rate, 0, chance);
  const blow = breath(1.5, rate, 2, chance);
  const whole = wisp.windLevel({ sampleRate: rate, frameRate: 60 });
  assert.ok(whole.feed(room).every((frame) => frame.wind < 0.01));
  const frames = whole.feed(blow);
  assert.equal(frames.length, 90);
  assert.ok(frames.slice(30).every((frame) => frame.wind > 0.3 && frame.confidence > 0.8));
  assert.deepEqual(whole.latest, frames.at(-1));
  assert.ok(whole.latencySeconds >= 0 && whole.latencySeconds < 0.05);

  const known = whole.calibration;
  assert.ok(known.gustRms > 0 && known.backgroundRms > 0);
  const pieces = wisp.windLevel({ sampleRate: rate, frameRate: 60 });
  pieces.feed(room);
  const again = [];
  for (let at = 0; at < blow.length; at += 77) again.push(...pieces.feed(blow.subarray(at, at + 77)));
  assert.deepEqual(again, frames);

  pieces.reset();
  pieces.calibration = known;
  assert.ok(Math.abs(pieces.calibration.gustRms - known.gustRms) < 0.1 * known.gustRms);
  assert.throws(() => (pieces.calibration = { ...known, gustRms: NaN }), wrong(Status.badArgument, /no room has/));
  whole.free();
  pieces.free();
  whole.free();
  assert.throws(() => whole.feed(blow), wrong(Status.badArgument, /null pointer/));
});

test('16-bit samples and two channels are heard as well', () => {
  const sound = breath(1, 44100, 2, new Chance());
  const words = Int16Array.from(sound, (x) => Math.round(32767 * x));
  const stereo = Float32Array.from({ length: 2 * words.length }, (_, k) => words[k >> 1] / 32768);
  const one = wisp.windLevel({ sampleRate: 44100 });
  const two = wisp.windLevel({ sampleRate: 44100, channels: 2 });
  const levels = one.feed(words).map((frame) => frame.rms);
  two.feed(stereo).forEach((frame, k) => assert.ok(Math.abs(frame.rms - levels[k]) <= 1e-6));
  assert.equal(levels.length, 60);
  assert.throws(() => two.feed(new Float32Array(3)), wrong(Status.badArgument, /multiple of the 2 channels/));
  assert.throws(() => wisp.windLevel({ sampleRate: 100 }), wrong(Status.badArgument, /100/));
  one.free();
  two.free();
});
