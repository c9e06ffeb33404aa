// The library without its ears: what a page needs for its first flame.

import { Model } from './model.js';
import { Native, type LoadOptions } from './native.js';

/** A running copy of the library, with memory of its own. */
export class Library {
  /** As 1.2.3. */
  readonly version: string;

  /** @internal */
  constructor(protected readonly native: Native) {
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
}

/** Fetches, compiles and starts it. */
export async function loadLibrary(options: LoadOptions = {}): Promise<Library> {
  return new Library(await Native.load(options));
}
