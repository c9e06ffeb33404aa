// Air in the picture plane: heat rises, breath and hand stir it, and it carries smoke. A fluid on a coarse grid, with smoke on a finer one.

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

/** Number of cells of the air's grid, and refinement of the smoke's grid. */
const CELLS = 22_000;
const FINER = 3;
/** Jacobi iterations of the pressure per step, starting from the last step's pressure. */
const PRESSINGS = 10;
const WISH_FONT = '600 96px ui-rounded, "Trebuchet MS", system-ui, sans-serif';
/** Maximum half height of a line of smoke writing, picture heights. */
const WISH_LINE = 0.05;
/** Maximum step in seconds; longer frames take two steps. */
const LONGEST = 1 / 30;

/** Forces on the air during a frame. Units: picture heights from its lower left corner; seconds. */
export interface Stirring {
  seconds: number;
  clock: number;
  /** x, y, width and strength of each source of heat, and of each source of smoke; `count` sources each */
  heats: Float32Array;
  wicks: Float32Array;
  count: number;
  breath: number;
  breathHeight: number;
  hand: readonly [x: number, y: number, speedX: number, speedY: number];
  /** text for smoke to write now ('' for none), and its centre */
  wish: string;
  wishAt: readonly [x: number, y: number];
}

/** A pair of textures: one is read while the other is written. */
class Pair {
  now: Target;
  private next: Target;

  constructor(private readonly gl: WebGL2RenderingContext) {
    this.now = new Target(gl, { range: true });
    this.next = new Target(gl, { range: true });
  }

  /** Resizes and clears both textures. */
  resize(width: number, height: number): void {
    const { gl } = this;
    gl.clearColor(0, 0, 0, 0);
    for (const target of [this.now, this.next]) {
      target.resize(width, height);
      target.begin();
      gl.clear(gl.COLOR_BUFFER_BIT);
    }
  }

  /** Computes the next state by the program in use. */
  pass(quad: Quad): void {
    this.next.begin();
    quad.draw();
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

  constructor(gl: WebGL2RenderingContext, private readonly quad: Quad) {
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

  /** Velocity field, with heat in its third component. */
  get state(): Target {
    return this.flow.now;
  }

  /** Advances the air by `stirring.seconds` in a picture of this aspect ratio. */
  update(aspect: number, stirring: Stirring): void {
    this.fit(aspect);
    const steps = stirring.seconds > LONGEST ? 2 : 1;
    const seconds = Math.min(LONGEST, stirring.seconds / steps);
    if (seconds <= 0) return;
    for (let step = 0; step < steps; ++step) this.step(seconds, stirring);
  }

  /** Draws the smoke over the current target. `lamps`: x, y, reach and light of each. */
  draw(lamps: Float32Array, count: number, moon: number): void {
    const { width, height } = this.smoke.now;
    this.smoke.now.bindTexture(0);
    this.set('smoke', 0)
      .setInteger('uSmoke', 0)
      .setInteger('uCount', count)
      .setVectors('uLamps', 4, lamps)
      .set('uGrain', 1.5 / width, 1.5 / height)
      .set('uMoon', moon);
    this.quad.draw();
  }

  dispose(): void {
    for (const one of [this.flow, this.pressure, this.smoke, this.words, ...Object.values(this.programs)]) one.dispose();
  }

  /** Resizes the grids to an aspect ratio, with about CELLS square cells for the air. */
  private fit(aspect: number): void {
    this.aspect = aspect;
    // Resizing clears the smoke, so the grid stays if the aspect ratio differs by less than 2 %, as by rounding.
    const there = this.flow.now;
    if (Math.abs((aspect * there.height) / there.width - 1) < 0.02) return;
    const height = Math.round(Math.sqrt(CELLS / aspect));
    const width = Math.round(height * aspect);
    this.flow.resize(width, height);
    this.pressure.resize(width, height);
    this.smoke.resize(FINER * width, FINER * height);
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
      .setVectors('uHeats', 4, stirring.heats)
      .set('uHand', ...stirring.hand)
      .set('uHandReach', 0.05)
      .set('uBreath', stirring.breath, stirring.breathHeight)
      .set('uClock', stirring.clock);
    flow.pass(quad);
    flow.now.bindTexture(0);
    this.set('press', seconds).setInteger('uFlow', 0).setInteger('uPressure', 1);
    for (let k = 0; k < PRESSINGS; ++k) {
      pressure.now.bindTexture(1);
      pressure.pass(quad);
    }
    pressure.now.bindTexture(1);
    this.set('free', seconds).setInteger('uFlow', 0).setInteger('uPressure', 1);
    flow.pass(quad);
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
      .setVectors('uWicks', 4, stirring.wicks);
    smoke.pass(quad);
  }
}
