// Plays models and sounds as tests/c/frames_in_c.c does, through the package: the hashes must be equal.

/** Two FNV-1a hashes over 32-bit words; the second takes each word with its halves swapped. */
export class Hash {
  words = new Uint32Array(2).fill(2166136261);

  fold(values) {
    const bits = new Uint32Array(values.buffer, values.byteOffset, values.length);
    for (const word of bits) {
      this.words[0] = Math.imul(this.words[0] ^ word, 16777619);
      this.words[1] = Math.imul(this.words[1] ^ ((word >>> 16) | (word << 16)), 16777619);
    }
  }

  get hex() {
    return [...this.words].map((word) => word.toString(16).padStart(8, '0')).join(' ');
  }
}

/** Random numbers from −1 to 1, by a linear congruential generator. */
export class Chance {
  state = 1;

  next() {
    this.state = (Math.imul(this.state, 1664525) + 1013904223) | 0;
    return (this.state >> 8) / 8388608;
  }
}

export function hashOfLife(wisp, bytes, frames) {
  const model = wisp.model(bytes);
  const isChain = model.kind === 'chain';
  const goesOut = model.facts.blowOut !== null;
  const bank = model.bank({ capacity: 2, seed: 7 });
  model.free();
  const instances = [bank.spawn(), bank.spawn()];
  const wind = new Float32Array(bank.inputs);
  const chance = new Chance();
  const hash = new Hash();
  for (let frame = 0; frame < frames; ++frame) {
    if (frame % 7 === 0) {
      for (let k = 0; k < wind.length; ++k) wind[k] = 2 * chance.next();
      bank.setCommonInputs(wind);
    }
    bank.advance(16666667);
    hash.fold(bank.outputsView());
    if (frame % 500 === 499 && goesOut) bank.relight(instances[Math.floor(frame / 500) % 2]);
    if (frame % 5000 === 4999) bank.restore(bank.save());
    if (frame % 700 === 699 && isChain) {
      bank.place(instances[0], { position: [0, 0, 0], orientation: [0.75, 0.5, 0, 0], velocity: [0.5, 0, -0.25] });
    }
  }
  bank.free();
  return hash.hex;
}

/** Half-second gusts that rumble over a soft hiss, in blocks of 128 samples at 48 kHz. */
export function* gusts(seconds) {
  const rate = 48000;
  const chance = new Chance();
  let rumble = 0;
  for (let position = 0; position < seconds * rate; ) {
    const block = new Float32Array(128);
    for (let k = 0; k < block.length; ++k, ++position) {
      const blows = position > 2 * rate && Math.floor(position / (rate / 2)) % 3 === 0;
      const one = chance.next();
      rumble += (one - rumble) / 16;
      block[k] = (blows ? 2 * rumble : 0) + one / 1024;
    }
    yield block;
  }
}

export function hashOfWind(wisp, seconds) {
  const wind = wisp.windLevel({ sampleRate: 48000 });
  const hash = new Hash();
  for (const block of gusts(seconds)) {
    for (const f of wind.feed(block)) {
      hash.fold(new Float32Array([f.rms, f.rmsClean, f.level, f.speed, f.wind, f.confidence, f.background, f.clipped]));
    }
  }
  wind.free();
  return hash.hex;
}
