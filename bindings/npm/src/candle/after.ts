// Parts needed after the first flame: glare, air with smoke, match. One bundle, fetched while the flame burns.

import { Program, type Quad, warming } from '../stage/gl.js';
import { Air } from './air.js';
import { Glare } from './glare.js';
import boardVertex from './shaders/board.vert.js';
import matchFragment from './shaders/match.frag.js';
import noise from './shaders/noise.glsl.js';

export class After {
  readonly glare: Glare;
  readonly air: Air;
  readonly match: Program;
  readonly warm: () => boolean;

  constructor(gl: WebGL2RenderingContext, quad: Quad) {
    this.glare = new Glare(gl, quad);
    this.air = new Air(gl, quad);
    this.match = new Program(gl, boardVertex, noise + matchFragment);
    this.warm = warming([this.match, this.glare.program, ...Object.values(this.air.programs)]);
  }

  dispose(): void {
    for (const one of [this.glare, this.air, this.match]) one.dispose();
  }
}
