// One candle that lives: where it stands, how it moves, the wind that it feels, its flame, its ember and smoke.

import type { DrawnCandle } from './renderer.js';
import { FlameShape } from './flame_shape.js';
import { Stroke } from '../air/stroke.js';
import { flameFoot, type Stand } from './room.js';

/** Wind that a base moving at one flame height a second puts the flame into. */
const MOTION_WIND = 0.3;
/** Strongest wind that dragging makes: it bends the flame, and takes a jerk to put it out. */
const MAX_MOTION_WIND = 1.15;

/** Seconds for which a wick smokes that has gone out. */
const SMOKES = 4.2;

/** How much a wick smokes so long after it went out, 0 to 1. */
export function smokeAfter(sinceOut: number): number {
  if (!(sinceOut < SMOKES)) return 0;
  return Math.min(1, 0.3 + sinceOut / 0.3) * (1 - sinceOut / SMOKES) ** 1.2;
}

export class Candle implements DrawnCandle {
  readonly shape = new FlameShape();
  smoking = 0;
  size = 1;
  ember = 0;
  /** seconds since it went out; Infinity while it burns */
  sinceOut = Infinity;
  /** what the pointer's strokes have stirred up around it */
  readonly stroke = new Stroke();
  /** wind of the last frame, all sources together, signed */
  wind = 0;
  /** seconds for which a hand shelters it from strokes, since that hand has just lit it */
  sheltered = 0;
  /** its flame in the bank that lends the answer to wind; null: its own model has one */
  lent: bigint | null = null;
  /** how far its tip leans away from the eye, and its middle towards it, flame units */
  tipAway = 0;
  nearer = 0;
  private speed = 0;
  private lastX: number;
  /** where it stands about the table's middle, seen from where the flame was filmed */
  readonly seat: readonly [x: number, z: number];

  constructor(
    readonly stand: Stand,
    readonly id: bigint,
  ) {
    this.lastX = stand.x;
    this.seat = [stand.x, stand.z];
  }

  /** The eye moved, and not the candle. */
  put(x: number, z: number): void {
    this.lastX += x - this.stand.x;
    this.stand.x = x;
    this.stand.z = z;
  }

  get lit(): boolean {
    return this.sinceOut === Infinity;
  }

  /** Height of the flame's base in the room. */
  get foot(): number {
    return flameFoot(this.stand);
  }

  /** Wind in the flame's frame because the candle moves. Call once a frame. */
  motionWind(seconds: number): number {
    if (seconds <= 0) return 0;
    const speed = (this.stand.x - this.lastX) / seconds / this.stand.unit;
    this.lastX = this.stand.x;
    this.speed += (speed - this.speed) * Math.min(1, seconds / 0.07);
    return Math.max(-MAX_MOTION_WIND, Math.min(MAX_MOTION_WIND, -MOTION_WIND * this.speed));
  }

  /** Takes over how the flame looks now. `sinceOut`: seconds, Infinity while it burns. */
  show(outline: Float32Array, size: number, sinceOut: number): void {
    this.size = size;
    this.sinceOut = sinceOut;
    this.shape.update(outline, size);
    const glow = 0.7 * Math.exp(-sinceOut / 0.9) + 0.3 * Math.exp(-sinceOut / 3);
    this.ember = this.lit ? 0.16 : glow;
    this.smoking = smokeAfter(sinceOut);
  }
}
