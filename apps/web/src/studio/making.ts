// Files for other tools, of a learned model. What makes them is fetched the first time.

import type { Exported, Studio } from '@wisp/studio';
import { nameInC, type Format } from './panels/taking.js';
import type { Thing } from './words.js';

/** Seconds of a loop, and how many at once. */
const LOOPED: Readonly<Record<Thing, { loop: number; instances: number }>> = {
  flame: { loop: 4, instances: 1 },
  fall: { loop: 6, instances: 20 },
  table: { loop: 4, instances: 1 },
};

/** `name`: of the files, without what they end in. */
export async function madeFiles(studio: Studio, format: Format, model: Uint8Array, name: string, thing: Thing): Promise<Exported[]> {
  if (format === 'c') return studio.export(model, { format, name: nameInC(name) });
  return studio.export(model, { format, name, ...LOOPED[thing] });
}
