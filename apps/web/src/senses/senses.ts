// Tilt and touch, opt-in: tilting a phone makes wind, rotating it moves the eye, and it vibrates when a flame goes out.

import type { Air } from '@wisp/player/parts/stage/scene';
import { Tilt } from './tilt.js';

/** Milliseconds of vibration when a flame goes out. */
const VIBRATES = 40;

export class Senses {
  on = false;
  private readonly tilt = new Tilt();
  private burning = 0;

  /** Wind from tilt. */
  get air(): Air {
    return this.tilt.air;
  }

  /** Radians to go round the candle, by the phone's rotation. 0 for users who prefer reduced motion. */
  turned(): number {
    return document.body.classList.contains('calm') ? 0 : this.tilt.turned();
  }

  /** Toggles. Call it in a press or key handler, as browsers allow the request only there. */
  toggle(): void {
    this.on = !this.on;
    if (!this.on) this.tilt.close();
    // If refused, it vibrates without tilt.
    else this.tilt.open().catch(() => undefined);
  }

  /** Updates one frame. */
  frame(lit: number): void {
    if (lit < this.burning && this.on) navigator.vibrate?.(VIBRATES);
    this.burning = lit;
  }
}
