// Contents of an outline's recording for display: lines, wind, lean of the tip.

import type { Captured, Region } from '@wisp/studio';
import { evenKnots, Spline } from './spline.js';

const sorted = (values: Iterable<number>): number[] => [...values].filter(Number.isFinite).sort((a, b) => a - b);
const quantile = (values: readonly number[], share: number): number => values[Math.round(share * (values.length - 1))] ?? 0;

/** Knots stored in the file; null: uniform. */
function knotsOf(csv: Uint8Array): number[] | null {
  const head = new TextDecoder().decode(csv.subarray(0, 4096));
  const said = /^# knots (.+)$/m.exec(head)?.[1];
  return said === undefined ? null : said.trim().split(/\s+/).map(Number);
}

export class Outlines {
  readonly rate: number;
  readonly rows: number;
  readonly points: number;
  /** input of the model; null: no sound */
  readonly wind: Float64Array | null;
  /** distance of the tip to the right of the base, in flame heights; NaN: no flame */
  readonly lean: Float64Array;
  /** median height, and position of the base, pixels */
  readonly height: number;
  readonly base: { x: number; y: number };
  /** bounding box of the outlines without outliers, pixels */
  readonly bounds: Region;
  private readonly xs: Float64Array[] = [];
  private readonly ys: Float64Array[] = [];
  private readonly spline: Spline;

  /** Returns the outlines of a recording; null if it has none. */
  static of(captured: Captured): Outlines | null {
    return captured.series.some(({ name }) => name === 'p3.x') ? new Outlines(captured) : null;
  }

  private constructor(captured: Captured) {
    const { series, rows, rate } = captured;
    const named = (name: string): Float64Array | undefined => series.find((one) => one.name === name)?.samples;
    for (let k = 0; ; ++k) {
      const [x, y] = [named(`p${k}.x`), named(`p${k}.y`)];
      if (x === undefined || y === undefined) break;
      this.xs.push(x);
      this.ys.push(y);
    }
    this.rate = rate;
    this.rows = rows;
    this.points = this.xs.length;
    this.wind = series.find(({ role }) => role === 'input')?.samples ?? null;
    this.spline = new Spline(this.points, knotsOf(captured.csv) ?? evenKnots(this.points));
    const last = this.points - 1;
    const middle = (columns: readonly Float64Array[], row: number): number =>
      ((columns[0]?.[row] as number) + (columns[last]?.[row] as number)) / 2;
    const every = Array.from({ length: rows }, (_, row) => row);
    const baseOf = (name: string, columns: readonly Float64Array[]): number => quantile(sorted(every.map((row) => named(name)?.[row] ?? middle(columns, row))), 0.5);
    this.base = { x: baseOf('base.x', this.xs), y: baseOf('base.y', this.ys) };
    const tops = every.map((row) => Math.min(...this.ys.map((column) => column[row] as number)));
    this.height = Math.max(1, quantile(sorted(every.map((row) => middle(this.ys, row) - (tops[row] as number))), 0.5));
    const tip = last / 2;
    this.lean = Float64Array.from(every, (row) => {
      const top = ((this.xs[Math.floor(tip)]?.[row] as number) + (this.xs[Math.ceil(tip)]?.[row] as number)) / 2;
      return (top - middle(this.xs, row)) / this.height;
    });
    this.bounds = this.boundsOf(tops);
  }

  /** Outline of a row in pixels, x and y alternating; null where there is none. */
  line(row: number): Float32Array | null {
    const control = this.xs.flatMap((x, k) => [x[row] ?? NaN, this.ys[k]?.[row] ?? NaN]);
    return control.every(Number.isFinite) ? this.spline.draw(control) : null;
  }

  private boundsOf(tops: readonly number[]): Region {
    const across = sorted(this.xs.flatMap((column) => [...column]));
    const [left, right] = [quantile(across, 0.002), quantile(across, 0.998)];
    const top = quantile(sorted(tops), 0.005);
    const bottom = quantile(sorted(this.ys.flatMap((column) => [...column])), 0.998);
    return { x: left, y: top, width: Math.max(1, right - left), height: Math.max(1, bottom - top) };
  }
}
