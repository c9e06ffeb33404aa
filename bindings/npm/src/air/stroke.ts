// Wind stirred up around a flame by a moving pointer: strong where it passes near and fast, and quickly gone.

import type { Acting, Air } from '../stage/scene.js';

/** Pointer speed through the flame that makes a wind of 1, flame heights a second. */
const SPEED_OF_ONE = 7;
/** Decay time of stirred air, seconds: a pass of a single frame blows for as long as a slower one. */
const SETTLES = 0.22;
/** Rise time of a gust at the flame, seconds: air has inertia, and a jump would look wrong. */
const ARRIVES = 0.05;
/** Maximum wind of a stroke. */
const STRONGEST = 3.2;
const STILL: Readonly<Air> = { right: 0, away: 0 };

const strength = ({ right, away }: Readonly<Air>): number => Math.hypot(right, away);

/** Wind of strokes around one flame. Depends on the frame rate only by a delay of up to one frame. */
export class Stroke {
  /** wind at the flame */
  readonly wind: Air = { right: 0, away: 0 };
  /** gust of the last stroke, decayed so far */
  private gust: Readonly<Air> = STILL;

  settle(): void {
    this.gust = STILL;
    Object.assign(this.wind, STILL);
  }

  /**
   * Updates one frame. `busy`: the pointer carries something and stirs no air. The flame's middle and height are in
   * pixels of the picture.
   */
  update(acting: Acting, busy: boolean, flameX: number, flameY: number, height: number): void {
    const { seconds } = acting;
    if (seconds <= 0) return;
    const settles = Math.exp(-seconds / SETTLES);
    this.gust = { right: settles * this.gust.right, away: settles * this.gust.away };
    const blown = busy || !acting.pointer.present ? STILL : blow(acting, flameX, flameY, height);
    if (strength(blown) > strength(this.gust)) this.gust = blown;
    const arrives = 1 - Math.exp(-seconds / ARRIVES);
    this.wind.right += (this.gust.right - this.wind.right) * arrives;
    this.wind.away += (this.gust.away - this.wind.away) * arrives;
  }
}

/** Wind on a flame from the pointer's path since the last frame. Upward motion blows away from the eye. */
function blow({ pointer }: Acting, flameX: number, flameY: number, height: number): Air {
  const near = Math.exp((-0.5 * nearest2(pointer, flameX, flameY)) / (height * height));
  const [right, away] = [pointer.speedX, 0.4 * pointer.speedY];
  const fast = Math.max(1e-9, Math.hypot(right, away));
  const wind = (Math.min(STRONGEST, Math.pow(fast / height / SPEED_OF_ONE, 1.1)) * near) / fast;
  return { right: wind * right, away: wind * away };
}

/** Squared minimum distance of the pointer's path since the last frame from a place. */
function nearest2(pointer: Acting['pointer'], x: number, y: number): number {
  const wayX = pointer.x - pointer.fromX;
  const wayY = pointer.y - pointer.fromY;
  const length2 = wayX * wayX + wayY * wayY;
  const along = length2 > 0 ? ((x - pointer.fromX) * wayX + (y - pointer.fromY) * wayY) / length2 : 0;
  const share = Math.max(0, Math.min(1, along));
  return (pointer.fromX + share * wayX - x) ** 2 + (pointer.fromY + share * wayY - y) ** 2;
}
