// @wisp/player: plays Wisp models live. See docs/reference/npm.md.

import { Model } from './model.js';
import { Native, type LoadOptions } from './native.js';
import { WindLevel, type WindOptions } from './wind.js';

export {
  Bank,
  noInstance,
  type BankOptions,
  type Body,
  type ChainPlace,
  type ChainSettings,
  type FlameState,
  type Instance,
} from './bank.js';
export {
  Model,
  type ArxFacts,
  type BlowOut,
  type ChainFacts,
  type Channel,
  type Dynamics,
  type ModelFacts,
  type Provenance,
  type View,
} from './model.js';
export { hasSimd, Status, WispError, type LoadOptions } from './native.js';
export { WindLevel, type WindAsk, type WindCalibration, type WindFrame, type WindOptions } from './wind.js';

/** A running copy of the library, with memory of its own. */
export class Wisp {
  /** As 1.2.3. */
  readonly version: string;

  /** @internal */
  constructor(private readonly native: Native) {
    const version = native.functions.wisp_version!();
    this.version = [Math.floor(version / 1e6), Math.floor(version / 1e3) % 1000, version % 1000].join('.');
  }

  /** Whether it computes with SIMD; the bits are the same either way. */
  get simd(): boolean {
    return this.native.simd;
  }

  /** The compiled module: hand it to a worker or a worklet, where `load({wasm: module})` starts at once. */
  get module(): WebAssembly.Module {
    return this.native.module;
  }

  /** Bytes of memory that it has by now; it grows and never shrinks. */
  get memoryBytes(): number {
    return this.native.bytes.length;
  }

  /** Reads a model from the bytes of a `.wisp` file. Throws a WispError that says what is wrong with them. */
  model(bytes: ArrayBuffer | Uint8Array): Model {
    return new Model(this.native, bytes instanceof Uint8Array ? bytes : new Uint8Array(bytes));
  }

  /** Makes an estimator of wind at the start of a stream of sound. Throws when an option is out of its range. */
  windLevel(options: WindOptions): WindLevel {
    return new WindLevel(this.native, options);
  }
}

/** Fetches, compiles and starts the library. */
export async function load(options: LoadOptions = {}): Promise<Wisp> {
  return new Wisp(await Native.load(options));
}
