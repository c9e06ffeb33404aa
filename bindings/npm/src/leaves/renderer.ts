// Draws leaves with WebGL2: one instanced call for all leaves, one for their shadows. Poses are uploaded as the bank
// returns them, and rotated on the card.

import { drawToCanvas, Program, Quad, SQUARE, Target, verticesOf, type Vertices } from '../stage/gl.js';
import noise from '../candle/shaders/noise.glsl.js';
import wholeVertex from '../candle/shaders/whole.vert.js';
import type { LeafCamera } from './camera.js';
import { LEAF_NUMBERS } from './fall.js';
import { leafMesh } from './mesh.js';
import finishFragment from './shaders/finish.frag.js';
import leafFragment from './shaders/leaf.frag.js';
import leafVertex from './shaders/leaf.vert.js';
import posed from './shaders/posed.glsl.js';
import shadowFragment from './shaders/shadow.frag.js';
import shadowVertex from './shaders/shadow.vert.js';
import species from './shaders/species.glsl.js';
import skyFragment from './shaders/sky.frag.js';

/** Resolution of a leaf's mesh by the number of leaves: up to `most` leaves have that many rows and columns. */
const MESHES: readonly (readonly [most: number, rows: number, columns: number])[] = [
  [120, 10, 4],
  [1200, 5, 2],
  [Infinity, 3, 2],
];
/** Magnification of drawn leaves. */
const ENLARGED = 1.45;

interface Shape extends Vertices { indices: WebGLBuffer | null; count: number }

export class LeafRenderer {
  private readonly quad: Quad;
  private readonly picture: Target;
  private readonly programs: Record<'sky' | 'leaf' | 'shadow' | 'finish', Program>;
  private readonly instances: WebGLBuffer;
  private readonly leaves: readonly { most: number; shape: Shape }[];
  private readonly shadow: Shape;
  private room = 0;

  constructor(private readonly gl: WebGL2RenderingContext) {
    this.quad = new Quad(gl);
    this.picture = new Target(gl, { range: false, samples: 4 });
    this.programs = {
      sky: new Program(gl, wholeVertex, noise + skyFragment),
      leaf: new Program(gl, posed + leafVertex, noise + species + leafFragment),
      shadow: new Program(gl, posed + shadowVertex, shadowFragment),
      finish: new Program(gl, wholeVertex, noise + finishFragment),
    };
    this.instances = gl.createBuffer() as WebGLBuffer;
    this.leaves = MESHES.map(([most, rows, columns]) => {
      const { vertices, indices } = leafMesh(rows, columns);
      return { most, shape: this.shape(vertices, [3, 2], indices) };
    });
    this.shadow = this.shape(SQUARE, [2], null);
  }

  /** Draws `count` leaves on the canvas, from LEAF_NUMBERS numbers each; half sizes in metres. */
  draw(camera: LeafCamera, leaves: Float32Array, count: number, halfSize: readonly [number, number], clock: number, fade: number): void {
    const { gl } = this;
    this.upload(leaves, count);
    this.picture.resize(camera.width, camera.height);
    this.picture.begin();
    gl.clear(gl.DEPTH_BUFFER_BIT);
    gl.disable(gl.DEPTH_TEST);
    gl.disable(gl.BLEND);
    this.drawSky(camera, clock);
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.DST_COLOR, gl.ZERO);
    const size = [ENLARGED * halfSize[0], ENLARGED * halfSize[1]] as const;
    this.programs.shadow.use().setMatrix('uMatrix', camera.matrix).set('uHalfSize', ...size);
    gl.bindVertexArray(this.shadow.array);
    gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, count);
    gl.disable(gl.BLEND);
    gl.enable(gl.DEPTH_TEST);
    // The fragment shader cuts outlines out of sheets; alpha to coverage antialiases their edges.
    gl.enable(gl.SAMPLE_ALPHA_TO_COVERAGE);
    this.programs.leaf.use().setMatrix('uMatrix', camera.matrix).set('uHalfSize', ...size).set('uEye', ...camera.eye);
    const { shape } = this.leaves.find(({ most }) => count <= most) as { shape: Shape };
    gl.bindVertexArray(shape.array);
    gl.drawElementsInstanced(gl.TRIANGLES, shape.count, gl.UNSIGNED_SHORT, 0, count);
    gl.bindVertexArray(null);
    gl.disable(gl.SAMPLE_ALPHA_TO_COVERAGE);
    gl.disable(gl.DEPTH_TEST);
    this.picture.finish();
    drawToCanvas(gl);
    this.picture.bindTexture(0);
    this.programs.finish.use().setInteger('uPicture', 0).set('uSize', camera.width, camera.height).set('uFade', fade);
    this.quad.draw();
  }

  dispose(): void {
    for (const one of [this.quad, this.picture, ...Object.values(this.programs)]) one.dispose();
    for (const shape of [this.shadow, ...this.leaves.map(({ shape: leaf }) => leaf)]) {
      this.gl.deleteVertexArray(shape.array);
      this.gl.deleteBuffer(shape.buffer);
      this.gl.deleteBuffer(shape.indices);
    }
    this.gl.deleteBuffer(this.instances);
  }

  private upload(leaves: Float32Array, count: number): void {
    const { gl } = this;
    gl.bindBuffer(gl.ARRAY_BUFFER, this.instances);
    if (this.room < count) {
      this.room = Math.min(leaves.length / LEAF_NUMBERS, Math.max(count, 2 * this.room));
      gl.bufferData(gl.ARRAY_BUFFER, 4 * LEAF_NUMBERS * this.room, gl.STREAM_DRAW);
    }
    gl.bufferSubData(gl.ARRAY_BUFFER, 0, leaves, 0, LEAF_NUMBERS * count);
  }

  private drawSky(camera: LeafCamera, clock: number): void {
    this.programs.sky
      .use()
      .set('uSize', camera.width, camera.height)
      .set('uHalf', ...camera.half)
      .set('uDown', ...camera.looksDown)
      .set('uEye', ...camera.eye)
      .set('uClock', clock);
    this.quad.draw();
  }

  /** Returns a shape drawn once per leaf: `sizes` of its attributes; `order`: indices, null for a strip. */
  private shape(vertices: Float32Array, sizes: readonly number[], order: Uint16Array | null): Shape {
    const { gl } = this;
    const made = verticesOf(gl, vertices, sizes);
    const indices = order === null ? null : gl.createBuffer();
    if (order !== null) {
      gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, indices);
      gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, order, gl.STATIC_DRAW);
    }
    gl.bindBuffer(gl.ARRAY_BUFFER, this.instances);
    for (const [location, offset] of [[2, 0], [3, 16]] as const) {
      gl.enableVertexAttribArray(location);
      gl.vertexAttribPointer(location, 4, gl.FLOAT, false, 4 * LEAF_NUMBERS, offset);
      gl.vertexAttribDivisor(location, 1);
    }
    gl.bindVertexArray(null);
    return { ...made, indices, count: order?.length ?? 4 };
  }
}
