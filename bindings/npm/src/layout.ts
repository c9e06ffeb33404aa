// The C ABI's structs in WebAssembly memory: byte offset and kind of each field. wasm/layout.cpp checks the compiler
// against the same numbers. The package's types of facts, states and frames are made of these fields.

import type { Native } from './native.js';

const never = 0x7fffffffffffffffn;

/** Reads a field of each kind at address p. */
const readers = {
  count: ({ data }: Native, p: number) => data.getUint32(p, true),
  flag: ({ data }: Native, p: number) => data.getUint32(p, true) === 1,
  float: ({ data }: Native, p: number) => data.getFloat32(p, true),
  double: ({ data }: Native, p: number) => data.getFloat64(p, true),
  long: ({ data }: Native, p: number) => Number(data.getBigInt64(p, true)),
  /** Nanoseconds; Infinity for never. */
  time: ({ data }: Native, p: number) => (data.getBigInt64(p, true) === never ? Infinity : Number(data.getBigInt64(p, true))),
  text: (native: Native, p: number) => native.text(native.data.getUint32(p, true)),
  vector: ({ data }: Native, p: number): [number, number, number] => [data.getFloat32(p, true), data.getFloat32(p + 4, true), data.getFloat32(p + 8, true)],
};

export type Fields = Readonly<Record<string, readonly [at: number, kind: keyof typeof readers]>>;

export interface Struct<F extends Fields> { size: number; fields: F }

export type Values<F extends Fields> = { -readonly [Name in keyof F]: ReturnType<(typeof readers)[F[Name][1]]> };

const struct = <const F extends Fields>(size: number, fields: F): Struct<F> => ({ size, fields });

/** Values of all fields of a struct. */
export function valuesAt<F extends Fields>(native: Native, p: number, { fields }: Struct<F>): Values<F> {
  const values: Record<string, unknown> = {};
  for (const name in fields) {
    const [at, kind] = fields[name]!;
    values[name] = readers[kind](native, p + at);
  }
  return values as Values<F>;
}

type Given<F extends Fields> = { [Name in keyof F]?: number | bigint | readonly number[] };

/** Creates a bank (of a model) or a wind estimator with the given options, others by default. Returns its pointer. */
export const madeFrom = <F extends Fields>(native: Native, kind: 'bank' | 'wind', options: Struct<F>, given: Given<F>, ...model: number[]): number =>
  native.allocating(() => native.withRoom(options.size, (p) => {
    native.functions[`wisp_${kind}_default_options`]!(p);
    putAt(native, p, options, given);
    return native.made((made) => native.functions[`wisp_${kind}_create`]!(...model, p, made));
  }));

/** Writes the given fields of a struct; those that are undefined stay. Vectors may have any length. */
export function putAt<F extends Fields>({ data }: Native, p: number, { fields }: Struct<F>, given: Given<F>): void {
  for (const name in fields) {
    const [at, kind] = fields[name]!;
    const value = given[name];
    if (value === undefined) continue;
    if (kind === 'count') data.setUint32(p + at, Number(value), true);
    else if (kind === 'double') data.setFloat64(p + at, Number(value), true);
    else if (kind === 'long') data.setBigUint64(p + at, BigInt(value as number), true);
    else [value].flat().forEach((one, k) => data.setFloat32(p + at + 4 * k, Number(one), true));
  }
}

export const modelFacts = struct(128, {
  inputs: [4, 'count'],
  outputs: [8, 'count'],
  /** Number of control points of an outline; otherwise 0. */
  controlPoints: [12, 'count'],
  /** Steps per second; `stepNanoseconds`: duration of a step. */
  rateHz: [24, 'double'],
  /** Metres per unit of an outline; 0 if unknown. */
  metresPerUnit: [32, 'double'],
  stepNanoseconds: [40, 'long'],
  /** Multiplications per frame, counted as non-zero coefficients; as stored in the file; 0 if missing. */
  multiplyAddsPerFrame: [48, 'long'],
  /** All arithmetic operations of a frame, as stored; 0 if missing. */
  operationsPerFrame: [56, 'long'],
  dynamics: [80, 'count'],
  view: [84, 'count'],
  /** Half sizes in metres of a body with pose or position; 0 if unknown. */
  halfWidth: [88, 'double'],
  halfLength: [96, 'double'],
});

/** The model facts' fields `blow_out_…`, for flames that wind extinguishes. */
export const blowOut = struct(modelFacts.size, {
  /** Index of the wind input. */
  input: [120, 'count'],
  /** Minimum wind that extinguishes when it lasts `seconds`, in the input's unit. */
  level: [64, 'double'],
  seconds: [72, 'double'],
  /** Wind of twice the level extinguishes in seconds / (1 + haste). */
  haste: [104, 'double'],
  /** Seconds below the level until full recovery. */
  recoverySeconds: [112, 'double'],
});

export const channel = struct(40, {
  name: [8, 'text'],
  /** Unit of the values; '' if none. */
  unit: [12, 'text'],
  /** Trained or observed range. The bank clamps values to this range extended by half its width at each end. */
  lowest: [16, 'double'],
  highest: [24, 'double'],
  /** For inputs: whether the dynamics have separate coefficients for positive and negative values. */
  evenOdd: [32, 'flag'],
});

export const provenance = struct(32, { sources: [4, 'count'], options: [8, 'count'], figures: [12, 'count'], usable: [16, 'flag'], program: [24, 'text'], reason: [28, 'text'] });

export const note = struct(16, { name: [8, 'text'], value: [12, 'text'] });

export const figure = struct(24, { name: [8, 'text'], value: [16, 'double'] });

export const arxFacts = struct(20, { outputs: [4, 'count'], regressors: [8, 'count'], history: [12, 'count'], resamples: [16, 'flag'] });

export const chainFacts = struct(24, { modes: [4, 'count'], segments: [8, 'count'], history: [12, 'count'], gustOrder: [16, 'count'], headingFree: [20, 'flag'] });

export const bankOptions = struct(32, { capacity: [4, 'count'], polylinePoints: [8, 'count'], longest: [12, 'count'], seed: [16, 'long'] });

export const bankFacts = struct(48, {
  capacity: [4, 'count'],
  alive: [8, 'count'],
  slots: [12, 'count'],
  inputs: [16, 'count'],
  outputs: [20, 'count'],
  polylinePoints: [24, 'count'],
  clamped: [32, 'long'],
  steps: [40, 'long'],
});

export const flameState = struct(56, {
  lit: [4, 'flag'],
  /** Size from 0 to 1; outputs already include it. */
  flameSize: [8, 'float'],
  events: [12, 'count'],
  sinceLit: [16, 'time'],
  sinceOut: [24, 'time'],
  /** Light source at the outline's centroid; `intensity`: area relative to rest; `kelvin`: colour temperature. */
  light: [32, 'vector'],
  intensity: [44, 'float'],
  kelvin: [48, 'float'],
});

export const chainPlace = struct(48, {
  segment: [4, 'count'],
  step: [8, 'count'],
  mode: [12, 'count'],
  /** Over the last step: metres and radians a second, z up. */
  velocity: [16, 'vector'],
  spin: [28, 'vector'],
  /** Whether the instance rests on the ground; `landed`: touched it in the last `step()` or `advance()`. */
  lies: [40, 'flag'],
  landed: [44, 'flag'],
});

export const chainSettings = struct(12, { hasGround: [4, 'flag'], ground: [8, 'float'] });

export const body = struct(56, { position: [4, 'vector'], orientation: [16, 'vector'], velocity: [32, 'vector'], spin: [44, 'vector'] });

export const windOptions = struct(56, {
  /** Number of interleaved channels, 1 to 8; default 1. */
  channels: [4, 'count'],
  /** Sampling rate of each channel, 8000 to 192000 Hz. */
  sampleRate: [8, 'double'],
  /** Frames of wind per second, 1 to 1000; default 60. */
  frameRate: [16, 'double'],
  /** Exponent of the sound's RMS that gives wind speed, 0.1 to 2; default 0.5. */
  exponent: [24, 'double'],
  /** Averaging time of the level, 0 to 1 s; default 0. */
  smoothingSeconds: [32, 'double'],
  /** Maximum rise of the background, dB a second, 0 to 60; default 1. */
  floorRiseDbPerSecond: [40, 'double'],
  /** RMS of the wind's band that initially gives wind 1, full scale 1; default 0.04. */
  firstGustRms: [48, 'double'],
});

export const windFrame = struct(40, {
  index: [0, 'long'],
  rms: [8, 'float'],
  rmsClean: [12, 'float'],
  level: [16, 'float'],
  /** Proportional to wind speed; 1 lies between soft breath and hard blowing. */
  speed: [20, 'float'],
  /** Input for a model: `speed` while the sound resembles blowing, otherwise less; 0 in silence. */
  wind: [24, 'float'],
  /** Confidence from 0 to 1 that the sound is blowing, not talking. */
  confidence: [28, 'float'],
  background: [32, 'float'],
  /** Share of samples at full scale. */
  clipped: [36, 'float'],
});

export const windCalibration = struct(20, { backgroundRms: [4, 'float'], backgroundLevel: [8, 'float'], floorDb: [12, 'float'], gustRms: [16, 'float'] });
