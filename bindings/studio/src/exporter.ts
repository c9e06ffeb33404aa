// The module that converts models to files for other tools.

import { compiled, Module } from './module.js';
import type { Exported, ExportSettings } from './types.js';

const FORMATS = { glb: 0, json: 1, c: 2 } as const;

/** Defaults, equal to those of `wisp export`. */
const DEFAULTS = { seconds: 4, instances: 1, wind: 0, seed: 1, height: 512 } as const;

export class Exporter extends Module {
  static async start(module: WebAssembly.Module | BufferSource): Promise<Exporter> {
    return new Exporter(await compiled(module));
  }

  /** Returns the files that `wisp export` writes, byte for byte. Throws a StudioError if there are none. */
  files(model: Uint8Array, settings: ExportSettings): Exported[] {
    const { format, name, loop } = settings;
    const { seconds, instances, wind, seed, height } = { ...DEFAULTS, ...settings };
    this.withBytes(model, (at, size) =>
      this.withText(`${name}\0`, (words) =>
        this.call('studio_export', at, size, FORMATS[format], loop ?? seconds, Number(loop !== undefined), instances, wind, seed, height, words),
      ),
    );
    const made = [{ name: `${name}.${format}`, bytes: this.answerBytes() }];
    return format === 'c' ? [...made, { name: `${name}.h`, bytes: new TextEncoder().encode(this.text()) }] : made;
  }
}
