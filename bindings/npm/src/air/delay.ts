// Breath that crosses a table: it comes from the side that it blows from, later and weaker the farther it has to go.

/** Room units a second. */
const SPEED = 7;
/** Half of the way across the table, where the breath begins. */
const EDGE = 2;
/** Share that is lost on the way to the far side. */
const LOST = 0.3;
/** Off the line of the breath it is weaker: this much a unit, squared. */
const NARROW = 0.1;

const KEPT = 256;

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

  /** Wind at a place: x from the middle of the table, z towards the eye. */
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
