// The eye that circles the table: its position, winds relative to it, and its view of a body.

/** Rotation of the eye for a drag across the whole picture, radians. */
const ACROSS = Math.PI;
/** Drag speed above which a drag makes wind and does not rotate the eye, picture widths a second. */
const SWIPE = 1.2;
const RING = 6;

export class Orbit {
  /** anticlockwise from above, radians; 0 where the flame was filmed */
  azimuth = 0;
  /** displacement away from the eye of the middle and the tip of the last seen body, flame units */
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

  /** Rotates the eye by the drag to x, if its speed is below SWIPE; pixels. Returns whether the eye has moved. */
  drag(x: number, speed: number, width: number): boolean {
    // A fast stroke makes wind and does not rotate.
    if (Math.abs(speed) > SWIPE * width) this.held = null;
    return this.held !== null && this.turnTo(this.held.azimuth - ((x - this.held.x) / Math.max(1, width)) * ACROSS);
  }

  turnTo(azimuth: number): boolean {
    const before = this.azimuth;
    this.azimuth = azimuth;
    return azimuth !== before;
  }

  /** Converts a position relative to the table's middle to the eye's axes: to the right, and towards the eye. */
  seen(x: number, z: number): readonly [right: number, near: number] {
    const c = Math.cos(this.azimuth);
    const s = Math.sin(this.azimuth);
    return [c * x - s * z, s * x + c * z];
  }

  /** Converts a wind to the eye's right and away from it to a body model's x and z. */
  wind(right: number, away: number): readonly [x: number, z: number] {
    const c = Math.cos(this.azimuth);
    const s = Math.sin(this.azimuth);
    return [c * right - s * away, -s * right - c * away];
  }

  /** Outline of a body's rings; `flatness`: height / width of a level circle in the picture. */
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
