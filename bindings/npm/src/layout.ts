// The C ABI's structs in WebAssembly memory: byte offset and kind of each field. wasm/layout.cpp checks the compiler
// against the same numbers.

import type { Native } from './native.js';

const never = 0x7fffffffffffffffn;

/** How a field of each kind is read. */
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

export interface Struct<F extends Fields> {
  size: number;
  fields: F;
}

export type Values<F extends Fields> = { [Name in keyof F]: ReturnType<(typeof readers)[F[Name][1]]> };

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

/** Writes the given fields of a struct; those that are undefined stay. Vectors may have any length. */
export function putAt<F extends Fields>({ data }: Native, p: number, { fields }: Struct<F>, given: { [Name in keyof F]?: number | bigint | readonly number[] }): void {
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
  controlPoints: [12, 'count'],
  rateHz: [24, 'double'],
  metresPerUnit: [32, 'double'],
  stepNanoseconds: [40, 'long'],
  multiplyAddsPerFrame: [48, 'long'],
  operationsPerFrame: [56, 'long'],
  blowOutLevel: [64, 'double'],
  blowOutSeconds: [72, 'double'],
  dynamics: [80, 'count'],
  view: [84, 'count'],
  halfWidth: [88, 'double'],
  halfLength: [96, 'double'],
  blowOutHaste: [104, 'double'],
  blowOutRecoverySeconds: [112, 'double'],
  blowOutInput: [120, 'count'],
});

export const channel = struct(40, { name: [8, 'text'], unit: [12, 'text'], lowest: [16, 'double'], highest: [24, 'double'], evenOdd: [32, 'flag'] });

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
  flameSize: [8, 'float'],
  events: [12, 'count'],
  sinceLit: [16, 'time'],
  sinceOut: [24, 'time'],
  light: [32, 'vector'],
  intensity: [44, 'float'],
  kelvin: [48, 'float'],
});

export const chainPlace = struct(48, {
  segment: [4, 'count'],
  step: [8, 'count'],
  mode: [12, 'count'],
  velocity: [16, 'vector'],
  spin: [28, 'vector'],
  lies: [40, 'flag'],
  landed: [44, 'flag'],
});

export const chainSettings = struct(12, { hasGround: [4, 'flag'], ground: [8, 'float'] });

export const body = struct(56, { position: [4, 'vector'], orientation: [16, 'vector'], velocity: [32, 'vector'], spin: [44, 'vector'] });

export const windOptions = struct(56, {
  channels: [4, 'count'],
  sampleRate: [8, 'double'],
  frameRate: [16, 'double'],
  exponent: [24, 'double'],
  smoothingSeconds: [32, 'double'],
  floorRiseDbPerSecond: [40, 'double'],
  firstGustRms: [48, 'double'],
});

export const windFrame = struct(40, {
  index: [0, 'long'],
  rms: [8, 'float'],
  rmsClean: [12, 'float'],
  level: [16, 'float'],
  speed: [20, 'float'],
  wind: [24, 'float'],
  confidence: [28, 'float'],
  background: [32, 'float'],
  clipped: [36, 'float'],
});

export const windCalibration = struct(20, { backgroundRms: [4, 'float'], backgroundLevel: [8, 'float'], floorDb: [12, 'float'], gustRms: [16, 'float'] });
