// @wisp/player: plays Wisp models live. See docs/reference/npm.md.

import { Library } from './library.js';
import { Native, type LoadOptions } from './native.js';
import { WindLevel, type WindOptions } from './wind.js';

export * from './bank.js';
export * from './model.js';
export { Library } from './library.js';
export { hasSimd, Status, WispError, type LoadOptions } from './native.js';
export { WindLevel, type WindAsk, type WindCalibration, type WindFrame, type WindOptions } from './wind.js';

/** A running instance of the library, with its own memory. */
export class Wisp extends Library {
  /** Creates a wind estimator at the start of a sound stream. Throws when an option is out of range. */
  windLevel(options: WindOptions): WindLevel {
    return new WindLevel(this.native, options);
  }
}

/** Fetches, compiles and starts the library. */
export async function load(options: LoadOptions = {}): Promise<Wisp> {
  return new Wisp(await Native.load(options));
}
