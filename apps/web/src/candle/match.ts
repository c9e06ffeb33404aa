// The match: it lies in wait, burns while it is carried, lights wicks that its flame touches, and goes back.

import { FlameShape } from './flame_shape.js';
import type { DrawnMatch } from './renderer.js';
import { Smoke } from './smoke.js';

/** Seconds that a match takes on its own to a wick. */
const ERRAND = 0.75;

export class Match implements DrawnMatch {
  readonly shape = new FlameShape();
  readonly smoke = new Smoke(11);
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
  speedX = 0;

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
  }

  /** Carries itself to a wick. */
  send(x: number, y: number): void {
    this.errand = { left: ERRAND + 0.5 };
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

  get wanted(): boolean {
    return this.held || this.errand !== null;
  }

  /** Moves it on. */
  update(seconds: number): void {
    if (seconds <= 0) return;
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
