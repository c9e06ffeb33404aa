// The candle scene: a live flame model in a dark room; and the cake, several flames in one wind.

import { WispError, type Bank, type FlameState, type Instance, type Model } from '../index.js';
import type { Acting, Air, Pointer, Reading, Scene, SceneLook, SceneSettings } from '../stage/scene.js';
import { Candle } from './candle.js';
import type { Lender } from './lender.js';
import { Match } from './match.js';
import { Orbit } from './orbit.js';
import { CandleRenderer } from './renderer.js';
import { flameFoot, MAX_CANDLES, RoomView, settingFor, type Setting, type Stand } from './room.js';
import { shelter, WindDelay } from '../air/delay.js';

/** Number of points of a flame's outline, which looks smooth up to a flame height of 500 pixels. */
const OUTLINE_POINTS = 40;
const NANOSECONDS = 1e9;
/** Seconds after the last extinction at which smoke writing starts and ends. */
const WISH = { from: 0.9, to: 5 };

/** Height of a candle's wick in the room. */
const wickY = ({ ground, height, unit }: Stand): number => ground + height + 0.1 * unit;

/** The model as a body of revolution; null unless it is a flame of symmetric and antisymmetric components. */
function roundOf(model: Model): Model | null {
  try {
    return model.inTheRound();
  } catch (error) {
    if (error instanceof WispError) return null;
    throw error;
  }
}

export class CandleScene implements Scene {
  private readonly bank: Bank;
  readonly answerName = 'tip, sideways';
  private readonly view = new RoomView();
  private readonly match = new Match();
  /** winds to the right and away from the eye, delayed by distance */
  private readonly across = new WindDelay();
  private readonly away = new WindDelay();
  private setting: Setting = settingFor(1);
  private candles: Candle[] = [];
  private renderer: CandleRenderer | null = null;
  /** seconds since the last picture, and since the start */
  private passed = 0;
  private clock = 0;
  private breath = 0;
  private hand: Pointer = { x: 0, y: 0, fromX: 0, fromY: 0, speedX: 0, speedY: 0, present: false };
  private dragged: { offset: number; goal: number } | null = null;
  /** body model played in place of the outline; null: only one view exists */
  private readonly round: Model | null;
  readonly orbit = new Orbit();
  private settings: SceneSettings;
  private lender: Lender | null = null;
  private disposed = false;

  constructor(private readonly model: Model, settings: SceneSettings) {
    this.settings = { ...settings };
    this.round = roundOf(model);
    this.bank = (this.round ?? model).bank({ capacity: MAX_CANDLES + 1, polylinePoints: OUTLINE_POINTS, seed: settings.seed });
    this.bank.setNoise(settings.noise);
    this.seat();
  }

  /** Borrows the wind response of another flame model, once; that model may be freed afterwards. */
  async borrow(from: Model): Promise<void> {
    const { Lender } = await import('./lender.js');
    if (this.disposed || this.lender !== null) return;
    this.lender = new Lender(from, MAX_CANDLES + 1, OUTLINE_POINTS);
    for (const candle of this.candles) candle.lent = this.lender.bank.spawn();
  }

  update(acting: Acting): void {
    const { seconds } = acting;
    this.passed += seconds;
    this.clock += seconds;
    this.hand = acting.pointer;
    this.followPointer(acting);
    this.match.update(seconds);
    this.tendMatch();
    // A model with a single view is blown along one axis.
    const air = this.round === null ? { right: acting.breath, away: 0 } : acting.air;
    // Smoke moves in the picture plane only.
    this.breath = air.right + 0.5 * air.away;
    this.across.push(seconds, air.right);
    this.away.push(seconds, air.away);
    for (const candle of this.candles) this.blowOn(candle, acting, air);
    if (this.match.id !== null) this.setWind(this.match.id, Math.max(-1, Math.min(1, -0.16 * this.match.speedX)), 0);
    this.bank.advance(seconds * NANOSECONDS);
    this.lender?.bank.advance(seconds * NANOSECONDS);
    for (const candle of this.candles) this.showCandle(candle);
    this.showMatch(seconds);
  }

  reading(): Reading {
    const first = this.candles[this.candles.length - 1];
    // The microphone blows from the eye, so a body's tip leans away from the eye.
    return { wind: first?.wind ?? 0, answer: first?.shape.empty === false ? first.shape.tipX + first.tipAway : 0 };
  }

  attach(gl: WebGL2RenderingContext): void {
    this.renderer = new CandleRenderer(gl);
  }

  draw(width: number, height: number, look: SceneLook): boolean {
    const { view } = this;
    if (view.width !== width || view.height !== height || view.footer !== look.footer || view.clear !== look.clear) this.frame(width, height, look.footer, look.clear);
    if (this.renderer === null) return false;
    const { setting, candles, match, passed, clock, breath, hand } = this;
    const { name = '', wish = '' } = this.settings;
    const shown = { setting, candles, match, seconds: passed, clock, breath, hand, name, wish: this.wishing() ? wish : '', turn: this.orbit.azimuth };
    this.passed = 0;
    return this.renderer.draw(view, shown, look);
  }

  hover(x: number, y: number): 'none' | 'grab' {
    return this.overMatch(x, y) || this.candleAt(x, y) !== null ? 'grab' : 'none';
  }

  press(x: number, y: number): void {
    if (this.overMatch(x, y)) return this.match.take();
    const candle = this.candleAt(x, y);
    if (candle === null) {
      if (this.round !== null) this.orbit.grab(x);
      return;
    }
    const at = this.view.roomX(x, candle.stand.z);
    const held = this.setting.cake?.x ?? candle.stand.x;
    this.dragged = { offset: held - at, goal: held };
  }

  release(x: number, y: number, tap: boolean): void {
    if (this.match.held) return this.match.drop();
    this.dragged = null;
    this.orbit.letGo();
    if (!tap) return;
    const nearest = this.nearestOut(x, y);
    if (nearest !== null) this.relight(nearest);
  }

  /** Rotates the view round the setting; false where the model has a single view. */
  goRound(radians: number): boolean {
    if (this.round === null) return false;
    if (this.orbit.turnTo(this.orbit.azimuth + radians)) this.turn();
    return true;
  }

  act(): void {
    // `candle.lit` is as of the last picture; the bank's state is current.
    const out = this.candles.find((candle) => !candle.lit && !this.stateOf(candle).lit);
    if (out !== undefined) this.match.send(...this.wickOf(out));
  }

  apply(settings: SceneSettings): void {
    const before = this.settings;
    const reseat = settings.count !== before.count || settings.figures !== before.figures;
    this.settings = { ...settings };
    this.bank.setNoise(settings.noise);
    if (reseat) this.seat();
  }

  describe(): string {
    const { lit } = this.burning();
    const { figures = '', name = '' } = this.settings;
    if (this.setting.cake === null) return lit === 1 ? 'A candle burns in a dark room.' : 'The candle is out.';
    const what = figures === '' ? `${this.candles.length} candles` : `candles that say ${figures}`;
    return `A cake${name === '' ? '' : ` for ${name}`} with ${what}, ${lit} of them burning.`;
  }

  /** Whether the smoke of the last extinction still shows the wish. */
  private wishing(): boolean {
    const latest = Math.min(...this.candles.map(({ sinceOut }) => sinceOut));
    return this.burning().lit === 0 && latest > WISH.from && latest < WISH.to;
  }

  /** Number of burning candles, and of all candles. */
  burning(): { lit: number; of: number } {
    return { lit: this.candles.filter((candle) => candle.lit).length, of: this.candles.length };
  }

  get firstX(): number {
    return this.candles[0]?.stand.x ?? 0;
  }

  /** Pixel positions of the first wick and of the match's head. */
  places(): { wick: readonly [number, number]; match: readonly [number, number] } {
    const { view, match } = this;
    const { stand } = this.candles[0] as Candle;
    return { wick: [view.pixelX(stand.x, stand.z), view.pixelY(wickY(stand), stand.z)], match: [view.pixelX(match.x, match.z), view.pixelY(match.y, match.z)] };
  }

  get smoking(): boolean {
    return this.candles.some((candle) => candle.smoking > 0);
  }

  dispose(): void {
    this.disposed = true;
    this.renderer?.dispose();
    this.bank.free();
    this.round?.free();
    this.lender?.bank.free();
  }

  private frame(width: number, height: number, footer: number, clear: boolean): void {
    const cake = this.setting.cake !== null;
    this.view.frame(width, height, cake, footer, clear, (this.settings.figures ?? '') === '' ? 0 : 0.35);
    const z = cake ? 2.6 : 1.4;
    const edge = this.view.roomX(width, z);
    this.match.rest(Math.min(edge - 0.55, cake ? 2.3 : 1.35), z);
  }

  /** Replaces all candles by new ones, as the settings say. */
  private seat(): void {
    for (const { id, lent } of this.candles) {
      this.bank.end(id);
      if (lent !== null) this.lender?.bank.end(lent);
    }
    this.setting = settingFor(this.settings.count, this.settings.figures);
    this.candles = this.setting.stands.map((stand) => new Candle(stand, this.bank.spawn(BigInt(stand.seed))));
    if (this.lender !== null) for (const candle of this.candles) candle.lent = this.lender.bank.spawn();
    this.dragged = null;
    this.turn();
    this.frame(this.view.width, this.view.height, this.view.footer, this.view.clear);
  }

  private setWind(id: Instance, right: number, away: number, bank = this.bank): void {
    if (bank.inputs === 1) bank.setInstanceInputs(id, [right + away]);
    if (bank.inputs === 2) bank.setInstanceInputs(id, this.orbit.wind(right, away));
  }

  /** Rotates a cake's candles to the eye's view, except digits, which face the eye; sorts all from far to near. */
  private turn(): void {
    const { cake } = this.setting;
    for (const candle of this.candles) {
      if (cake === null || candle.stand.figure !== null) continue;
      const [right, near] = this.orbit.seen(...candle.seat);
      candle.put(cake.x + right, near);
    }
    this.candles.sort((a, b) => a.stand.z - b.stand.z);
  }

  private outlineOf(id: Instance, z: number, foot: number): Float32Array {
    return this.round === null ? this.bank.polyline(id) : this.orbit.see(this.bank.rings(id), this.view.flatness(foot, z));
  }

  private stateOf({ id, lent }: Candle): FlameState {
    return lent === null || this.lender === null ? this.bank.flameState(id) : this.lender.bank.flameState(lent);
  }

  private followPointer({ pointer, seconds }: Acting): void {
    if (this.match.held) {
      this.match.moveTo(this.view.roomX(pointer.x, this.match.z), this.view.roomY(pointer.y, this.match.z));
    }
    if (this.orbit.drag(pointer.x, pointer.speedX, this.view.width)) this.turn();
    if (this.dragged === null) return;
    const edge = this.view.roomX(this.view.width, 0) - 0.4;
    const goal = this.view.roomX(pointer.x, 0) + this.dragged.offset;
    this.dragged.goal = Math.max(-edge, Math.min(edge, goal));
    const held = this.setting.cake?.x ?? (this.candles[0] as Candle).stand.x;
    const way = (this.dragged.goal - held) * (1 - Math.exp(-18 * seconds));
    if (this.setting.cake !== null) this.setting.cake.x += way;
    for (const candle of this.candles) candle.stand.x += way;
  }

  /** Air at a candle of a cake: delayed by distance, weakened behind others. */
  private airAt({ stand }: Candle, cake: { x: number }): Air {
    const stands = this.candles.map((candle) => candle.stand);
    const right = this.across.at(stand.x - cake.x, stand.z);
    const away = this.away.at(-stand.z, stand.x - cake.x);
    return { right: right === 0 ? 0 : right * shelter(stand, stands, Math.sign(right), 0), away: away === 0 ? 0 : away * shelter(stand, stands, 0, -Math.sign(away)) };
  }

  private blowOn(candle: Candle, acting: Acting, air: Air): void {
    const { stand } = candle;
    const felt = this.setting.cake === null ? air : this.airAt(candle, this.setting.cake);
    candle.sheltered = Math.max(0, candle.sheltered - acting.seconds);
    const busy = this.match.held || this.dragged !== null || this.orbit.turning || candle.sheltered > 0;
    const near = this.view.scale * this.view.nearness(stand.z) * stand.unit;
    const flameX = this.view.pixelX(stand.x, stand.z);
    const flameY = this.view.pixelY(flameFoot(stand) + 0.4 * stand.unit, stand.z);
    candle.stroke.update(acting, busy, flameX, flameY, near);
    const right = felt.right + candle.stroke.wind.right + candle.motionWind(acting.seconds);
    const away = felt.away + candle.stroke.wind.away;
    candle.wind = right + away;
    this.setWind(candle.id, right, away);
    if (candle.lent !== null) this.setWind(candle.lent, right, away, this.lender?.bank);
  }

  private showCandle(candle: Candle): void {
    const state = this.stateOf(candle);
    const sinceOut = state.lit ? Infinity : Number(state.sinceOut) / NANOSECONDS;
    const own = this.outlineOf(candle.id, candle.stand.z, flameFoot(candle.stand));
    candle.tipAway = this.orbit.tipAway;
    candle.nearer = -this.orbit.middleAway;
    const outline = candle.lent === null || this.lender === null ? own : this.lender.lend(candle.lent, own, state);
    candle.show(outline, state.flameSize, sinceOut);
  }

  private tendMatch(): void {
    const { match } = this;
    if (match.wanted && match.id === null) {
      match.id = this.bank.spawn(BigInt(1000));
      match.flare = 1;
      if (this.model.facts.blowOut !== null) {
        this.bank.extinguish(match.id);
        this.bank.relight(match.id);
      }
    }
    if (!match.wanted && match.burning) {
      match.burning = false;
      match.sinceOut = 0.01;
      if (match.id !== null) this.bank.end(match.id);
      match.id = null;
    }
    match.burning = match.id !== null;
    if (!match.burning) return;
    for (const candle of this.candles) {
      if (candle.lit) continue;
      const [x, y] = this.wickOf(candle);
      if (Math.hypot(x - match.x, y - match.y) < 0.42 * Math.max(0.5, candle.stand.unit)) {
        this.relight(candle);
        // A match that no hand holds goes on to the next wick.
        if (!match.held) this.act();
      }
    }
  }

  private showMatch(seconds: number): void {
    const { match } = this;
    if (match.id !== null) {
      const state = this.bank.flameState(match.id);
      match.size = state.flameSize;
      match.shape.update(this.outlineOf(match.id, match.z, match.y), state.flameSize);
      match.sinceOut = Infinity;
    } else if (match.sinceOut < Infinity) {
      match.sinceOut += seconds;
      match.size = Math.max(0, match.size - 3 * seconds);
    }
  }

  private relight(candle: Candle): void {
    if (candle.lent !== null) this.lender?.bank.relight(candle.lent);
    else this.bank.relight(candle.id);
    candle.stroke.settle();
    candle.sheltered = 0.6;
  }

  /** Returns the match's position, at its own depth, with its flame over the wick in the picture. */
  private wickOf(candle: Candle): [number, number] {
    const { view, match } = this;
    const { stand } = candle;
    return [view.roomX(view.pixelX(stand.x + 0.02, stand.z), match.z), view.roomY(view.pixelY(wickY(stand), stand.z), match.z) - 0.12];
  }

  private overMatch(x: number, y: number): boolean {
    return this.match.near(this.view.roomX(x, this.match.z), this.view.roomY(y, this.match.z));
  }

  private candleAt(x: number, y: number): Candle | null {
    const { view } = this;
    for (const candle of [...this.candles].reverse()) {
      const { stand } = candle;
      const dx = view.roomX(x, stand.z) - stand.x;
      const dy = view.roomY(y, stand.z) - stand.ground;
      const wide = Math.max(stand.radius, 0.22) + 0.1;
      if (Math.abs(dx) < wide && dy > -0.2 && dy < stand.height + 0.3 * stand.unit) return candle;
    }
    const cake = this.setting.cake;
    const first = this.candles[0];
    if (cake === null || first === undefined) return null;
    const dy = view.roomY(y, 0);
    return Math.abs(view.roomX(x, 0) - cake.x) < cake.radius && dy > -0.5 && dy < cake.height + 0.3 ? first : null;
  }

  /** The nearest extinguished candle to a tap on it or near its wick. */
  private nearestOut(x: number, y: number): Candle | null {
    let best: Candle | null = null;
    let least = Infinity;
    for (const candle of this.candles) {
      if (candle.lit) continue;
      const { stand } = candle;
      const near = this.view.scale * this.view.nearness(stand.z);
      const dx = (x - this.view.pixelX(stand.x, stand.z)) / near;
      const dy = (y - this.view.pixelY(flameFoot(stand), stand.z)) / near;
      const far = Math.hypot(dx, dy > 0 ? dy : 0.35 * dy);
      if (far < least) [least, best] = [far, candle];
    }
    return least < 1.6 ? best : null;
  }
}
