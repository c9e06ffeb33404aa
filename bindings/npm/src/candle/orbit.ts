// The eye that goes round the table: where it is, what winds are to it, and what it sees of a body.

/** Turn of the eye when the picture is dragged from one edge to the other, radians. */
const ACROSS = Math.PI;
/** Widths of the picture a second from which on a drag is a stroke. */
const SWIPE = 1.2;
const RING = 6;

export class Orbit {
  /** radians anticlockwise from above, from where the flame was filmed */
  azimuth = 0;
  /** how far the middle and the tip of the last body that was seen lean away from the eye */
  middleAway = 0;
  tipAway = 0;
  private held: { x: number; azimuth: number } | null = null;
  private outline = new Float32Array(0);

  get turning(): boolean {
    return this.held !== null;
  }

  grab(x: number): void {
    this.held = { x, azimuth: this.azimuth };
  }

  letGo(): void {
    this.held = null;
  }

  /** The pointer is there, in a picture of that width, at that speed. True where the eye has moved. */
  drag(x: number, speed: number, width: number): boolean {
    if (this.held === null) return false;
    // A hand that passes quickly makes wind, and turns nothing.
    if (Math.abs(speed) > SWIPE * width) this.held = null;
    else return this.turnTo(this.held.azimuth - ((x - this.held.x) / Math.max(1, width)) * ACROSS);
    return false;
  }

  turnTo(azimuth: number): boolean {
    const before = this.azimuth;
    this.azimuth = azimuth;
    return azimuth !== before;
  }

  /** A place about the table's middle as the eye sees it: to its right, and towards it. */
  seen(x: number, z: number): readonly [right: number, near: number] {
    const c = Math.cos(this.azimuth);
    const s = Math.sin(this.azimuth);
    return [c * x - s * z, s * x + c * z];
  }

  /** A wind to the eye's right and one away from it, as a model in the round takes it: x and z. */
  wind(right: number, away: number): readonly [x: number, z: number] {
    const c = Math.cos(this.azimuth);
    const s = Math.sin(this.azimuth);
    return [c * right - s * away, -s * right - c * away];
  }

  /** The outline of a body's rings; `flatness`: the share of a level circle's width that is seen as height. */
  see(rings: Float32Array, flatness: number): Float32Array {
    const count = rings.length / RING;
    if (this.outline.length !== 4 * count) this.outline = new Float32Array(4 * count);
    const { outline } = this;
    for (let k = 0; k < count; ++k) {
      const at = (number: number): number => rings[RING * k + number] as number;
      const [right, near] = this.seen(at(0), at(2));
      const [rise] = this.seen(at(4), at(5));
      this.tipAway = -near;
      if (k === count >> 1) this.middleAway = -near;
      const last = outline.length - 2 - 2 * k;
      const height = at(1) - flatness * near;
      outline[2 * k] = right - at(3);
      outline[2 * k + 1] = height - rise;
      outline[last] = right + at(3);
      outline[last + 1] = height + rise;
    }
    return outline;
  }
}
