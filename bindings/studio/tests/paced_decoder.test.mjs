// The paced decoder around a mock that accepts every packet at once and emits frames three packets late.

import assert from 'node:assert/strict';
import { test } from 'node:test';

import { paced } from '../dist/paced_decoder.js';

/** Emits frames three packets late, as decoders that reorder do, and the rest on flush. */
class Eager extends EventTarget {
  state = 'configured';
  held = [];

  constructor({ output }) {
    super();
    this.output = output;
  }

  // It never has packets that wait.
  get decodeQueueSize() { return 0; }

  decode(packet) {
    this.held.push(packet);
    if (this.held.length > 3) this.emit();
  }

  async flush() { while (this.held.length > 0) this.emit(); }

  close() { this.state = 'closed'; }

  emit() {
    const frame = { packet: this.held.shift(), close: () => (Eager.open -= 1) };
    Eager.open += 1;
    Eager.most = Math.max(Eager.most, Eager.open);
    this.output(frame);
  }

  static open = 0;
  static most = 0;
}

const pause = () => new Promise((resolve) => setTimeout(resolve));

test('hands every frame on in its order, and few of them wait', async () => {
  Object.assign(Eager, { open: 0, most: 0 });
  const frames = [];
  const decoder = new (paced(Eager))({ output: (frame) => frames.push(frame), error: assert.fail });
  for (let packet = 0; packet < 60; ++packet) decoder.decode(packet);
  assert.ok(decoder.decodeQueueSize > 40, 'the packets wait');
  const flushed = decoder.flush();
  const seen = [];
  for (let turn = 0; seen.length < 60 && turn < 1000; ++turn) {
    const frame = frames.shift();
    if (frame === undefined) await pause();
    else {
      seen.push(frame.packet);
      frame.close();
    }
  }
  await flushed;
  assert.deepEqual(seen, Array.from({ length: 60 }, (_, k) => k));
  assert.equal(Eager.open, 0);
  // Four, and those that a flush emits at the end.
  assert.ok(Eager.most <= 4 + 3, `${Eager.most} frames were open at once`);
});

test('ends what waits for it when it is closed', async () => {
  const decoder = new (paced(Eager))({ output: () => undefined, error: assert.fail });
  for (let packet = 0; packet < 20; ++packet) decoder.decode(packet);
  const flushed = decoder.flush();
  decoder.close();
  await flushed;
  assert.equal(decoder.decodeQueueSize, 0);
});
