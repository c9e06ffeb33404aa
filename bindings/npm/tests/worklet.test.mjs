// The worklet's processor in a mock of the audio thread: its messages must equal WindLevel's frames for the same sound.

import assert from 'node:assert/strict';
import { test } from 'node:test';

import { load } from '../dist/index.js';
import { gusts } from './lives.mjs';

let Processor;
globalThis.sampleRate = 48000;
globalThis.currentTime = 0;
globalThis.AudioWorkletProcessor = class {
  said = [];
  port = { postMessage: (message) => this.said.push(message), onmessage: null };
};
globalThis.registerProcessor = (name, processor) => {
  assert.equal(name, 'wisp-wind');
  Processor = processor;
};
await import('../dist/worklet.js');

const wisp = await load();
const make = (options) => new Processor({ processorOptions: { module: wisp.module, frameRate: 60, ...options } });
const tell = (processor, data) => processor.port.onmessage({ data });
const play = (processor, seconds, channels = (block) => [block]) => {
  let goesOn = true;
  for (const block of gusts(seconds)) goesOn = processor.process([channels(block)]);
  return goesOn;
};

test('it says the wind that WindLevel says, and when a calibration has ended', () => {
  const processor = make();
  tell(processor, { type: 'calibrate', seconds: 1, ask: 1 });
  assert.equal(play(processor, 5), true);
  const level = wisp.windLevel({ sampleRate: 48000 });
  for (const ask of [3, 'blow hard']) level.calibrate(ask, 1); // a number as `ask` does nothing
  const expected = [...gusts(5)].flatMap((block) => level.feed(block));
  const frames = processor.said.filter(({ type }) => type === 'wind');
  assert.equal(frames.length, 300);
  assert.ok(frames.some(({ wind }) => wind > 0.1));
  frames.forEach(({ type, time, roomRise, ...frame }, k) => {
    const { rmsClean, ...rest } = expected[k];
    assert.deepEqual(frame, rest);
  });
  const calibrated = processor.said.filter(({ type }) => type === 'calibrated');
  assert.equal(calibrated.length, 1);
  assert.ok(calibrated[0].known.backgroundRms > 0 && !calibrated[0].heard); // the sound begins with two quiet seconds
  assert.equal(frames.at(-1).roomRise, level.roomRise);
  tell(processor, { type: 'tell calibration' });
  assert.deepEqual(processor.said.at(-1), { type: 'calibration', known: level.calibration });
  level.free();
});

test('a server that renders pages can import the elements', async () => {
  assert.equal(globalThis.HTMLElement, undefined);
  assert.equal(typeof (await import('../dist/candle/element.js')).WispCandle, 'function');
  assert.equal(typeof (await import('../dist/leaves/element.js')).WispLeaves, 'function');
});

/** A stage on a made canvas, whose context is `gl` and whose picture as a file is `gl.picture`. */
async function stageOn(gl, context) {
  const { Stage } = await import('../dist/stage/stage.js');
  const canvas = { addEventListener() {}, setAttribute() {}, getContext: () => gl, getBoundingClientRect: () => ({ width: 1, height: 1 }), toBlob: (take) => take(gl.picture) };
  return new Stage(canvas, { breath: () => 0, air: () => ({ right: 0, away: 0 }), touched() {}, context, framed() {} }, false);
}

test('pictures that are wanted together are all given, by the first frame that draws', async () => {
  const gl = { isContextLost: () => false, picture: '' };
  const stage = await stageOn(gl);
  stage.detail = 1;
  stage.show({ update() {}, describe: () => '', attach() {}, draw: () => gl.picture === 'drawn' });
  const wanted = [stage.snapshot(), stage.snapshot()];
  for (gl.picture of ['blank', 'drawn']) stage.frame(0.02, 20);
  assert.deepEqual(await Promise.all(wanted), ['drawn', 'drawn']);
});

test('a context that comes back before there is a scene says so', async () => {
  assert.equal(await new Promise((heard) => stageOn({}, heard).then((stage) => stage.regain())), 'back');
});

test('a pause out of view does not count as a slow frame', async () => {
  const stage = await stageOn(null, () => {});
  stage.show({ update() {}, describe: () => '' });
  let now = 0;
  const frames = (first) => {
    for (let k = 0; k < 70; ++k) stage.frame(k > 0 ? 1 / 60 : first, (now += 1000 / 60));
  };
  frames(0);
  for (const first of [0, 20]) { // a stopped loop, and a hidden page
    now += 20_000;
    frames(first);
  }
  assert.equal(stage.adapted, 1);
  for (let k = 0; k < 100; ++k) stage.frame(0.1, (now += 100));
  assert.ok(stage.adapted < 1); // slow frames do
});

test('two channels are heard as their mean, and none is silence', () => {
  const [one, two] = [make(), make()];
  play(one, 1);
  assert.equal(two.process([[]]), true);
  play(two, 1, (block) => [block, block]);
  assert.deepEqual(two.said, one.said);
});

test('blocks of any length are heard alike', () => {
  const [short, long] = [make(), make()];
  play(short, 1);
  long.process([[Float32Array.from([...gusts(1)].flatMap((block) => [...block]))]]);
  const heard = ({ said }) => said.map(({ time, roomRise, ...frame }) => frame);
  assert.equal(long.said.length, 60);
  assert.deepEqual(heard(long), heard(short));
});

test('it starts from what was known, forgets it when told, and ends when told', () => {
  const known = { backgroundRms: 0.001953125, backgroundLevel: 0.001953125, floorDb: -60, gustRms: 0.25 };
  const processor = make({ calibration: known });
  tell(processor, { type: 'tell calibration' });
  const { gustRms } = processor.said.at(-1).known;
  assert.ok(Math.abs(gustRms - 0.25) < 1e-5); // kept in decibels, so equal only up to rounding
  tell(processor, { type: 'reset' });
  tell(processor, { type: 'tell calibration' });
  assert.ok(processor.said.at(-1).known.gustRms < 0.1);
  tell(processor, { type: 'stop' });
  assert.equal(processor.process([[new Float32Array(128)]]), false);
});

test('what cannot work says why', () => {
  const processor = make({ frameRate: 0 });
  assert.equal(processor.said.length, 1);
  assert.equal(processor.said[0].type, 'failed');
  assert.match(processor.said[0].message, /frame/);
  assert.equal(processor.process([[new Float32Array(128)]]), false);
});
