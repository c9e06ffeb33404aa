// Parts of a cake only: a plaque with a name, and candles shaped as digits.

import { Program } from '../stage/gl.js';
import boardVertex from './shaders/board.vert.js';
import figureFragment from './shaders/figure.frag.js';
import { Words } from './words.js';

const FONT = 'italic 600 92px "Snell Roundhand", "Segoe Script", "URW Chancery L", Georgia, serif';
/** Half height and maximum half width of the plaque, room units. */
const PLAQUE = { high: 0.2, wide: 1.25 };

type Place = readonly [number, number];

/** Arc of an ellipse, in degrees from its right end, anticlockwise. */
const arc = (x: number, y: number, wide: number, high: number, from: number, to: number): Place[] =>
  Array.from({ length: 13 }, (_, k): Place => {
    const turn = ((from + ((to - from) * k) / 12) * Math.PI) / 180;
    return [x + wide * Math.cos(turn), y + high * Math.sin(turn)];
  });

const SIX: readonly Place[] = [[0.74, 1], [0.46, 0.86], [0.24, 0.6], ...arc(0.5, 0.31, 0.35, 0.31, 165, -195)];

/** Strokes of the digits in a unit box, y up: points of a smooth line; a repeated point is a corner. */
const STROKES: Readonly<Record<string, readonly Place[]>> = {
  '0': arc(0.5, 0.5, 0.36, 0.5, 90, 450),
  '1': [[0.22, 0.78], [0.56, 1], [0.56, 1], [0.56, 0]],
  '2': [...arc(0.5, 0.7, 0.34, 0.3, 165, -35), [0.14, 0], [0.14, 0], [0.88, 0]],
  '3': [...arc(0.46, 0.755, 0.31, 0.245, 150, -85), ...arc(0.44, 0.26, 0.38, 0.26, 85, -150)],
  '4': [[0.88, 0.3], [0.1, 0.3], [0.1, 0.3], [0.62, 1], [0.62, 1], [0.62, 0]],
  '5': [[0.84, 1], [0.26, 1], [0.26, 1], [0.2, 0.56], [0.2, 0.56], ...arc(0.47, 0.31, 0.38, 0.31, 125, -150)],
  '6': SIX,
  '7': [[0.12, 1], [0.88, 1], [0.88, 1], [0.58, 0.5], [0.42, 0]],
  '8': [...arc(0.5, 0.755, 0.29, 0.245, -90, 270), ...arc(0.5, 0.255, 0.36, 0.255, 90, -270)],
  '9': SIX.map(([x, y]): Place => [1 - x, 1 - y]),
};
/** Number of points of each drawn stroke, equal to an outline's. */
const POINTS = 64;
/** Width / height of a digit. */
const NARROW = 0.66;

/** Returns the point at a parameter, 0 to 1, of the smooth line through places. */
function through(places: readonly Place[], at: number): [number, number] {
  const k = Math.min(places.length - 2, Math.floor(at * (places.length - 1)));
  const t = at * (places.length - 1) - k;
  const place = (index: number): Place => places[Math.max(0, Math.min(places.length - 1, index))]!;
  const same = (a: number, b: number): boolean => place(a)[0] === place(b)[0] && place(a)[1] === place(b)[1];
  const [b, c] = [place(k), place(k + 1)];
  const a = same(k - 1, k) ? b : place(k - 1);
  const d = same(k + 1, k + 2) ? c : place(k + 2);
  const one = (axis: 0 | 1): number => {
    const [from, to] = [0.5 * (c[axis] - a[axis]), 0.5 * (d[axis] - b[axis])];
    return (2 * t ** 3 - 3 * t ** 2 + 1) * b[axis] + (t ** 3 - 2 * t ** 2 + t) * from + (3 * t ** 2 - 2 * t ** 3) * c[axis] + (t ** 3 - t ** 2) * to;
  };
  return [one(0), one(1)];
}

export class Lettering {
  readonly program: Program;
  private readonly words: Words;
  private readonly figures = new Map<string, Float32Array>();

  constructor(gl: WebGL2RenderingContext) {
    this.program = new Program(gl, boardVertex, figureFragment);
    this.words = new Words(gl);
  }

  /** Binds the name's texture to a unit. Returns the plaque's half width and half height; 0 without a name. */
  name(name: string, unit: number): [number, number] {
    const shape = this.words.write(name, FONT, 99, unit);
    const wide = Math.min(PLAQUE.wide, 0.8 * PLAQUE.high * shape);
    return name === '' ? [0, 0] : [wide, Math.min(PLAQUE.high, (1.4 * wide) / shape)];
  }

  /** Returns a digit's stroke, x, y and 0 per point: the wick, on the upper end, is the origin. */
  figure(digit: string, height: number): Float32Array {
    const key = `${digit} ${height}`;
    const known = this.figures.get(key);
    if (known !== undefined) return known;
    const line = Array.from({ length: POINTS }, (_, k) => through(STROKES[digit] ?? STROKES['0']!, k / (POINTS - 1)));
    const [wick, top] = line.reduce((best, one) => (one[1] > best[1] + 1e-6 ? one : best));
    // Where the highest part is level, the wick is at its middle.
    const level = line.filter(([, y]) => y > top - 0.02).map(([x]) => x);
    const middle = level.length > 2 ? (Math.min(...level) + Math.max(...level)) / 2 : wick;
    const made = Float32Array.from(line.flatMap(([x, y]) => [NARROW * height * (x - middle), height * (y - top), 0]));
    this.figures.set(key, made);
    return made;
  }

  dispose(): void {
    this.program.dispose();
    this.words.dispose();
  }
}
