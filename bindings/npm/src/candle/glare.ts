// Glare in the eye: a chain of pictures of decreasing size, added up from the smallest to the largest.

import { Program, type Quad, Target } from '../stage/gl.js';
import glareFragment from './shaders/glare.frag.js';
import wholeVertex from './shaders/whole.vert.js';

const LEVELS = 6;
/** Weight of the coarser picture in the blend at each level, from the coarsest to the finest. */
const SPREAD = [0.5, 0.5, 0.5, 0.48, 0.45];

export class Glare {
  private readonly down: Target[];
  private readonly up: Target[];
  readonly program: Program;

  constructor(gl: WebGL2RenderingContext, private readonly quad: Quad) {
    this.down = Array.from({ length: LEVELS }, () => new Target(gl, { range: true }));
    this.up = Array.from({ length: LEVELS - 1 }, () => new Target(gl, { range: true }));
    this.program = new Program(gl, wholeVertex, glareFragment);
  }

  /** Computes the glare of a picture, at half its size. */
  of(picture: Target): Target {
    this.program.use().setInteger('uFrom', 0).setInteger('uFiner', 1);
    let from = picture;
    for (const target of this.down) {
      target.resize(Math.max(1, from.width >> 1), Math.max(1, from.height >> 1));
      this.pass(from, null, target, 0);
      from = target;
    }
    for (let k = LEVELS - 2; k >= 0; --k) {
      const finer = this.down[k]!;
      const target = this.up[k]!;
      target.resize(finer.width, finer.height);
      this.pass(from, finer, target, SPREAD[LEVELS - 2 - k]!);
      from = target;
    }
    return from;
  }

  dispose(): void {
    for (const one of [...this.down, ...this.up, this.program]) one.dispose();
  }

  private pass(from: Target, finer: Target | null, to: Target, spread: number): void {
    to.begin();
    from.bindTexture(0);
    (finer ?? from).bindTexture(1);
    this.program.set('uTexel', 1 / from.width, 1 / from.height).set('uSpread', spread);
    this.quad.draw();
  }
}
