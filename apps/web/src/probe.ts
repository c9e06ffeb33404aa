// Figures for external measurements (docs/studies/live.md): tests, benchmarks, the console.

import type { SoundPath } from '@wisp/player/parts/air/breath';
import type { FrameCost } from '@wisp/player/parts/stage/stage';

const KEPT = 600;

export interface Probe {
  /** number of frames drawn */
  frames: number;
  /** milliseconds of this page's own work in the last frames, newest last */
  costs(): { update: number; draw: number }[];
  /** milliseconds from the start of the page to the first picture of a scene */
  firstPicture: number;
  /** wind of the last frame, in the model's unit */
  wind: number;
  answer: number;
  /** number of burning candles, and of all; null in other scenes */
  burning: { lit: number; of: number } | null;
  /** whether smoke is in the air */
  smoking: boolean;
  /** positions of wick and match, CSS pixels from the top left; null in other scenes */
  places(): { wick: [number, number]; match: [number, number] } | null;
  /** number of leaves in the air and on the ground; null in other scenes */
  leaves: { count: number; lying: number } | null;
  /** x of the first candle, room units from the middle */
  candleX: number;
  /** azimuth of the eye round the candle, radians; 0 where its flame was filmed */
  azimuth: number;
  hearing: string;
  sound: SoundPath;
}

declare global {
  interface Window {
    wisp?: Probe;
  }
}

export class Costs {
  private readonly update = new Float32Array(KEPT);
  private readonly draw = new Float32Array(KEPT);
  private count = 0;

  push(cost: Readonly<FrameCost>): void {
    this.update[this.count % KEPT] = cost.update;
    this.draw[this.count % KEPT] = cost.draw;
    this.count += 1;
  }

  list(): { update: number; draw: number }[] {
    const length = Math.min(KEPT, this.count);
    return Array.from({ length }, (_, k) => {
      const at = (this.count - length + k) % KEPT;
      return { update: this.update[at] as number, draw: this.draw[at] as number };
    });
  }
}
