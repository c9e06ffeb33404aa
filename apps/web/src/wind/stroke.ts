// Wind that a moving pointer stirs up around a flame: strong when it passes near and fast, gone in a moment.

import type { Acting } from '../stage/scene.js';

/** Pointer speed, in flame heights a second, that makes wind 1 where it passes through the flame. */
const SPEED_OF_ONE = 9;
/** Seconds in which what was stirred up settles. */
const SETTLES = 0.16;
/** Strongest wind of a stroke. */
const STRONGEST = 2.6;

export class Stroke {
  /**
   * The stirred wind after one frame, given that before. `busy`: the pointer carries something and stirs nothing.
   * The flame's middle and the pixels of one flame height are of the picture.
   */
  stir(before: number, acting: Acting, busy: boolean, flameX: number, flameY: number, height: number): number {
    const { pointer, seconds } = acting;
    const settled = before * Math.exp(-seconds / SETTLES);
    if (!pointer.present || busy || seconds <= 0) return settled;
    const near = Math.exp(-0.5 * this.nearest2(acting, flameX, flameY) / (height * height));
    const speed = Math.hypot(pointer.speedX, 0.4 * pointer.speedY) / height / SPEED_OF_ONE;
    const side = pointer.speedX === 0 ? Math.sign(flameX - pointer.x) : Math.sign(pointer.speedX);
    const blown = Math.min(STRONGEST, Math.pow(speed, 1.1)) * near * side;
    const share = 1 - Math.exp(-seconds / 0.05);
    return Math.abs(blown) > Math.abs(settled) ? settled + (blown - settled) * share : settled;
  }

  /** How near the pointer came to a place since the last frame, squared: it may have jumped past. */
  private nearest2({ pointer }: Acting, x: number, y: number): number {
    const wayX = pointer.x - pointer.fromX;
    const wayY = pointer.y - pointer.fromY;
    const length2 = wayX * wayX + wayY * wayY;
    const along = length2 > 0 ? ((x - pointer.fromX) * wayX + (y - pointer.fromY) * wayY) / length2 : 0;
    const share = Math.max(0, Math.min(1, along));
    return (pointer.fromX + share * wayX - x) ** 2 + (pointer.fromY + share * wayY - y) ** 2;
  }
}
