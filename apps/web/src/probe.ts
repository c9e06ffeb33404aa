// Figures for external measurements (docs/studies/live.md): tests, benchmarks, the console.

import type { SoundPath } from '@wisp/player/parts/air/breath';
import type { FrameCost } from '@wisp/player/parts/stage/stage';

/** Number of frames whose costs are kept. */
const KEPT = 600;

export class Probe {
  /** number of frames drawn */
  frames = 0;
  /** milliseconds from the start of the page to the first picture of a scene */
  firstPicture = 0;
  /** wind of the last frame, in the model's unit */
  wind = 0;
  answer = 0;
  /** number of burning candles, and of all; null in other scenes */
  burning: { lit: number; of: number } | null = null;
  smoking = false;
  /** number of all leaves, and of those on the ground; null in other scenes */
  leaves: { count: number; lying: number } | null = null;
  /** x of the first candle, room units from the middle */
  candleX = 0;
  /** azimuth of the eye round the candle, radians; 0 where its flame was filmed */
  azimuth = 0;
  private readonly kept: FrameCost[] = [];

  /** `places`: returns positions of wick and match, CSS pixels from the top left; null in scenes without a candle. */
  constructor(
    readonly sound: SoundPath,
    readonly places: () => { wick: [number, number]; match: [number, number] } | null,
    private readonly heard: () => string,
  ) {}

  /** State of the microphone. */
  get hearing(): string {
    return this.heard();
  }

  /** Milliseconds of this page's own work in the last frames, newest last. */
  costs(): readonly FrameCost[] {
    return this.kept;
  }

  push(cost: Readonly<FrameCost>): void {
    this.kept.push(cost);
    if (this.kept.length > KEPT) this.kept.shift();
  }
}

declare global {
  interface Window { wisp?: Probe }
}
