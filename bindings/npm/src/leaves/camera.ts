// Camera of the leaves: metres, z up; the eye looks along +y.

const EYE = [0, -2.75, 1.12] as const;
const TARGET_HEIGHT = 0.93;
const HALF_VIEW = Math.tan((0.5 * 46 * Math.PI) / 180);
const NEAR = 0.2;
const FAR = 30;
const DOWN = Math.atan2(EYE[2] - TARGET_HEIGHT, -EYE[1]);
/** Sine and cosine of the eye's pitch, downwards. */
const PITCH = [Math.sin(DOWN), Math.cos(DOWN)] as const;

export class LeafCamera {
  readonly eye = EYE;
  /** world to clip space, column-major */
  readonly matrix = new Float32Array(16);
  readonly looksDown = PITCH;
  aspect = 1;
  width = 1;
  height = 1;

  /** Half extents of the view at a distance of one metre: across and up. */
  get half(): readonly [number, number] {
    return [HALF_VIEW * this.aspect, HALF_VIEW];
  }

  frame(width: number, height: number): void {
    this.width = width;
    this.height = height;
    this.aspect = width / Math.max(1, height);
    const [s, c] = PITCH;
    // Rows: right is x; up is (0, s, c); the view direction is (0, c, −s).
    const fx = 1 / (HALF_VIEW * this.aspect);
    const fy = 1 / HALF_VIEW;
    const depth = (FAR + NEAR) / (FAR - NEAR);
    const [ex, ey, ez] = EYE;
    const up = s * ey + c * ez;
    const ahead = c * ey - s * ez;
    this.matrix.set([fx, 0, 0, 0]);
    this.matrix.set([0, fy * s, depth * c, c], 4);
    this.matrix.set([0, fy * c, -depth * s, -s], 8);
    this.matrix.set([-fx * ex, -fy * up, -depth * ahead - (2 * FAR * NEAR) / (FAR - NEAR), -ahead], 12);
  }

  /** Half width of the view at depth y, at the eye's height. */
  halfWidth(y: number): number {
    return (y - EYE[1]) * PITCH[1] * HALF_VIEW * this.aspect;
  }

  /** Position (x and z) shown by a pixel at depth y. */
  at(pixelX: number, pixelY: number, y: number): [number, number] {
    const across = ((2 * pixelX) / this.width - 1) * HALF_VIEW * this.aspect;
    const up = ((2 * pixelY) / this.height - 1) * HALF_VIEW;
    const [s, c] = PITCH;
    const wayY = c + up * s;
    const wayZ = -s + up * c;
    const far = (y - EYE[1]) / wayY;
    return [EYE[0] + across * far, EYE[2] + wayZ * far];
  }
}
