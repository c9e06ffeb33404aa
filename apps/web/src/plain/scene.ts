// Scene of a model with plain outputs: each is drawn as a scrolling line.

import type { Bank, Model } from '@wisp/player';
import { drawToCanvas, Program, verticesOf, type Vertices } from '@wisp/player/parts/stage/gl';
import type { Acting, Reading, Scene, SceneLook, SceneSettings } from '@wisp/player/parts/stage/scene';

const KEPT = 600;
const MAX_LINES = 8;
const NANOSECONDS = 1e9;

const VERTEX = `
layout(location = 0) in float value;
uniform vec4 uBox;
uniform vec2 uShift;
uniform float uLast;
void main() {
  vec2 at = vec2(uBox.x + uBox.z * (float(gl_VertexID) / uLast), uBox.y + uBox.w * value);
  gl_Position = vec4(at + uShift, 0, 1);
}`;

const FRAGMENT = `
uniform vec4 uColour;
out vec4 colour;
void main() { colour = uColour; }`;

const COLOURS: readonly (readonly [number, number, number])[] = [[1, 0.7, 0.36], [0.5, 0.77, 1], [0.62, 0.85, 0.64], [0.9, 0.56, 0.72]];

export class PlainScene implements Scene {
  private readonly bank: Bank;
  readonly answerName: string;
  private readonly lines: Float32Array[];
  private readonly id: bigint;
  private wind = 0;
  private drawing: ({ gl: WebGL2RenderingContext; program: Program } & Vertices) | null = null;

  constructor(private readonly model: Model, settings: SceneSettings) {
    this.bank = model.bank({ seed: settings.seed });
    this.bank.setNoise(settings.noise);
    this.id = this.bank.spawn();
    this.lines = Array.from({ length: Math.min(MAX_LINES, model.outputs.length) }, () => new Float32Array(KEPT));
    this.answerName = model.outputs[0]?.name ?? 'output';
  }

  update(acting: Acting): void {
    const { pointer } = acting;
    const stroke = pointer.present ? Math.max(-2, Math.min(2, pointer.speedX / 1500)) : 0;
    this.wind = acting.breath + stroke;
    const inputs = this.model.inputs.map(({ lowest, highest }) =>
      Math.max(lowest, Math.min(highest, this.wind * Math.max(Math.abs(lowest), Math.abs(highest)))),
    );
    if (inputs.length > 0) this.bank.setInstanceInputs(this.id, inputs);
    if (this.bank.advance(acting.seconds * NANOSECONDS) === 0) return;
    const outputs = this.bank.instanceOutputs(this.id);
    this.lines.forEach((line, k) => {
      line.copyWithin(0, 1);
      const { lowest, highest } = this.model.outputs[k] as { lowest: number; highest: number };
      line[KEPT - 1] = ((outputs[k] as number) - lowest) / (highest - lowest || 1);
    });
  }

  reading(): Reading {
    return { wind: this.wind, answer: this.lines[0]?.[KEPT - 1] ?? 0 };
  }

  attach(gl: WebGL2RenderingContext): void {
    this.drawing = { gl, program: new Program(gl, VERTEX, FRAGMENT), ...verticesOf(gl, new Float32Array(KEPT), [1], gl.DYNAMIC_DRAW) };
    gl.bindVertexArray(null);
  }

  draw(width: number, height: number, { fade }: SceneLook): boolean {
    if (this.drawing === null) return true;
    const { gl, program, buffer, array } = this.drawing;
    drawToCanvas(gl);
    gl.disable(gl.BLEND);
    gl.clearColor(0.035, 0.035, 0.05, 1);
    gl.clear(gl.COLOR_BUFFER_BIT);
    program.use().set('uLast', KEPT - 1);
    gl.bindVertexArray(array);
    gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
    const room = 1.3 / Math.max(1, this.lines.length);
    this.lines.forEach((line, k) => {
      gl.bufferSubData(gl.ARRAY_BUFFER, 0, line);
      program.set('uBox', -0.9, 0.75 - room * (k + 0.9), 1.8, 0.8 * room);
      program.set('uColour', ...(COLOURS[k % COLOURS.length] as [number, number, number]).map((part) => part * fade), 1);
      for (const shift of [-0.6, 0, 0.6]) {
        program.set('uShift', (shift * 2) / width, (shift * 2) / height);
        gl.drawArrays(gl.LINE_STRIP, 0, KEPT);
      }
    });
    gl.bindVertexArray(null);
    return true;
  }

  act(): void {
    this.bank.reset(this.id);
  }

  apply(settings: SceneSettings): void {
    this.bank.setNoise(settings.noise);
  }

  describe(): string {
    return `Live plots of ${this.lines.length} outputs of the model ${this.model.name}.`;
  }

  dispose(): void {
    if (this.drawing !== null) {
      const { gl, program, buffer, array } = this.drawing;
      program.dispose();
      gl.deleteBuffer(buffer);
      gl.deleteVertexArray(array);
    }
    this.bank.free();
  }
}
