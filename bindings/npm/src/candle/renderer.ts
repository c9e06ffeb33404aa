// Draws the candle's room with WebGL2: light is accumulated in an HDR picture and tone-mapped onto the canvas.

import { drawToCanvas, hasRange, Program, Quad, Target, warming } from '../stage/gl.js';
import type { SceneLook } from '../stage/scene.js';
import type { After } from './after.js';
import type { Stirring } from './air.js';
import type { Candle } from './candle.js';
import type { FlameShape } from './flame_shape.js';
import type { RoomView, Setting, Stand } from './room.js';
import { flameFoot, MAX_LAMPS } from './room.js';
import type { Lettering } from './lettering.js';
import type { Match } from './match.js';
import boardVertex from './shaders/board.vert.js';
import candleFragment from './shaders/candle.frag.js';
import developFragment from './shaders/develop.frag.js';
import flameFragment from './shaders/flame.frag.js';
import lightFragment from './shaders/light.frag.js';
import noise from './shaders/noise.glsl.js';
import room from './shaders/room.glsl.js';
import surfaceFragment from './shaders/surface.frag.js';
import table from './shaders/table.glsl.js';
import wholeVertex from './shaders/whole.vert.js';

/** Maximum number of lights: candles, match, one to spare. */
const MAX_LIGHTS = MAX_LAMPS + 2;
/** Share of the light that becomes glare. */
const GLARING = 0.13;
/** Displacement of the background by heat, in picture sizes. */
const SHIMMER = 0.0035;
/** Minimum width of rising air, picture heights: plumes narrower than two grid cells do not rise. */
const MIN_PLUME = 0.02;
/** Exposure in lit and dark rooms, and adaptation times in seconds to more and to less light. */
const EXPOSURES = { lit: 1, dark: 8, brighter: 0.25, darker: 0.9 };
/** Milliseconds after which a part that could not be loaded is tried again. */
const AGAIN_MS = 3000;

interface CandlePicture {
  setting: Setting;
  candles: Candle[];
  match: Match;
  /** seconds since the last picture, and since the start */
  seconds: number;
  clock: number;
  /** sources of moving air: breath (1 is strong); pointer in pixels and pixels a second */
  breath: number;
  hand: { x: number; y: number; speedX: number; speedY: number; present: boolean };
  /** rotation of the eye round the table, radians */
  turn: number;
  /** name on the cake, and text written by smoke so far ('' for none) */
  name: string;
  wish: string;
}

/** Programs that draw the room and its contents. */
interface Room { surface: Program; light: Program; warm: () => boolean }

type Lamp = Record<'x' | 'y' | 'z' | 'light', number>;

export class CandleRenderer {
  private readonly quad: Quad;
  private readonly surface: Target;
  private readonly picture: Target;
  private readonly programs: Record<'candle' | 'flame' | 'develop', Program>;
  /** programs per setting: a table without a cake, and with a cake once loaded */
  private readonly rooms: Partial<Record<'table' | 'cake', Room>> = {};
  private readonly warm: () => boolean;
  private readonly lights = new Float32Array(4 * MAX_LIGHTS);
  private readonly halos = new Float32Array(4 * MAX_LIGHTS);
  private readonly spread = new Float32Array(MAX_LIGHTS);
  private readonly standNumbers = new Float32Array(4 * MAX_LIGHTS);
  private readonly sticks = new Float32Array(4 * MAX_LAMPS);
  private readonly heats = new Float32Array(4 * MAX_LIGHTS);
  private readonly wicks = new Float32Array(4 * MAX_LIGHTS);
  private readonly smokeLamps = new Float32Array(4 * MAX_LIGHTS);
  private readonly lamps: Lamp[] = [];
  private surfaceOf = '';
  private after: After | null = null;
  private bringing = false;
  /** parts for a cake only: its name and digit candles */
  private lettering: Lettering | null = null;
  private exposure = EXPOSURES.lit;
  private gone = false;

  constructor(private readonly gl: WebGL2RenderingContext) {
    this.quad = new Quad(gl);
    this.surface = new Target(gl, { range: false });
    this.picture = new Target(gl, { range: true });
    this.programs = {
      candle: new Program(gl, boardVertex, noise + candleFragment),
      flame: new Program(gl, boardVertex, noise + flameFragment),
      develop: new Program(gl, wholeVertex, noise + developFragment),
    };
    this.warm = warming(Object.values(this.programs));
  }

  /** Draws a picture of view.width × view.height pixels. Returns false while parts are still loading. */
  draw(view: RoomView, shown: CandlePicture, look: SceneLook): boolean {
    const { gl } = this;
    const room = this.room(shown.setting);
    if (room === null) return false;
    this.picture.resize(view.width, view.height);
    gl.disable(gl.DEPTH_TEST);
    gl.disable(gl.BLEND);
    this.gatherLamps(view, shown);
    this.adapt(shown);
    const after = this.after !== null && !look.plain && this.after.warm() ? this.after : null;
    if (after !== null) after.air.update(view.width / view.height, this.stirring(view, shown));
    if (!look.clear) this.drawSurface(room.surface, view, shown);
    const lies = after !== null && shown.match.lying;
    this.picture.begin();
    if (look.clear) {
      gl.clearColor(0, 0, 0, 0);
      gl.clear(gl.COLOR_BUFFER_BIT);
    } else this.drawLight(room.light, view, shown, lies);
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
    for (const candle of shown.candles) {
      if (candle.stand.figure === null) this.drawCandle(view, candle, shown);
      else this.drawFigure(view, candle);
      this.drawFlame(view, candle, candle.stand, flameFoot(candle.stand), shown.clock);
    }
    if (after !== null) this.drawLate(after, view, shown, look);
    gl.disable(gl.BLEND);
    this.develop(after, look, shown);
    if (this.after === null && hasRange(this.gl)) this.bring(() => import('./after.js'), ({ afterOf }) => (this.after = afterOf(this.gl, this.quad)));
    return true;
  }

  dispose(): void {
    this.gone = true;
    const rooms = Object.values(this.rooms).flatMap(({ surface, light }) => [surface, light]);
    for (const one of [this.quad, this.surface, this.picture, this.after, this.lettering, ...Object.values(this.programs), ...rooms]) one?.dispose();
  }

  /** Programs for a setting; null while those of a cake are loading. */
  private room(setting: Setting): Room | null {
    if (!this.warm()) return null;
    const name = setting.cake === null ? 'table' : 'cake';
    const there = this.rooms[name];
    if (there !== undefined) return there.warm() ? there : null;
    if (name === 'table') this.furnish(name, table);
    else
      this.bring(() => import('./cake.js'), ({ cake, Lettering }) => {
        this.lettering = new Lettering(this.gl);
        this.furnish('cake', cake);
      });
    return null;
  }

  private furnish(name: 'table' | 'cake', onIt: string): void {
    const source = noise + room + onIt;
    const surface = new Program(this.gl, wholeVertex, source + surfaceFragment);
    const light = new Program(this.gl, wholeVertex, source + lightFragment);
    this.rooms[name] = { surface, light, warm: warming([surface, light]) };
  }

  /** Loads a part that the first picture does not need, one at a time; a while after a failure again. */
  private bring<T>(part: () => Promise<T>, use: (part: T) => void): void {
    if (this.bringing) return;
    this.bringing = true;
    const come = (found: T): void => {
      this.bringing = false;
      if (!this.gone && !this.gl.isContextLost()) use(found);
    };
    part().then(come, () => setTimeout(() => (this.bringing = false), AGAIN_MS));
  }

  /** Adapts the exposure to the amount of light. */
  private adapt({ seconds }: CandlePicture): void {
    const light = this.lamps.reduce((sum, lamp) => sum + lamp.light, 0);
    const dim = Math.min(1, light / 0.35);
    const goal = (EXPOSURES.dark + (EXPOSURES.lit - EXPOSURES.dark) * dim) / (1 + 0.26 * Math.max(0, light - 1));
    const within = goal < this.exposure ? EXPOSURES.brighter : EXPOSURES.darker;
    this.exposure *= (goal / this.exposure) ** (1 - Math.exp(-seconds / within));
  }

  private setRoom(program: Program, view: RoomView, { setting, turn }: CandlePicture): Program {
    const cake = setting.cake;
    return program
      .use()
      .set('uView', view.middle, view.horizon, view.scale, view.distance)
      .set('uEye', view.eye)
      .set('uTurn', turn)
      .set('uCake', cake?.radius ?? 0, cake?.height ?? 0, cake?.x ?? 0);
  }

  private drawSurface(program: Program, view: RoomView, shown: CandlePicture): void {
    const { setting, name, turn } = shown;
    const of = [view.width, view.height, view.scale, view.horizon, setting.cake?.radius, setting.cake?.x, name, turn].join();
    this.surface.resize(view.width, view.height);
    if (of === this.surfaceOf) return;
    this.surfaceOf = of;
    const plaque = setting.cake === null ? [0, 0] : (this.lettering?.name(name, 0) ?? [0, 0]);
    this.surface.begin();
    this.setRoom(program, view, shown).setInteger('uName', 0).set('uPlaque', ...plaque);
    this.quad.draw();
  }

  private gatherLamps(view: RoomView, shown: CandlePicture): void {
    this.lamps.length = 0;
    const groups: Candle[][] = [];
    for (const candle of shown.candles) (groups[candle.stand.lamp] ??= []).push(candle);
    for (const group of groups) this.addLamp(view, group.map(({ stand, shape, nearer }) => ({ ...stand, z: stand.z + stand.unit * nearer, y: flameFoot(stand), shape })), group.length === 1 && group[0]?.stand.figure === null ? group[0].stand : null);
    const { match } = shown;
    if (match.burning) this.addLamp(view, [match], null);
  }

  /** Adds one light for adjacent flames. `stand`: that of a lone flame, which casts a shadow; null: none. */
  private addLamp(view: RoomView, flames: readonly { x: number; y: number; z: number; unit: number; shape: FlameShape }[], stand: Stand | null): void {
    const k = this.lamps.length;
    const lamp: Lamp = { x: 0, y: 0, z: 0, light: 0 };
    for (const { x, y, z, unit, shape } of flames) {
      lamp.x += (x + unit * shape.middleX) / flames.length;
      lamp.y += (y + unit * Math.max(0.2, shape.middleY)) / flames.length;
      lamp.z += z / flames.length;
      // Each of many small flames on a cake is dimmer than a lone one.
      lamp.light += shape.empty ? 0 : (shape.light * unit ** 1.3) / flames.length ** 0.6;
    }
    this.lamps.push(lamp);
    this.lights.set([lamp.x, lamp.y, lamp.z, lamp.light], 4 * k);
    // The glow extends from the first flame's base to the last one's tip.
    const [first, last] = [flames[0]!, flames.at(-1)!];
    const base = [view.pixelX(first.x, first.z), view.pixelY(first.y + 0.25 * first.unit * first.shape.tipY, first.z)];
    const tip = [view.pixelX(last.x + 0.8 * last.unit * last.shape.tipX, last.z), view.pixelY(last.y + 0.72 * last.unit * last.shape.tipY, last.z)];
    this.halos.set([...base, ...tip], 4 * k);
    this.spread[k] = view.scale * view.nearness(lamp.z) * Math.max(0.3, first.unit);
    this.standNumbers.set(stand === null ? [0, 0, 0.01, 0] : [stand.x, stand.z, stand.radius, stand.height], 4 * k);
  }

  /** `lies`: the match is drawn lying on the table. */
  private drawLight(program: Program, view: RoomView, shown: CandlePicture, lies: boolean): void {
    this.surface.bindTexture(0);
    const { match } = shown;
    const first = shown.candles[0]?.stand;
    this.setRoom(program, view, shown)
      .setInteger('uSurface', 0)
      .setInteger('uCount', this.lamps.length)
      .set('uGround', first?.ground ?? 0)
      .set('uMatch', view.pixelX(match.x, match.z), view.pixelY(match.y, match.z), view.pixelX(match.x + 0.57 * match.unit, match.z), view.pixelY(match.y - 0.88 * match.unit, match.z))
      .set('uMatchThick', lies ? 0.055 * match.unit * view.scale * view.nearness(match.z) : 0)
      .set('uFoot', first === undefined || first.saucer === 0 ? 1 : first.saucer / first.radius)
      .setVectors('uLights', 4, this.lights)
      .setVectors('uHalos', 4, this.halos)
      .setVectors('uStands', 4, this.standNumbers)
      .setVectors('uSpread', 1, this.spread);
    if (shown.setting.cake !== null) {
      this.sticks.fill(0);
      // Shadow streaks of more candles would merge, so they are left out.
      if (shown.candles.length <= MAX_LAMPS) shown.candles.forEach(({ stand }, k) => stand.figure === null && this.sticks.set([stand.x, stand.z, stand.radius, stand.height], 4 * k));
      program.setVectors('uSticks', 4, this.sticks);
    }
    this.quad.draw();
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

  /** Light of the other flames on a candle: from the left, right and behind, and overall. */
  private lightFromOthers(candle: Pick<Candle, 'stand' | 'shape' | 'nearer'>): [number, number, number, number] {
    const { stand, shape } = candle;
    const sum: [number, number, number, number] = [0, 0, 0, 0];
    const own = stand.x + stand.unit * shape.middleX;
    for (const lamp of this.lamps) {
      if (Math.abs(lamp.x - own) < 1e-6 && Math.abs(lamp.z - stand.z - stand.unit * candle.nearer) < 1e-6) continue;
      const dx = lamp.x - stand.x;
      const dz = lamp.z - stand.z;
      const flat2 = Math.max(0.1, dx * dx + dz * dz);
      const light = (0.9 * lamp.light) / (0.2 + flat2);
      const flat = Math.sqrt(Math.max(1e-6, flat2));
      sum[0] += light * Math.max(0, -dx / flat);
      sum[1] += light * Math.max(0, dx / flat);
      sum[2] += light * Math.max(0, -dz / flat);
      sum[3] += light;
    }
    return sum;
  }

  /** Sets a candle's or digit's uniforms. `box`: bounds from its upper end; `nearer`: of its own light, left out. */
  private setWax(program: Program, view: RoomView, { stand, shape, ember }: Candle, nearer: number, box: number[]): Program {
    return this.setBoard(program, view, stand.x, stand.ground + stand.height, stand.z, stand.unit, box)
      .set('uRadius', stand.radius / stand.unit)
      .set('uHeight', stand.height / stand.unit)
      .set('uLight', shape.empty ? 0 : shape.light)
      .set('uEmber', ember)
      .set('uWax', ...stand.wax)
      .set('uOthers', ...this.lightFromOthers({ stand, shape, nearer }));
  }

  private drawCandle(view: RoomView, candle: Candle, { clock, turn }: CandlePicture): void {
    const { stand, shape } = candle;
    const radius = stand.radius / stand.unit;
    const height = stand.height / stand.unit;
    const upper = view.flatness(stand.ground + stand.height, stand.z);
    const lower = view.flatness(stand.ground, stand.z);
    // Without a table each candle has its own dish.
    const saucer = (view.clear && stand.saucer === 0 ? 2.7 * stand.radius : stand.saucer) / stand.unit;
    const wide = Math.max(radius, saucer) + 0.12;
    const box = [-wide, -height - Math.max(radius, saucer) * lower - 0.05, wide, 0.34];
    this.setWax(this.programs.candle, view, candle, candle.nearer, box)
      .set('uSaucer', saucer)
      .set('uFlat', upper, lower)
      .set('uLean', shape.middleX, shape.middleY)
      .set('uSeed', stand.seed)
      .set('uStripe', stand.striped ? 1 : 0)
      .set('uClock', clock)
      .set('uTurn', turn);
    this.quad.draw();
  }

  private drawFigure(view: RoomView, candle: Candle): void {
    const { lettering } = this;
    if (lettering === null) return;
    const { stand } = candle;
    const height = stand.height / stand.unit;
    const points = lettering.figure(stand.figure ?? '', height);
    this.setWax(lettering.program, view, candle, 0, [-height, -height - 0.1, height, 0.3])
      .setVectors('uOutline', 3, points)
      .setInteger('uPoints', points.length / 3);
    this.quad.draw();
  }

  private drawFlame(
    view: RoomView,
    { shape, size }: { shape: FlameShape; size: number },
    at: { x: number; z: number; unit: number; seed?: number },
    foot: number,
    clock: number,
  ): void {
    if (shape.empty || size <= 0) return;
    const margin = 0.07;
    const box = [shape.left - margin, shape.bottom - margin, shape.right + margin, shape.top + margin];
    this.setBoard(this.programs.flame, view, at.x, foot, at.z, at.unit, box)
      .setVectors('uOutline', 3, shape.points)
      .setInteger('uPoints', shape.count)
      .set('uBright', 0.35 + 0.65 * size)
      .set('uSoot', Math.min(1, 0.25 + shape.top))
      .set('uWidth', shape.width)
      .set('uClock', clock)
      .set('uSeed', 7.3 * (at.seed ?? 0));
    this.quad.draw();
  }

  private drawMatch(program: Program, view: RoomView, { match, clock }: CandlePicture): void {
    this.setBoard(program, view, match.x, match.y, match.z, match.unit, [-0.5, -1.05, 0.75, 0.5])
      .set('uBurnt', match.burning ? match.size : 0)
      .set('uFlare', match.flare)
      .set('uRoom', this.lightAt(match.x, match.y, match.z));
    this.quad.draw();
    if (match.burning) this.drawFlame(view, match, match, match.y, clock);
  }

  /** Total light of all flames at a place in the room. */
  private lightAt(x: number, y: number, z: number): number {
    let sum = 0;
    for (const lamp of this.lamps) {
      const far2 = (lamp.x - x) ** 2 + (lamp.y - y) ** 2 + (lamp.z - z) ** 2;
      sum += lamp.light / (0.8 + far2);
    }
    return Math.min(1.2, 1.6 * sum);
  }

  /** What stirs the air: places, widths and speeds in picture heights (a second); strengths without unit. */
  private stirring(view: RoomView, { candles, match, seconds, clock, breath, hand, wish }: CandlePicture): Stirring {
    this.heats.fill(0);
    this.wicks.fill(0);
    const tall = view.height;
    let count = 0;
    const add = (x: number, y: number, z: number, unit: number, shape: FlameShape, lit: boolean, smoking: number): void => {
      const scale = (view.scale * view.nearness(z) * unit) / tall;
      const at = [(view.pixelX(x, z) + (lit ? 0.6 * shape.tipX * scale * tall : 0)) / tall, view.pixelY(y, z) / tall + (lit ? 0.8 * shape.tipY * scale : 0)];
      this.heats.set([...at, Math.max(MIN_PLUME, (lit ? 0.16 : 0.10) * scale), lit ? 9 * shape.light : 7 * smoking], 4 * count);
      this.wicks.set([...at, 0.015 * scale + 0.001, 24 * smoking], 4 * count);
      count += 1;
    };
    // With many candles, one source per light.
    const apart = Math.ceil(candles.length / MAX_LAMPS);
    for (const [k, { stand, shape, smoking }] of candles.entries()) {
      if (k % apart !== 0) continue;
      const lit = !shape.empty && shape.light > 0;
      add(stand.x + 0.03 * stand.unit, stand.ground + stand.height + 0.17 * stand.unit, stand.z, stand.unit, shape, lit, smoking);
    }
    add(match.x, match.y, match.z, match.unit, match.shape, match.burning, match.smoking);
    const first = candles[0]?.stand;
    const blown = first === undefined ? 0.5 : view.pixelY(first.ground + first.height + 0.3 * first.unit, first.z) / tall;
    return {
      seconds,
      clock,
      heats: this.heats,
      wicks: this.wicks,
      count,
      breath: Math.max(-1, Math.min(1, 0.6 * breath)),
      breathHeight: blown,
      hand: hand.present ? [hand.x / tall, hand.y / tall, hand.speedX / tall, hand.speedY / tall] : [0, 0, 0, 0],
      wish,
      // Above the smoking wicks, as far as the picture has room.
      wishAt: [view.width / 2 / tall, Math.min(0.7, blown + 0.2)],
    };
  }

  private drawLate(after: After, view: RoomView, shown: CandlePicture, look: SceneLook): void {
    if (!look.clear || shown.match.burning) this.drawMatch(after.match, view, shown);
    const tall = view.height;
    this.smokeLamps.fill(0);
    this.lamps.forEach((lamp, k) => {
      const reach = (view.scale * view.nearness(lamp.z)) / tall;
      this.smokeLamps.set([view.pixelX(lamp.x, lamp.z) / tall, view.pixelY(lamp.y, lamp.z) / tall, 0.9 * reach, 0.55 * lamp.light], 4 * k);
    });
    let count = this.lamps.length;
    for (const { stand, ember, shape } of shown.candles) {
      if (!shape.empty || ember < 0.02 || count >= MAX_LIGHTS) continue;
      const scale = (view.scale * view.nearness(stand.z) * stand.unit) / tall;
      const at = [view.pixelX(stand.x + 0.03 * stand.unit, stand.z) / tall, view.pixelY(flameFoot(stand) + 0.08 * stand.unit, stand.z) / tall];
      this.smokeLamps.set([...at, 0.10 * scale, 0.5 * ember], 4 * count);
      count += 1;
    }
    after.air.draw(this.smokeLamps, count, look.clear ? 0.2 : 0.055);
  }

  private develop(after: After | null, look: SceneLook, { clock }: CandlePicture): void {
    const glare = after === null || look.clear ? null : after.glare.of(this.picture);
    drawToCanvas(this.gl);
    this.picture.bindTexture(0);
    (glare ?? this.picture).bindTexture(1);
    (after?.air.state ?? this.picture).bindTexture(2);
    this.programs.develop
      .use()
      .setInteger('uPicture', 0)
      .setInteger('uGlare', 1)
      .setInteger('uAir', 2)
      .set('uSize', this.picture.width, this.picture.height)
      .set('uFade', look.fade)
      .set('uExposure', this.exposure)
      .set('uGlaring', glare === null ? 0 : GLARING)
      .set('uShimmer', after === null ? 0 : SHIMMER)
      .set('uClock', clock)
      .set('uClear', look.clear ? 1 : 0);
    this.quad.draw();
  }
}
