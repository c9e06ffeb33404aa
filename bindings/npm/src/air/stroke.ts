// Wind that a moving pointer stirs up around a flame: strong when it passes near and fast, gone in a moment.

import type { Acting } from '../stage/scene.js';

/** Pointer speed, in flame heights a second, that makes wind 1 where it passes through the flame. */
const SPEED_OF_ONE = 7;
/** Seconds in which what was stirred up settles: a pass of a single frame blows for as long as a slower one. */
const SETTLES = 0.22;
/** Seconds in which the flame feels a gust: air has mass, and a flame that jumps looks wrong. */
const ARRIVES = 0.05;
/** Strongest gust of a stroke. */
const STRONGEST = 3.2;

/** What strokes stir up around one flame. The same strokes blow alike at any frame rate, to the length of one frame. */
export class Stroke {
  /** the wind that the flame feels, signed */
  wind = 0;
  /** the gust that the last stroke made, as far as it has not settled, signed */
  private gust = 0;

  /** Stillness around the flame. */
  settle(): void {
    this.gust = 0;
    this.wind = 0;
  }

  /**
   * One frame. `busy`: the pointer carries something and stirs nothing. The flame's middle and the pixels of one flame
   * height are of the picture.
   */
  update(acting: Acting, busy: boolean, flameX: number, flameY: number, height: number): void {
    const { seconds } = acting;
    if (seconds <= 0) return;
    this.gust *= Math.exp(-seconds / SETTLES);
    const blown = busy || !acting.pointer.present ? 0 : blow(acting, flameX, flameY, height);
    if (Math.abs(blown) > Math.abs(this.gust)) this.gust = blown;
    this.wind += (this.gust - this.wind) * (1 - Math.exp(-seconds / ARRIVES));
  }
}

/** How the pointer's way since the last frame blows on a flame, signed. */
function blow({ pointer }: Acting, flameX: number, flameY: number, height: number): number {
  const near = Math.exp((-0.5 * nearest2(pointer, flameX, flameY)) / (height * height));
  const speed = Math.hypot(pointer.speedX, 0.4 * pointer.speedY) / height / SPEED_OF_ONE;
  const side = pointer.speedX === 0 ? Math.sign(flameX - pointer.x) : Math.sign(pointer.speedX);
  return Math.min(STRONGEST, Math.pow(speed, 1.1)) * near * side;
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
