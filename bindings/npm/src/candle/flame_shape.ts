// Drawn shape of a flame from its model's outline: closed with a rounded base, and its extents and light.

/** Maximum number of drawn points of an outline. */
export const MAX_POINTS = 64;

/** Area of a calm flame in square flame units; its light is 1. */
const CALM_AREA = 0.17;

/** Share of the flame's height below which the noisy outline is replaced by a drop around the wick. */
const SHOULDER = 0.2;

export class FlameShape {
  /** x, y and height along the outline (0 base, 1 tip) of each point */
  readonly points = new Float32Array(3 * MAX_POINTS);
  count = 0;
  /** bounds in flame units; empty when left > right */
  left = 1;
  right = -1;
  bottom = 0;
  top = 0;
  tipX = 0;
  tipY = 0;
  /** mean of the outline's points */
  middleX = 0;
  middleY = 0;
  /** light relative to a calm flame */
  light = 0;
  /** mean width of the flame's body */
  width = 0.25;
  private readonly along = new Float32Array(MAX_POINTS);

  get empty(): boolean {
    return this.count < 3 || this.top - this.bottom < 0.01;
  }

  /**
   * Takes an outline: x, y alternating, from the base's left over the tip to the base's right. `size`: visible share of
   * the flame, 0 to 1, which also scales its light.
   */
  update(outline: Float32Array, size: number): void {
    this.count = Math.min(MAX_POINTS, outline.length >> 1);
    let height = 0;
    for (let k = 0; k < this.count; ++k) height = Math.max(height, outline[2 * k + 1] as number);
    this.roundBase(outline, height);
    this.measure();
    this.climb();
    const burning = Math.min(2.4, Math.abs(this.area()) / CALM_AREA);
    this.light = size > 0 && !this.empty ? Math.pow(burning, 0.7) * (0.3 + 0.7 * size) : 0;
  }

  /** Returns the outline in pixels with y down: x and y alternating, with the flame's origin at (x, y). */
  placed(unit: number, x: number, y: number): Float32Array {
    const line = new Float32Array(2 * this.count);
    for (let k = 0; k < this.count; ++k) line.set([x + unit * (this.points[3 * k] as number), y - unit * (this.points[3 * k + 1] as number)], 2 * k);
    return line;
  }

  private roundBase(outline: Float32Array, height: number): void {
    const shoulder = SHOULDER * height;
    const drop = 0.05 * Math.min(1, height);
    const middle = 0.5 * ((outline[0] as number) + (outline[2 * this.count - 2] as number));
    for (let k = 0; k < this.count; ++k) {
      let x = outline[2 * k] as number;
      let y = outline[2 * k + 1] as number;
      if (y < shoulder && shoulder > 0) {
        const down = Math.min(1, (shoulder - y) / shoulder);
        x = middle + (x - middle) * Math.sqrt(Math.max(0, 1 - down * down));
        y -= drop * down * down;
      }
      this.points[3 * k] = x;
      this.points[3 * k + 1] = y;
    }
  }

  private measure(): void {
    this.left = this.bottom = Infinity;
    this.right = this.top = -Infinity;
    let farthest = -1;
    let sumX = 0;
    let sumY = 0;
    for (let k = 0; k < this.count; ++k) {
      const x = this.points[3 * k] as number;
      const y = this.points[3 * k + 1] as number;
      this.left = Math.min(this.left, x);
      this.right = Math.max(this.right, x);
      this.bottom = Math.min(this.bottom, y);
      this.top = Math.max(this.top, y);
      const far = x * x + y * y;
      if (far > farthest) [farthest, this.tipX, this.tipY] = [far, x, y];
      sumX += x;
      sumY += y;
    }
    this.middleX = sumX / Math.max(1, this.count);
    this.middleY = sumY / Math.max(1, this.count);
    const reach = Math.sqrt(Math.max(1e-6, farthest));
    this.width = Math.max(0.02, (0.95 * Math.abs(this.area())) / reach);
  }

  /** Computes each point's height along the outline, by arc length on either side of the tip. */
  private climb(): void {
    const { points, count } = this;
    let tip = 0;
    let length = 0;
    const at = this.along;
    for (let k = 0; k < count; ++k) {
      if (points[3 * k] === this.tipX && points[3 * k + 1] === this.tipY) tip = k;
      if (k > 0) length += Math.hypot(points[3 * k]! - points[3 * k - 3]!, points[3 * k + 1]! - points[3 * k - 2]!);
      at[k] = length;
    }
    const left = Math.max(1e-6, at[tip] ?? 0);
    const right = Math.max(1e-6, length - left);
    for (let k = 0; k < count; ++k) {
      const along = at[k] as number;
      points[3 * k + 2] = k <= tip ? along / left : (length - along) / right;
    }
  }

  private area(): number {
    const { points, count } = this;
    let twice = 0;
    for (let k = 0; k < count; ++k) {
      const next = (k + 1) % count;
      twice += points[3 * k]! * points[3 * next + 1]! - points[3 * next]! * points[3 * k + 1]!;
    }
    return twice / 2;
  }
}
