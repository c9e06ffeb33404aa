// One candle that lives: where it stands, how it moves, the wind that it feels, its flame, its ember and smoke.

import type { DrawnCandle } from './renderer.js';
import { FlameShape } from './flame_shape.js';
import { Stroke } from '../wind/stroke.js';
import { WICK_GAP, type Stand } from './room.js';
import { Smoke } from './smoke.js';

/** Wind that a base moving at one flame height a second puts the flame into. */
const MOTION_WIND = 0.3;
/** Strongest wind that dragging makes: it bends the flame, and takes a jerk to put it out. */
const MOST_MOTION_WIND = 1.15;

export class Candle implements DrawnCandle {
  readonly shape = new FlameShape();
  readonly smoke: Smoke;
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
  private speed = 0;
  private lastX: number;

  constructor(
    readonly stand: Stand,
    readonly id: bigint,
  ) {
    this.smoke = new Smoke(stand.seed);
    this.lastX = stand.x;
  }

  get lit(): boolean {
    return this.sinceOut === Infinity;
  }

  /** Height of the flame's base in the room. */
  get foot(): number {
    return this.stand.ground + this.stand.height + WICK_GAP * this.stand.unit;
  }

  /** Wind in the flame's frame because the candle moves. Call once a frame. */
  motionWind(seconds: number): number {
    if (seconds <= 0) return 0;
    const speed = (this.stand.x - this.lastX) / seconds / this.stand.unit;
    this.lastX = this.stand.x;
    this.speed += (speed - this.speed) * Math.min(1, seconds / 0.07);
    return Math.max(-MOST_MOTION_WIND, Math.min(MOST_MOTION_WIND, -MOTION_WIND * this.speed));
  }

  /** Takes over how the flame looks now. `sinceOut`: seconds, Infinity while it burns. */
  show(outline: Float32Array, size: number, sinceOut: number, seconds: number): void {
    this.size = size;
    this.sinceOut = sinceOut;
    this.shape.update(outline, size);
    const glow = 0.7 * Math.exp(-sinceOut / 0.9) + 0.3 * Math.exp(-sinceOut / 3);
    this.ember = this.lit ? 0.12 : glow;
    const { stand } = this;
    const tipX = stand.x + 0.03 * stand.unit;
    const tipY = stand.ground + stand.height + 0.19 * stand.unit;
    this.smoke.update(seconds, sinceOut, tipX, tipY, stand.unit, 0.55 * this.wind * stand.unit);
  }
}
