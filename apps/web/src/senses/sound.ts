// The sound of a flame and of a breath, synthesised from noise; opt-in.

/** Seconds of crackle that repeat. */
const CRACKLE_SECONDS = 11;
/** Pops a second, and how long each rings, seconds. */
const POPS = 2.6;
const RINGS = 0.006;
const LOUDNESS = { crackle: 0.10, breath: 0.16 };
/** Seconds in which loudness follows. */
const FOLLOWS = 0.06;

function noiseOf(context: AudioContext, seconds: number, fill: (samples: Float32Array, rate: number) => void): AudioBuffer {
  const buffer = context.createBuffer(1, seconds * context.sampleRate, context.sampleRate);
  fill(buffer.getChannelData(0), context.sampleRate);
  return buffer;
}

function crackle(samples: Float32Array, rate: number): void {
  const length = Math.round(8 * RINGS * rate);
  for (let pop = 0; pop < POPS * CRACKLE_SECONDS; ++pop) {
    const at = Math.floor(Math.random() * (samples.length - length));
    const loud = Math.random() ** 3;
    for (let k = 0; k < length; ++k) samples[at + k]! += loud * (2 * Math.random() - 1) * Math.exp(-k / (RINGS * rate));
  }
}

function hiss(samples: Float32Array): void {
  for (let k = 0; k < samples.length; ++k) samples[k] = 2 * Math.random() - 1;
}

export class Sound {
  private readonly context = new AudioContext();
  private readonly fire: GainNode;
  private readonly breath: GainNode;
  private readonly tone: BiquadFilterNode;

  constructor() {
    const { context } = this;
    this.fire = this.loop(noiseOf(context, CRACKLE_SECONDS, crackle), 2400).gain;
    const blown = this.loop(noiseOf(context, 3, hiss), 700);
    this.breath = blown.gain;
    this.tone = blown.filter;
  }

  /** What is to be heard now. `burning`: share of what burns; `wind`: 1 is a strong breath. */
  frame(burning: number, wind: number): void {
    const { currentTime } = this.context;
    const strong = Math.min(1.5, Math.abs(wind));
    this.fire.gain.setTargetAtTime(LOUDNESS.crackle * burning, currentTime, FOLLOWS);
    this.breath.gain.setTargetAtTime(LOUDNESS.breath * strong ** 1.5, currentTime, FOLLOWS);
    this.tone.frequency.setTargetAtTime(450 + 900 * strong, currentTime, FOLLOWS);
  }

  close(): void {
    void this.context.close();
  }

  private loop(buffer: AudioBuffer, hertz: number): { gain: GainNode; filter: BiquadFilterNode } {
    const { context } = this;
    const source = new AudioBufferSourceNode(context, { buffer, loop: true });
    const filter = new BiquadFilterNode(context, { type: 'bandpass', frequency: hertz, Q: 0.7 });
    const gain = new GainNode(context, { gain: 0 });
    source.connect(filter).connect(gain).connect(context.destination);
    source.start();
    return { gain, filter };
  }
}
