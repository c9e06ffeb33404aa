// Smoke of a wick that has gone out: a thread that rises, meanders and spreads.

const MOST = 120;
const EVERY = 1 / 36;
const LASTS = 3.4;
/** A wick smokes for about so long, seconds. */
const SMOKES = 3.2;
/** Numbers a vertex: x, y, z, across, opacity, age. */
export const SMOKE_NUMBERS = 6;
/** Threads that are drawn of each: one sheet and a thinner one that strays from it. */
const THREADS = 2;
/** Vertices of one smoke at most, joins between strips included. */
export const MOST_SMOKE_VERTICES = THREADS * (2 * MOST + 2);

interface Puff {
  x: number;
  y: number;
  rise: number;
  drift: number;
  age: number;
  strength: number;
  phase: number;
}

export class Smoke {
  private puffs: Puff[] = [];
  private due = 0;
  private clock = 0;

  constructor(private readonly seed: number) {}

  get present(): boolean {
    return this.puffs.length > 0;
  }

  /**
   * Lets time pass. `sinceOut`: seconds since the wick went out, Infinity while it burns. Wind in room units a second.
   */
  update(seconds: number, sinceOut: number, x: number, y: number, unit: number, wind: number): void {
    this.clock += seconds;
    for (const puff of this.puffs) this.carry(puff, seconds, unit, wind);
    while (this.puffs.length > 0 && (this.puffs[0] as Puff).age > LASTS) this.puffs.shift();
    if (sinceOut > SMOKES) return;
    this.due += seconds;
    const strength = Math.min(1, 0.25 + sinceOut / 0.25) * Math.pow(1 - sinceOut / SMOKES, 1.3);
    while (this.due >= EVERY) {
      this.due -= EVERY;
      if (this.puffs.length >= MOST) this.puffs.shift();
      const puff: Puff = { x, y, rise: 0.34, drift: 0, age: 0, strength, phase: this.clock };
      this.carry(puff, this.due, unit, wind);
      this.puffs.push(puff);
    }
  }

  /** Writes triangles as one strip from `offset` (in numbers) on, at depth z. Returns where it ended. */
  write(into: Float32Array, offset: number, z: number, unit: number): number {
    if (this.puffs.length < 3) return offset;
    for (let thread = 0; thread < THREADS; ++thread) offset = this.writeThread(into, offset, z, unit, thread);
    return offset;
  }

  private carry(puff: Puff, seconds: number, unit: number, wind: number): void {
    puff.age += seconds;
    puff.rise += (0.95 - puff.rise) * Math.min(1, 2.6 * seconds);
    puff.drift += (wind - puff.drift) * Math.min(1, 3 * seconds);
    const loose = Math.min(1, puff.age / 1.3) ** 2;
    const swirl =
      0.62 * Math.sin(3.1 * puff.age - 2.3 * this.clock + 1.3 * puff.phase + this.seed) +
      0.38 * Math.sin(5.3 * puff.age + 1.7 * this.clock - 2.1 * puff.phase + 2 * this.seed);
    puff.x += (puff.drift + 0.34 * loose * swirl * unit) * seconds;
    puff.y += puff.rise * unit * seconds * (1 - 0.25 * loose);
  }

  private writeThread(into: Float32Array, offset: number, z: number, unit: number, thread: number): number {
    const last = this.puffs.length - 1;
    for (let k = 0; k <= last; ++k) {
      const puff = this.puffs[k] as Puff;
      const before = this.puffs[Math.max(0, k - 1)] as Puff;
      const after = this.puffs[Math.min(last, k + 1)] as Puff;
      const dx = before.x - after.x;
      const dy = before.y - after.y;
      const length = Math.max(1e-5, Math.hypot(dx, dy));
      const wide = unit * (0.016 + 0.075 * puff.age ** 1.25) * (thread === 0 ? 1 : 0.55);
      const stray = thread === 0 ? 0 : 0.09 * unit * puff.age * Math.sin(2.2 * puff.age + 3 * puff.phase + this.seed);
      const fade = puff.strength * Math.min(1, k / 5) * Math.min(1, puff.age * 16) * (1 - puff.age / LASTS) ** 1.5;
      const opacity = (fade * 0.85) / (1 + 1.7 * puff.age);
      const acrossX = (dy / length) * wide;
      const acrossY = (-dx / length) * wide;
      for (const side of [-1, 1]) {
        const first = k === 0 && side === -1;
        const copies = first || (k === last && side === 1) ? 2 : 1;
        for (let copy = 0; copy < copies; ++copy) {
          into[offset++] = puff.x + stray + side * acrossX;
          into[offset++] = puff.y + side * acrossY;
          into[offset++] = z;
          into[offset++] = side;
          into[offset++] = opacity;
          into[offset++] = puff.age + thread * 3;
        }
      }
    }
    return offset;
  }
}
