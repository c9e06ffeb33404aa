// The match: it lies in wait, burns while it is carried, lights wicks that its flame touches, and goes back.

import { FlameShape } from './flame_shape.js';
import type { DrawnMatch } from './renderer.js';
import { smokeAfter } from './candle.js';

/** Seconds that a match takes on its own to a wick, and to be struck before that: how far, and how long it flares. */
const ERRAND = 0.75;
const STRIKE = 0.22;
const STRUCK = 0.34;
const FLARES = 0.32;

export class Match implements DrawnMatch {
  readonly shape = new FlameShape();
  flare = 0;
  smoking = 0;
  z = 1.4;
  readonly unit = 0.5;
  x = 0;
  y = 0;
  size = 0;
  burning = false;
  /** an instance of the model while it burns */
  id: bigint | null = null;
  held = false;
  homeX = 0;
  homeY = 0.52;
  sinceOut = Infinity;
  private goalX = 0;
  private goalY = 0;
  private errand: { left: number } | null = null;
  /** seconds of the stroke that lights it that are still to come; it burns at 0 */
  private striking = 0;
  speedX = 0;

  get lying(): boolean {
    return !this.held && this.errand === null && !this.burning;
  }

  /** Where it lies while nobody needs it: in front of what stands there. */
  rest(x: number, z: number): void {
    this.homeX = x;
    this.homeY = z > 2 ? 0.3 : 0.52;
    this.z = z;
    if (!this.held && this.errand === null) {
      this.x = this.goalX = x;
      this.y = this.goalY = this.homeY;
    }
  }

  /** Whether a press there takes it up: room coordinates at its depth. */
  near(x: number, y: number): boolean {
    const along = (x - this.x) / 0.3;
    return Math.abs(x - this.x - 0.12) < 0.42 && y - this.y < 0.3 && y - this.y > -0.75 && along > -1.4;
  }

  take(): void {
    this.held = true;
    this.errand = null;
    this.strike();
  }

  private strike(): void {
    if (!this.burning && this.striking === 0) this.striking = STRIKE;
  }

  /** Carries itself to a wick. */
  send(x: number, y: number): void {
    this.errand = { left: ERRAND + 0.5 };
    this.strike();
    this.goalX = x;
    this.goalY = y;
  }

  moveTo(x: number, y: number): void {
    this.goalX = x;
    this.goalY = y;
  }

  drop(): void {
    this.held = false;
    this.errand = null;
    this.goalX = this.homeX;
    this.goalY = this.homeY;
  }

  /** Whether it is to burn: it is held or on its way, and has been struck. */
  get wanted(): boolean {
    return (this.held || this.errand !== null) && this.striking === 0;
  }

  /** Its head catches. */
  catchFire(): void {
    this.flare = 1;
  }

  /** Moves it on. */
  update(seconds: number): void {
    if (seconds <= 0) return;
    this.flare *= Math.exp(-seconds / FLARES);
    if (this.flare < 0.01) this.flare = 0;
    this.smoking = Math.max(0.5 * this.flare, this.burning ? 0 : 0.7 * smokeAfter(this.sinceOut + 1.6));
    if (this.striking > 0) {
      // Along the table, quickly, and only then where it is wanted.
      this.striking = Math.max(0, this.striking - seconds);
      this.x -= (STRUCK * seconds) / STRIKE;
      this.speedX = 0;
      return;
    }
    const quick = this.held ? 22 : this.errand !== null ? 6 : 4;
    const share = 1 - Math.exp(-quick * seconds);
    const before = this.x;
    this.x += (this.goalX - this.x) * share;
    this.y += (this.goalY - this.y) * share;
    this.speedX = (this.x - before) / seconds / this.unit;
    if (this.errand === null) return;
    this.errand.left -= seconds;
    if (this.errand.left <= 0) this.drop();
  }
}
