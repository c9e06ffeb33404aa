// Breath that crosses a table from the side it blows from: delayed and weakened with distance, and blocked by candles in its way.

/** Speed of breath, room units a second. */
const SPEED = 7;
/** Distance from the table's middle at which breath enters, room units; its path is twice as long. */
const EDGE = 2;
/** Share of the wind lost over the whole path across the table. */
const LOST = 0.3;
/** The wind decays by exp(−NARROW z²) with the distance z from its axis, room units. */
const NARROW = 0.1;

const KEPT = 256;

/** Wake of a candle: share of the wind blocked directly behind it, half width, and length. */
const WAKE = { share: 0.45, wide: 0.16, long: 1.1 };
/** Minimum share of the wind behind any number of candles. */
const SHELTERED = 0.5;

type Place = Readonly<Record<'x' | 'z', number>>;

/** Returns the share of a wind with unit direction (x, z) that passes the other candles and reaches a place. */
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

  push(seconds: number, wind: number): void {
    this.clock += seconds;
    this.newest = (this.newest + 1) % KEPT;
    this.winds[this.newest] = wind;
    this.times[this.newest] = this.clock;
  }

  /** Returns the wind at a place: x from the table's middle in the direction of a positive wind, z across. */
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
