// Breath that crosses a table: it comes from the side that it blows from, later and weaker the farther it has to go, and what
// stands in its way shelters what is behind.

/** Room units a second. */
const SPEED = 7;
/** Half of the way across the table, where the breath begins. */
const EDGE = 2;
/** Share that is lost on the way to the far side. */
const LOST = 0.3;
/** Off the line of the breath it is weaker: this much a unit, squared. */
const NARROW = 0.1;

const KEPT = 256;

/** Share of a wind that a candle right in front takes, half of the width of its wake, and how far that reaches. */
const WAKE = { share: 0.45, wide: 0.16, long: 1.1 };
/** Least share of the wind that is left behind any number of them. */
const SHELTERED = 0.5;

interface Place {
  x: number;
  z: number;
}

/** The share of a wind in direction (x, z), of length 1, that the others leave of it at a place. */
export function shelter(at: Place, others: readonly Place[], x: number, z: number): number {
  let left = 1;
  for (const other of others) {
    const along = (at.x - other.x) * x + (at.z - other.z) * z;
    const off = ((at.x - other.x) * z - (at.z - other.z) * x) / WAKE.wide;
    if (along > 0.02 && along < 3 * WAKE.long && Math.abs(off) < 3) left *= 1 - WAKE.share * Math.exp(-off * off - along / WAKE.long);
  }
  return Math.max(SHELTERED, left);
}

export class WindDelay {
  private readonly winds = new Float32Array(KEPT);
  private readonly times = new Float64Array(KEPT).fill(-1e9);
  private newest = 0;
  private clock = 0;

  /** The breath of this frame. */
  push(seconds: number, wind: number): void {
    this.clock += seconds;
    this.newest = (this.newest + 1) % KEPT;
    this.winds[this.newest] = wind;
    this.times[this.newest] = this.clock;
  }

  /** Wind at a place that lies so far along the way of a positive wind from the middle of the table, and so far off it. */
  at(x: number, z: number): number {
    return this.from(1, x, z) + this.from(-1, x, z);
  }

  private from(side: 1 | -1, x: number, z: number): number {
    const way = Math.max(0, EDGE + side * x);
    const when = this.clock - way / SPEED;
    for (let back = 0; back < KEPT; ++back) {
      const k = (this.newest - back + KEPT) % KEPT;
      if ((this.times[k] as number) > when) continue;
      const wind = this.winds[k] as number;
      if (wind * side <= 0) return 0;
      return wind * (1 - (LOST * way) / (2 * EDGE)) * Math.exp(-NARROW * z * z);
    }
    return 0;
  }
}
