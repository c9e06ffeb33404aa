// Wind that a moving pointer stirs up around a flame: strong when it passes near and fast, gone in a moment.

import type { Acting, Air } from '../stage/scene.js';

/** Pointer speed, in flame heights a second, that makes wind 1 where it passes through the flame. */
const SPEED_OF_ONE = 7;
/** Seconds in which what was stirred up settles: a pass of a single frame blows for as long as a slower one. */
const SETTLES = 0.22;
/** Seconds in which the flame feels a gust: air has mass, and a flame that jumps looks wrong. */
const ARRIVES = 0.05;
/** Strongest gust of a stroke. */
const STRONGEST = 3.2;
const STILL: Readonly<Air> = { right: 0, away: 0 };

const strength = ({ right, away }: Readonly<Air>): number => Math.hypot(right, away);

/** What strokes stir up around one flame. The same strokes blow alike at any frame rate, to the length of one frame. */
export class Stroke {
  /** the wind that the flame feels */
  readonly wind: Air = { right: 0, away: 0 };
  /** the gust that the last stroke made, as far as it has not settled */
  private gust: Readonly<Air> = STILL;

  /** Stillness around the flame. */
  settle(): void {
    this.gust = STILL;
    Object.assign(this.wind, STILL);
  }

  /**
   * One frame. `busy`: the pointer carries something and stirs nothing. The flame's middle and the pixels of one flame
   * height are of the picture.
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

/** How the pointer's way since the last frame blows on a flame: what goes up the picture goes away over the table. */
function blow({ pointer }: Acting, flameX: number, flameY: number, height: number): Air {
  const near = Math.exp((-0.5 * nearest2(pointer, flameX, flameY)) / (height * height));
  const [right, away] = [pointer.speedX, 0.4 * pointer.speedY];
  const fast = Math.max(1e-9, Math.hypot(right, away));
  const wind = (Math.min(STRONGEST, Math.pow(fast / height / SPEED_OF_ONE, 1.1)) * near) / fast;
  return { right: wind * right, away: wind * away };
}

/** How near the pointer came to a place since the last frame, squared: it may have jumped past. */
function nearest2(pointer: Acting['pointer'], x: number, y: number): number {
  const wayX = pointer.x - pointer.fromX;
  const wayY = pointer.y - pointer.fromY;
  const length2 = wayX * wayX + wayY * wayY;
  const along = length2 > 0 ? ((x - pointer.fromX) * wayX + (y - pointer.fromY) * wayY) / length2 : 0;
  const share = Math.max(0, Math.min(1, along));
  return (pointer.fromX + share * wayX - x) ** 2 + (pointer.fromY + share * wayY - y) ** 2;
}
