// Tilt and touch, opt-in: a phone that makes wind where it is tilted, goes round where it is turned, and vibrates when a flame goes out.

import type { Air } from '@wisp/player/parts/stage/scene';
import { Tilt } from './tilt.js';

/** Milliseconds that a phone vibrates when a flame goes out. */
const VIBRATES = 40;

export class Senses {
  on = false;
  private readonly tilt = new Tilt();
  private burning = 0;

  /** Wind that tilting makes. */
  get air(): Air {
    return this.tilt.air;
  }

  /** Radians to go round the candle by, as the phone was turned. Who prefers less motion stays where they are. */
  turned(): number {
    return document.body.classList.contains('calm') ? 0 : this.tilt.turned();
  }

  /** On or off. To be called from a press or a key: browsers may ask only there. */
  toggle(): void {
    this.on = !this.on;
    if (!this.on) this.tilt.close();
    // Refused: it vibrates without tilt.
    else this.tilt.open().catch(() => undefined);
  }

  /** Takes in a frame. */
  frame(lit: number): void {
    if (lit < this.burning && this.on) navigator.vibrate?.(VIBRATES);
    this.burning = lit;
  }
}
