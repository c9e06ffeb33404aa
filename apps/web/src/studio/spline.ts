// Curve of an outline: a clamped cubic B-spline of the recording's control points.

const DEGREE = 3;

/** Uniform clamped knots. */
export function evenKnots(points: number): number[] {
  const inner = points - DEGREE;
  return Array.from({ length: points + DEGREE + 1 }, (_, k) => Math.min(1, Math.max(0, (k - DEGREE) / inner)));
}

// Weights of the control points at one parameter of the curve: the recursion of Cox and de Boor.
function weightsAt(knots: readonly number[], points: number, at: number): Float64Array {
  const place = Math.min(at, 1 - 1e-9);
  let weights: number[] = Array.from({ length: knots.length - 1 }, (_, k) =>
    (knots[k] as number) <= place && place < (knots[k + 1] as number) ? 1 : 0,
  );
  for (let degree = 1; degree <= DEGREE; ++degree) {
    const before = weights;
    const knot = (k: number): number => knots[k] as number;
    const rising = (k: number): number => (knot(k + degree) > knot(k) ? (place - knot(k)) / (knot(k + degree) - knot(k)) : 0);
    weights = before.slice(1).map((_, k) => rising(k) * (before[k] as number) + (1 - rising(k + 1)) * (before[k + 1] as number));
  }
  return Float64Array.from(weights.slice(0, points));
}

export class Spline {
  private readonly weights: readonly Float64Array[];

  /** `samples`: number of points of the drawn line. */
  constructor(points: number, knots: readonly number[], samples = 56) {
    this.weights = Array.from({ length: samples }, (_, k) => weightsAt(knots, points, k / (samples - 1)));
  }

  /** Returns the curve of control points as a polyline; both have x and y alternating. */
  draw(control: ArrayLike<number>): Float32Array {
    const line = new Float32Array(2 * this.weights.length);
    this.weights.forEach((weights, k) => {
      let x = 0;
      let y = 0;
      weights.forEach((weight, point) => {
        x += weight * (control[2 * point] as number);
        y += weight * (control[2 * point + 1] as number);
      });
      line[2 * k] = x;
      line[2 * k + 1] = y;
    });
    return line;
  }
}
