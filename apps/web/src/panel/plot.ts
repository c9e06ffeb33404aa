// A scrolling plot of the last seconds of one number.

const KEPT = 360;

/** Colours of a line in the dark and the light drawer. */
export type Ink = readonly [night: string, day: string];

const day = window.matchMedia('(prefers-color-scheme: light)');
const ZERO: Ink = ['rgb(255 240 220 / 22%)', 'rgb(60 40 20 / 26%)'];
const shade = ([night, light]: Ink): string => (day.matches ? light : night);

export class Plot {
  private readonly values = new Float32Array(KEPT);
  private newest = 0;
  private count = 0;

  /** `least`: minimum range of the axis, as low and high end. */
  constructor(
    private readonly canvas: HTMLCanvasElement,
    private readonly colour: Ink,
    private readonly least: readonly [number, number],
  ) {}

  push(value: number): void {
    this.newest = (this.newest + 1) % KEPT;
    this.values[this.newest] = value;
    this.count = Math.min(KEPT, this.count + 1);
  }

  clear(): void {
    this.count = 0;
  }

  /** Mean of the last `samples` values. */
  mean(samples: number): number {
    const count = Math.min(samples, this.count);
    let sum = 0;
    for (let k = 0; k < count; ++k) sum += this.at(k);
    return count === 0 ? 0 : sum / count;
  }

  draw(): void {
    const context = this.canvas.getContext('2d');
    if (context === null) return;
    const share = Math.min(2, window.devicePixelRatio);
    const width = Math.round(this.canvas.clientWidth * share);
    const height = Math.round(this.canvas.clientHeight * share);
    if (this.canvas.width !== width || this.canvas.height !== height) {
      this.canvas.width = width;
      this.canvas.height = height;
    }
    context.clearRect(0, 0, width, height);
    let [low, high] = this.least;
    for (let k = 0; k < this.count; ++k) {
      low = Math.min(low, this.at(k));
      high = Math.max(high, this.at(k));
    }
    const y = (value: number): number => height - 3 - ((value - low) / (high - low || 1)) * (height - 6);
    context.strokeStyle = shade(ZERO);
    context.lineWidth = 1;
    context.beginPath();
    context.moveTo(0, Math.round(y(0)) + 0.5);
    context.lineTo(width, Math.round(y(0)) + 0.5);
    context.stroke();
    context.strokeStyle = shade(this.colour);
    context.lineWidth = 1.6 * share;
    context.lineJoin = 'round';
    context.beginPath();
    for (let k = 0; k < this.count; ++k) context.lineTo(width - (k / (KEPT - 1)) * width, y(this.at(k)));
    context.stroke();
  }

  private at(back: number): number {
    return this.values[(this.newest - back + KEPT) % KEPT] as number;
  }
}
