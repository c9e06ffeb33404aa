// The match: it lies ready, burns while carried, lights wicks that its flame touches, and returns.

import { FlameShape } from './flame_shape.js';
import { smokeAfter } from './candle.js';

const ERRAND = 0.75; // seconds for moving to a wick when no pointer carries the match; 0.5 s later it returns
const STRIKE = 0.22; // seconds of the strike, before the match moves
const STRUCK = 0.34; // distance of the strike, room units
const FLARES = 0.32; // decay time of the flare, seconds

export class Match {
  readonly shape = new FlameShape();
  /** strength of its head's flare, and of smoking, 0 to 1 */
  flare = 0;
  smoking = 0;
  /** middle of its head in the room */
  x = 0;
  y = 0;
  z = 1.4;
  readonly unit = 0.5;
  size = 0;
  burning = false;
  /** instance of the flame model while the match burns */
  id: bigint | null = null;
  held = false;
  homeX = 0;
  homeY = 0.52;
  sinceOut = Infinity;
  private goalX = 0;
  private goalY = 0;
  private errand = 0; // remaining seconds of moving to a wick by itself and waiting there; 0: it does not
  /** remaining seconds of the strike; at 0 the match catches fire */
  private striking = 0;
  speedX = 0;

  /** Whether the match lies on the table. */
  get lying(): boolean {
    return !this.held && this.errand === 0 && !this.burning;
  }

  /** Sets the resting place's x and depth, in front of the candles. */
  rest(x: number, z: number): void {
    this.homeX = x;
    this.homeY = z > 2 ? 0.3 : 0.52;
    this.z = z;
    if (!this.held && this.errand === 0) {
      this.x = this.goalX = x;
      this.y = this.goalY = this.homeY;
    }
  }

  /** Whether a press at these room coordinates, in the match's depth, picks up the match. */
  near(x: number, y: number): boolean {
    const along = (x - this.x) / 0.3;
    return Math.abs(x - this.x - 0.12) < 0.42 && y - this.y < 0.3 && y - this.y > -0.75 && along > -1.4;
  }

  take(): void {
    this.held = true;
    this.errand = 0;
    this.strike();
  }

  private strike(): void {
    if (!this.burning && this.striking === 0) this.striking = STRIKE;
  }

  /** Moves the match to a wick by itself, not carried by the pointer. */
  send(x: number, y: number): void {
    this.errand = ERRAND + 0.5;
    this.strike();
    this.moveTo(x, y);
  }

  moveTo(x: number, y: number): void {
    this.goalX = x;
    this.goalY = y;
  }

  drop(): void {
    this.held = false;
    this.errand = 0;
    this.moveTo(this.homeX, this.homeY);
  }

  /** Whether the match should burn: struck, and held or on its way to a wick. */
  get wanted(): boolean {
    return (this.held || this.errand > 0) && this.striking === 0;
  }

  update(seconds: number): void {
    if (seconds <= 0) return;
    this.flare *= Math.exp(-seconds / FLARES);
    if (this.flare < 0.01) this.flare = 0;
    this.smoking = Math.max(0.5 * this.flare, this.burning ? 0 : 0.7 * smokeAfter(this.sinceOut + 1.6));
    if (this.striking > 0) {
      // The strike moves the match along the table; then it moves to its goal.
      this.striking = Math.max(0, this.striking - seconds);
      this.x -= (STRUCK * seconds) / STRIKE;
      this.speedX = 0;
      return;
    }
    const quick = this.held ? 22 : this.errand > 0 ? 6 : 4;
    const share = 1 - Math.exp(-quick * seconds);
    const before = this.x;
    this.x += (this.goalX - this.x) * share;
    this.y += (this.goalY - this.y) * share;
    this.speedX = (this.x - before) / seconds / this.unit;
    if (this.errand > 0 && (this.errand -= seconds) <= 0) this.drop();
  }
}
