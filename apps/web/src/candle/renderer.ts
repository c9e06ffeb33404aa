// Draws the candle's room with WebGL2: light is added up in a picture of high range and developed onto the canvas.

import { drawToCanvas, Program, Quad, Target } from '../stage/gl.js';
import type { FlameShape } from './flame_shape.js';
import type { RoomView, Setting, Stand } from './room.js';
import { MOST_CANDLES, WICK_GAP } from './room.js';
import { MOST_SMOKE_VERTICES, SMOKE_NUMBERS, type Smoke } from './smoke.js';
import boardVertex from './shaders/board.vert?raw';
import candleFragment from './shaders/candle.frag?raw';
import developFragment from './shaders/develop.frag?raw';
import flameFragment from './shaders/flame.frag?raw';
import fullVertex from './shaders/full.vert?raw';
import lightFragment from './shaders/light.frag?raw';
import matchFragment from './shaders/match.frag?raw';
import noise from './shaders/noise.glsl?raw';
import room from './shaders/room.glsl?raw';
import smokeFragment from './shaders/smoke.frag?raw';
import smokeVertex from './shaders/smoke.vert?raw';
import surfaceFragment from './shaders/surface.frag?raw';

/** Most flames that give light: the candles, the match, one to spare. */
const MOST_LIGHTS = MOST_CANDLES + 2;

/** A candle with its flame, as it is to be drawn. */
export interface DrawnCandle {
  stand: Stand;
  shape: FlameShape;
  /** how much of the flame is seen, 0 to 1 */
  size: number;
  /** the wick's glowing end, 0 to 1 */
  ember: number;
  smoke: Smoke;
}

/** The match: where the middle of its head is, in the room. */
export interface DrawnMatch {
  x: number;
  y: number;
  z: number;
  unit: number;
  burning: boolean;
  shape: FlameShape;
  size: number;
  smoke: Smoke;
}

/** All that one picture shows. */
export interface CandlePicture {
  setting: Setting;
  candles: DrawnCandle[];
  match: DrawnMatch;
}

interface Lamp {
  x: number;
  y: number;
  z: number;
  light: number;
}

export class CandleRenderer {
  private readonly quad: Quad;
  private readonly surface: Target;
  private readonly picture: Target;
  private readonly programs: Record<'surface' | 'light' | 'candle' | 'flame' | 'smoke' | 'match' | 'develop', Program>;
  private readonly smokeArray: WebGLVertexArrayObject;
  private readonly smokeBuffer: WebGLBuffer;
  private readonly smokeNumbers = new Float32Array(SMOKE_NUMBERS * MOST_SMOKE_VERTICES * (MOST_CANDLES + 1));
  private readonly lights = new Float32Array(4 * MOST_LIGHTS);
  private readonly halos = new Float32Array(4 * MOST_LIGHTS);
  private readonly spread = new Float32Array(MOST_LIGHTS);
  private readonly standNumbers = new Float32Array(4 * MOST_LIGHTS);
  private readonly lamps: Lamp[] = [];
  private surfaceOf = '';

  constructor(private readonly gl: WebGL2RenderingContext) {
    this.quad = new Quad(gl);
    this.surface = new Target(gl, { range: false });
    this.picture = new Target(gl, { range: true });
    this.programs = {
      surface: new Program(gl, fullVertex, noise + room + surfaceFragment),
      light: new Program(gl, fullVertex, room + lightFragment),
      candle: new Program(gl, boardVertex, noise + candleFragment),
      flame: new Program(gl, boardVertex, flameFragment),
      smoke: new Program(gl, smokeVertex, noise + smokeFragment),
      match: new Program(gl, boardVertex, noise + matchFragment),
      develop: new Program(gl, fullVertex, noise + developFragment),
    };
    this.smokeArray = gl.createVertexArray() as WebGLVertexArrayObject;
    this.smokeBuffer = gl.createBuffer() as WebGLBuffer;
    this.layOutSmoke();
  }

  /** Draws one picture on the canvas, which is view.width by view.height pixels. `fade`: 0 black, 1 all of it. */
  draw(view: RoomView, shown: CandlePicture, fade: number): void {
    const { gl } = this;
    this.picture.resize(view.width, view.height);
    gl.disable(gl.DEPTH_TEST);
    gl.disable(gl.BLEND);
    this.drawSurface(view, shown.setting);
    this.gatherLamps(view, shown);
    this.picture.begin();
    this.drawLight(view, shown);
    gl.enable(gl.BLEND);
    for (const candle of shown.candles) {
      this.drawCandle(view, candle);
      this.drawFlame(view, candle.shape, candle.size, candle.stand, this.flameFoot(candle.stand));
    }
    this.drawMatch(view, shown.match);
    this.drawSmoke(view, shown);
    gl.disable(gl.BLEND);
    drawToCanvas(gl);
    this.picture.bindTexture(0);
    this.programs.develop.use().setInteger('uPicture', 0).set('uSize', view.width, view.height).set('uFade', fade);
    this.quad.draw();
  }

  dispose(): void {
    this.quad.dispose();
    this.surface.dispose();
    this.picture.dispose();
    for (const program of Object.values(this.programs)) program.dispose();
    this.gl.deleteVertexArray(this.smokeArray);
    this.gl.deleteBuffer(this.smokeBuffer);
  }

  private layOutSmoke(): void {
    const { gl } = this;
    const stride = 4 * SMOKE_NUMBERS;
    gl.bindVertexArray(this.smokeArray);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.smokeBuffer);
    gl.bufferData(gl.ARRAY_BUFFER, this.smokeNumbers.byteLength, gl.DYNAMIC_DRAW);
    gl.enableVertexAttribArray(0);
    gl.vertexAttribPointer(0, 4, gl.FLOAT, false, stride, 0);
    gl.enableVertexAttribArray(1);
    gl.vertexAttribPointer(1, 2, gl.FLOAT, false, stride, 16);
    gl.bindVertexArray(null);
  }

  private setRoom(program: Program, view: RoomView, setting: Setting): Program {
    const cake = setting.cake;
    return program
      .use()
      .set('uView', view.middle, view.horizon, view.scale, view.distance)
      .set('uEye', view.eye)
      .set('uCake', cake?.radius ?? 0, cake?.height ?? 0, cake?.x ?? 0);
  }

  private drawSurface(view: RoomView, setting: Setting): void {
    const of = [view.width, view.height, view.scale, view.horizon, setting.cake?.radius, setting.cake?.x].join();
    this.surface.resize(view.width, view.height);
    if (of === this.surfaceOf) return;
    this.surfaceOf = of;
    this.surface.begin();
    this.setRoom(this.programs.surface, view, setting);
    this.quad.draw();
  }

  private gatherLamps(view: RoomView, shown: CandlePicture): void {
    this.lamps.length = 0;
    for (const { stand, shape } of shown.candles) {
      const foot = this.flameFoot(stand);
      this.addLamp(view, stand.x, foot, stand.z, stand.unit, shape, stand);
    }
    const { match } = shown;
    if (match.burning) this.addLamp(view, match.x, match.y, match.z, match.unit, match.shape, null);
  }

  private addLamp(view: RoomView, x: number, y: number, z: number, unit: number, shape: FlameShape, stand: Stand | null): void {
    const k = this.lamps.length;
    const lamp: Lamp = {
      x: x + unit * shape.middleX,
      y: y + unit * Math.max(0.2, shape.middleY),
      z,
      // Small flames on a cake are many.
      light: shape.empty ? 0 : shape.light * unit ** 1.3,
    };
    this.lamps.push(lamp);
    this.lights.set([lamp.x, lamp.y, lamp.z, lamp.light], 4 * k);
    this.halos[4 * k] = view.pixelX(x, z);
    this.halos[4 * k + 1] = view.pixelY(y + 0.25 * unit * shape.tipY, z);
    this.halos[4 * k + 2] = view.pixelX(x + 0.8 * unit * shape.tipX, z);
    this.halos[4 * k + 3] = view.pixelY(y + 0.72 * unit * shape.tipY, z);
    this.spread[k] = view.scale * view.nearness(z) * Math.max(0.3, unit);
    this.standNumbers.set(stand === null ? [0, 0, 0.01, 0] : [stand.x, stand.z, stand.radius, stand.height], 4 * k);
  }

  private drawLight(view: RoomView, shown: CandlePicture): void {
    this.surface.bindTexture(0);
    this.setRoom(this.programs.light, view, shown.setting)
      .setInteger('uSurface', 0)
      .setInteger('uCount', this.lamps.length)
      .set('uGround', shown.candles[0]?.stand.ground ?? 0)
      .setVectors4('uLights', this.lights)
      .setVectors4('uHalos', this.halos)
      .setVectors4('uStands', this.standNumbers)
      .setNumbers('uSpread', this.spread);
    this.quad.draw();
  }

  private flameFoot(stand: Stand): number {
    return stand.ground + stand.height + WICK_GAP * stand.unit;
  }

  private setBoard(program: Program, view: RoomView, x: number, y: number, z: number, unit: number, box: number[]): Program {
    return program
      .use()
      .set('uView', view.middle, view.horizon, view.scale, view.distance)
      .set('uEye', view.eye)
      .set('uSize', view.width, view.height)
      .set('uFoot', x, y, z)
      .set('uUnit', unit)
      .set('uPixel', 1 / (view.scale * view.nearness(z) * unit))
      .set('uBox', ...box);
  }

  /** Light that the other flames throw on a candle: from the left, from the right, from behind, on the whole. */
  private lightFromOthers(candle: DrawnCandle): [number, number, number, number] {
    const { stand, shape } = candle;
    const sum: [number, number, number, number] = [0, 0, 0, 0];
    const own = stand.x + stand.unit * shape.middleX;
    for (const lamp of this.lamps) {
      if (lamp.x === own && lamp.z === stand.z) continue;
      const dx = lamp.x - stand.x;
      const dz = lamp.z - stand.z;
      const flat2 = dx * dx + dz * dz;
      const light = (0.9 * lamp.light) / (0.2 + flat2);
      const flat = Math.sqrt(Math.max(1e-6, flat2));
      sum[0] += light * Math.max(0, -dx / flat);
      sum[1] += light * Math.max(0, dx / flat);
      sum[2] += light * Math.max(0, -dz / flat);
      sum[3] += light;
    }
    return sum;
  }

  private drawCandle(view: RoomView, candle: DrawnCandle): void {
    const { gl } = this;
    const { stand, shape } = candle;
    const top = stand.ground + stand.height;
    const radius = stand.radius / stand.unit;
    const height = stand.height / stand.unit;
    const upper = view.flatness(top, stand.z);
    const lower = view.flatness(stand.ground, stand.z);
    gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
    const box = [-radius - 0.12, -height - radius * lower - 0.05, radius + 0.12, 0.34];
    this.setBoard(this.programs.candle, view, stand.x, top, stand.z, stand.unit, box)
      .set('uRadius', radius)
      .set('uHeight', height)
      .set('uFlat', upper, lower)
      .set('uLight', shape.empty ? 0 : shape.light)
      .set('uLean', shape.middleX, shape.middleY)
      .set('uEmber', candle.ember)
      .set('uSeed', stand.seed)
      .set('uStripe', stand.striped ? 1 : 0)
      .set('uWax', ...stand.wax)
      .set('uOthers', ...this.lightFromOthers(candle));
    this.quad.draw();
  }

  private drawFlame(view: RoomView, shape: FlameShape, size: number, at: { x: number; z: number; unit: number }, foot: number): void {
    if (shape.empty || size <= 0) return;
    const { gl } = this;
    const margin = 0.05;
    const box = [shape.left - margin, shape.bottom - margin, shape.right + margin, shape.top + margin];
    gl.blendFunc(gl.ONE, gl.ONE);
    this.setBoard(this.programs.flame, view, at.x, foot, at.z, at.unit, box)
      .setVectors3('uOutline', shape.points)
      .setInteger('uPoints', shape.count)
      .set('uBright', 0.35 + 0.65 * size)
      .set('uSoot', Math.min(1, 0.25 + shape.top))
      .set('uWidth', shape.width);
    this.quad.draw();
  }

  private drawMatch(view: RoomView, match: DrawnMatch): void {
    const { gl } = this;
    gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
    this.setBoard(this.programs.match, view, match.x, match.y, match.z, match.unit, [-0.1, -1.05, 0.75, 0.1]).set(
      'uBurnt',
      match.burning ? match.size : 0,
    ).set('uRoom', this.lightAt(match.x, match.y, match.z));
    this.quad.draw();
    if (match.burning) this.drawFlame(view, match.shape, match.size, match, match.y);
  }

  /** Light of all flames at a place of the room. */
  private lightAt(x: number, y: number, z: number): number {
    let sum = 0;
    for (const lamp of this.lamps) {
      const far2 = (lamp.x - x) ** 2 + (lamp.y - y) ** 2 + (lamp.z - z) ** 2;
      sum += lamp.light / (0.8 + far2);
    }
    return Math.min(1.2, 1.6 * sum);
  }

  private drawSmoke(view: RoomView, shown: CandlePicture): void {
    const { gl } = this;
    let end = 0;
    for (const { smoke, stand } of shown.candles) end = smoke.write(this.smokeNumbers, end, stand.z, stand.unit);
    end = shown.match.smoke.write(this.smokeNumbers, end, shown.match.z, shown.match.unit);
    if (end === 0) return;
    gl.bindVertexArray(this.smokeArray);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.smokeBuffer);
    gl.bufferSubData(gl.ARRAY_BUFFER, 0, this.smokeNumbers, 0, end);
    gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
    this.programs.smoke
      .use()
      .set('uView', view.middle, view.horizon, view.scale, view.distance)
      .set('uEye', view.eye)
      .set('uSize', view.width, view.height)
      .setInteger('uCount', this.lamps.length)
      .setVectors4('uLights', this.lights);
    gl.drawArrays(gl.TRIANGLE_STRIP, 0, end / SMOKE_NUMBERS);
    gl.bindVertexArray(null);
  }
}
