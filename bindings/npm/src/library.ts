// The library without the wind estimator: the part that a page needs for its first flame.

import { Model } from './model.js';
import { Native, type LoadOptions } from './native.js';

/** A running instance of the library, with its own memory. */
export class Library {
  /** Version such as 1.2.3. */
  readonly version: string;

  /** @internal */
  constructor(protected readonly native: Native) {
    const version = native.functions.wisp_version!();
    this.version = [Math.floor(version / 1e6), Math.floor(version / 1e3) % 1000, version % 1000].join('.');
  }

  /** Whether the library computes with SIMD; results are the same bits either way. */
  get simd(): boolean {
    return this.native.simd;
  }

  /** The compiled module: pass it to a worker or worklet, where `load({wasm: module})` starts immediately. */
  get module(): WebAssembly.Module {
    return this.native.module;
  }

  /** Current size of the library's memory in bytes; it grows and never shrinks. */
  get memoryBytes(): number {
    return this.native.bytes.length;
  }

  /** Reads a model from the bytes of a `.wisp` file. Throws a WispError that says what is wrong with them. */
  model(bytes: ArrayBuffer | Uint8Array): Model {
    return new Model(this.native, bytes instanceof Uint8Array ? bytes : new Uint8Array(bytes));
  }
}

/** Returns a function that does the work at its first call, and again at a call after a failure. */
export function once<T>(work: () => Promise<T>): () => Promise<T> {
  let coming: Promise<T> | null = null;
  return () =>
    (coming ??= work().catch((error: unknown) => {
      coming = null;
      throw error;
    }));
}

/** Fetches, compiles and starts the library. */
export async function loadLibrary(options: LoadOptions = {}): Promise<Library> {
  return new Library(await Native.load(options));
}
