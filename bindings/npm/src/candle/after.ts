// Parts needed after the first flame: glare, air with smoke, match. One bundle, fetched while the flame burns.

import { Program, type Quad, warming } from '../stage/gl.js';
import { Air } from './air.js';
import { Glare } from './glare.js';
import boardVertex from './shaders/board.vert.js';
import matchFragment from './shaders/match.frag.js';
import noise from './shaders/noise.glsl.js';

export type After = ReturnType<typeof afterOf>;

export function afterOf(gl: WebGL2RenderingContext, quad: Quad) {
  const [glare, air, match] = [new Glare(gl, quad), new Air(gl, quad), new Program(gl, boardVertex, noise + matchFragment)];
  const warm = warming([match, glare.program, ...Object.values(air.programs)]);
  return { glare, air, match, warm, dispose: () => [glare, air, match].forEach((one) => one.dispose()) };
}
