// The air of the room, in the plane of the picture: heat rises in it, breath and hand stir it, smoke is carried by it.
// A fluid on a coarse grid, and smoke on a finer one.

import { Program, type Quad, Target } from '../stage/gl.js';
import carryFragment from './shaders/carry.frag.js';
import fluid from './shaders/fluid.glsl.js';
import freeFragment from './shaders/free.frag.js';
import noise from './shaders/noise.glsl.js';
import pressFragment from './shaders/press.frag.js';
import smokeFragment from './shaders/smoke.frag.js';
import sootFragment from './shaders/soot.frag.js';
import wholeVertex from './shaders/whole.vert.js';
import { Words } from './words.js';

/** Cells of the air's grid, and how much finer that of the smoke is. */
const CELLS = 22_000;
const FINER = 3;
/** Steps towards the pressure in a frame; the last frame's is where they begin. */
const PRESSINGS = 10;
const WISH_FONT = '600 96px ui-rounded, "Trebuchet MS", system-ui, sans-serif';
/** Half of a line's height, at most. */
const WISH_LINE = 0.05;
/** Longest step; a longer frame makes two of them. */
const LONGEST = 1 / 30;

/** What acts on the air during a frame. Heights of the picture, from its lower left corner; seconds. */
export interface Stirring {
  seconds: number;
  clock: number;
  /** x, y, width, strength of each: four numbers a source */
  heats: Float32Array;
  wicks: Float32Array;
  count: number;
  breath: number;
  breathHeight: number;
  hand: readonly [x: number, y: number, speedX: number, speedY: number];
  /** what smoke is to say now, '' nothing; and where its middle is */
  wish: string;
  wishAt: readonly [x: number, y: number];
}

/** A pair of pictures: one is read while the other is written. */
class Pair {
  now: Target;
  private next: Target;

  constructor(gl: WebGL2RenderingContext) {
    this.now = new Target(gl, { range: true });
    this.next = new Target(gl, { range: true });
  }

  resize(width: number, height: number): void {
    this.now.resize(width, height);
    this.next.resize(width, height);
  }

  clear(gl: WebGL2RenderingContext): void {
    gl.clearColor(0, 0, 0, 0);
    for (const target of [this.now, this.next]) {
      target.begin();
      gl.clear(gl.COLOR_BUFFER_BIT);
    }
  }

  /** Where the next picture is written; call turn() afterwards. */
  begin(): void {
    this.next.begin();
  }

  turn(): void {
    [this.now, this.next] = [this.next, this.now];
  }

  dispose(): void {
    this.now.dispose();
    this.next.dispose();
  }
}

export class Air {
  private readonly flow: Pair;
  private readonly pressure: Pair;
  private readonly smoke: Pair;
  readonly programs: Record<'carry' | 'press' | 'free' | 'soot' | 'smoke', Program>;
  private aspect = 1;
  private readonly words: Words;

  constructor(
    private readonly gl: WebGL2RenderingContext,
    private readonly quad: Quad,
  ) {
    this.flow = new Pair(gl);
    this.pressure = new Pair(gl);
    this.smoke = new Pair(gl);
    this.words = new Words(gl);
    const made = (fragment: string): Program => new Program(gl, wholeVertex, noise + fluid + fragment);
    this.programs = {
      carry: made(carryFragment),
      press: made(pressFragment),
      free: made(freeFragment),
      soot: made(sootFragment),
      smoke: made(smokeFragment),
    };
  }

  /** The flow, with heat in its third number. */
  get state(): Target {
    return this.flow.now;
  }

  /** Lets time pass in a picture of that shape. */
  update(aspect: number, stirring: Stirring): void {
    this.fit(aspect);
    const steps = stirring.seconds > LONGEST ? 2 : 1;
    const seconds = Math.min(LONGEST, stirring.seconds / steps);
    if (seconds <= 0) return;
    for (let step = 0; step < steps; ++step) this.step(seconds, stirring);
  }

  /** Draws the smoke over what is there. `lamps`: as sources, x, y, reach, light. */
  draw(lamps: Float32Array, count: number, moon: number): void {
    const { width, height } = this.smoke.now;
    this.smoke.now.bindTexture(0);
    this.set('smoke', 0)
      .setInteger('uSmoke', 0)
      .setInteger('uCount', count)
      .setVectors4('uLamps', lamps)
      .set('uGrain', 1.5 / width, 1.5 / height)
      .set('uMoon', moon);
    this.quad.draw();
  }

  dispose(): void {
    for (const pair of [this.flow, this.pressure, this.smoke]) pair.dispose();
    this.words.dispose();
    for (const program of Object.values(this.programs)) program.dispose();
  }

  /** Square cells, about as many in every shape of picture. */
  private fit(aspect: number): void {
    this.aspect = aspect;
    // A picture that is only drawn coarser differs by its rounding: the smoke in it stays.
    const there = this.flow.now;
    if (Math.abs((aspect * there.height) / there.width - 1) < 0.02) return;
    const height = Math.round(Math.sqrt(CELLS / aspect));
    const width = Math.round(height * aspect);
    this.flow.resize(width, height);
    this.pressure.resize(width, height);
    this.smoke.resize(FINER * width, FINER * height);
    for (const pair of [this.flow, this.pressure, this.smoke]) pair.clear(this.gl);
  }

  private set(name: keyof Air['programs'], seconds: number): Program {
    const { width, height } = this.flow.now;
    return this.programs[name]
      .use()
      .set('uCell', 1 / width, 1 / height)
      .set('uAspect', this.aspect)
      .set('uSeconds', seconds);
  }

  private step(seconds: number, stirring: Stirring): void {
    const { flow, pressure, smoke, quad } = this;
    flow.now.bindTexture(0);
    this.set('carry', seconds)
      .setInteger('uFlow', 0)
      .setInteger('uCount', stirring.count)
      .setVectors4('uHeats', stirring.heats)
      .set('uHand', ...stirring.hand)
      .set('uHandReach', 0.05)
      .set('uBreath', stirring.breath, stirring.breathHeight)
      .set('uClock', stirring.clock);
    flow.begin();
    quad.draw();
    flow.turn();
    flow.now.bindTexture(0);
    this.set('press', seconds).setInteger('uFlow', 0).setInteger('uPressure', 1);
    for (let k = 0; k < PRESSINGS; ++k) {
      pressure.now.bindTexture(1);
      pressure.begin();
      quad.draw();
      pressure.turn();
    }
    pressure.now.bindTexture(1);
    this.set('free', seconds).setInteger('uFlow', 0).setInteger('uPressure', 1);
    flow.begin();
    quad.draw();
    flow.turn();
    flow.now.bindTexture(0);
    smoke.now.bindTexture(1);
    const { wish, wishAt } = stirring;
    const shape = this.words.write(wish, WISH_FONT, this.aspect < 1 ? 11 : 17, 2);
    const half = Math.min(0.42 * this.aspect, WISH_LINE * this.words.lines * shape);
    this.set('soot', seconds)
      .setInteger('uWish', 2)
      .set('uWishBox', ...wishAt, half, wish === '' ? 0 : half / shape)
      .setInteger('uFlow', 0)
      .setInteger('uSmoke', 1)
      .setInteger('uCount', stirring.count)
      .setVectors4('uWicks', stirring.wicks);
    smoke.begin();
    quad.draw();
    smoke.turn();
  }
}
