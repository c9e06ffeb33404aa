// One live candle: position, motion, wind, flame, ember and smoke.

import { FlameShape } from './flame_shape.js';
import { Stroke } from '../air/stroke.js';
import type { Stand } from './room.js';

/** Wind at the flame while its base moves at one flame height a second. */
const MOTION_WIND = 0.3;
/** Maximum wind of dragging, reached at 3.8 flame heights a second. */
const MAX_MOTION_WIND = 1.15;

/** Seconds for which an extinguished wick smokes. */
const SMOKES = 4.2;

/** Smoking of a wick, 0 to 1, as a function of the seconds since extinction. */
export function smokeAfter(sinceOut: number): number {
  if (!(sinceOut < SMOKES)) return 0;
  return Math.min(1, 0.3 + sinceOut / 0.3) * (1 - sinceOut / SMOKES) ** 1.2;
}

export class Candle {
  readonly shape = new FlameShape();
  /** strength of smoking, 0 to 1 */
  smoking = 0;
  /** visible share of the flame, 0 to 1 */
  size = 1;
  /** brightness of the wick's glowing end, 0 to 1 */
  ember = 0;
  /** seconds since extinction; Infinity while it burns */
  sinceOut = Infinity;
  /** wind of the pointer's strokes around the flame */
  readonly stroke = new Stroke();
  /** signed wind of the last frame from all sources */
  wind = 0;
  /** remaining seconds after lighting in which the pointer's strokes have no effect */
  sheltered = 0;
  /** instance in the lender's bank; null: its own model responds to wind */
  lent: bigint | null = null;
  /** lean of the flame's tip away from the eye, and of its middle towards the eye, flame units */
  tipAway = 0;
  nearer = 0;
  private speed = 0;
  private lastX: number;
  /** position relative to the table's middle, seen from where the flame was filmed */
  readonly seat: readonly [x: number, z: number];

  constructor(readonly stand: Stand, readonly id: bigint) {
    this.lastX = stand.x;
    this.seat = [stand.x, stand.z];
  }

  /** Sets the position after the eye moved, without wind from motion. */
  put(x: number, z: number): void {
    this.lastX += x - this.stand.x;
    this.stand.x = x;
    this.stand.z = z;
  }

  get lit(): boolean {
    return this.sinceOut === Infinity;
  }

  /** Wind at the flame from the candle's own motion. Call once a frame. */
  motionWind(seconds: number): number {
    if (seconds <= 0) return 0;
    const speed = (this.stand.x - this.lastX) / seconds / this.stand.unit;
    this.lastX = this.stand.x;
    this.speed += (speed - this.speed) * Math.min(1, seconds / 0.07);
    return Math.max(-MAX_MOTION_WIND, Math.min(MAX_MOTION_WIND, -MOTION_WIND * this.speed));
  }

  /** Takes the flame's current appearance. `sinceOut`: seconds, Infinity while it burns. */
  show(outline: Float32Array, size: number, sinceOut: number): void {
    this.size = size;
    this.sinceOut = sinceOut;
    this.shape.update(outline, size);
    const glow = 0.7 * Math.exp(-sinceOut / 0.9) + 0.3 * Math.exp(-sinceOut / 3);
    this.ember = this.lit ? 0.16 : glow;
    this.smoking = smokeAfter(sinceOut);
  }
}
