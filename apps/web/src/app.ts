// The page as a whole: connects stage, player, microphone and controls.

import type { Library } from '@wisp/player';
import { fetchPart, once } from './part.js';
import { CandleScene } from '@wisp/player/parts/candle/scene';
import { watchDrops, type Dropped } from './drops.js';
import { linkOf, settingsFromLink, type Settings } from './link.js';
import { Controls, type Hearing } from './panel/controls.js';
import { byId } from './panel/element.js';
import { listenToKeys } from './panel/keys.js';
import { Hint, Notices } from './panel/notices.js';
import { Player, type Playing } from './player.js';
import { Probe } from './probe.js';
import type { Air } from '@wisp/player/parts/stage/scene';
import { Stage, type FrameCost } from '@wisp/player/parts/stage/stage';
import { Breath } from '@wisp/player/parts/air/breath';
import type { Parts } from './late.js';

/** Modules not needed for the first flame. */
type Late = typeof import('./late.js');

/** Minimum wind at which the page says that a model was learned without wind. */
const BLOWN = 0.3;

/** CSS pixels covered by the controls at the lower edge. */
const COVERED = 118;

/** Speed of time for visitors who prefer reduced motion. */
const SLOW = 0.4;

/** Breath of a visitor's arrival: seconds of play before it, its duration, and maximum seconds counted per frame. */
const DUCKS = { after: 0.7, lasts: 0.26, frame: 0.1 };

/** Rotation of the eye round the candle per key press, radians. */
const TURN = Math.PI / 12;

const START_HINT = 'Move past it, or press Blow and blow';
const NO_WEBGL = 'This browser shows no WebGL 2, which the picture is drawn with. A current Firefox, Chrome, Edge or Safari does; it may be switched off in the settings.';

export class App {
  readonly stage: Stage;
  readonly player: Player;
  readonly breath = new Breath();
  private readonly controls: Controls;
  private readonly drawerButton = byId('open-drawer', HTMLButtonElement);
  private readonly pauseButton = byId('pause', HTMLButtonElement);
  private readonly backButton = byId('back', HTMLButtonElement);
  private readonly tuneButton = byId('tune-play', HTMLButtonElement);
  private readonly greeting = byId('greeting', HTMLElement);
  /** whether keys of a single character act */
  singleKeys = true;
  readonly help = byId('help', HTMLDialogElement);
  readonly notices = new Notices(byId('notices', HTMLElement));
  private readonly hint = new Hint(byId('hint', HTMLElement));
  private readonly probe = new Probe(this.breath.path, () => this.places(), () => this.parts?.ear.state ?? 'off');
  parts: Parts | null = null;
  /** actions of keys; late modules add theirs */
  keys: Record<string, () => void> = {};
  private readonly late: () => Promise<Late>;
  private bring: () => void = () => undefined;
  private touched = false;
  /** whether the link carried words from a sender */
  private readonly received: boolean;
  private wasLit = true;
  private heardState: Hearing = 'off';
  /** model for which borrowed wind was last offered */
  private offered: Playing | null = null;
  /** Seconds of play since the breath of arrival began; negative before it begins. */
  private duckFrom = Infinity;

  constructor(readonly wisp: Library, readonly settings: Settings, private readonly own: Readonly<Settings>, readonly overlay: boolean) {
    this.stage = new Stage(byId('stage', HTMLCanvasElement), {
      breath: (seconds) => this.breath.update(seconds, this.stage.frames) + (this.parts?.senses.air.right ?? 0),
      air: () => this.air(),
      touched: () => this.touch(),
      context: (state) => this.onContext(state),
      framed: (cost, seconds) => this.onFrame(cost, seconds),
    }, overlay);
    this.stage.covered = overlay ? 0 : COVERED;
    this.stage.detail = settings.detail;
    if (document.body.classList.contains('calm')) this.stage.pace = SLOW;
    this.player = new Player(wisp, this.stage, settings, (playing) => this.onPlaying(playing));
    this.controls = new Controls(this);
    const played = new Promise<void>((resolve) => (this.bring = resolve));
    this.late = once(async () => {
      await played;
      const late = await fetchPart(() => import('./late.js'));
      this.parts ??= late.furnish(this);
      return late;
    });
    this.soon(() => undefined);
    this.received = settings.name !== '' || settings.from !== '' || settings.wish !== '';
    window.wisp = this.probe;
    this.listen();
  }

  async start(): Promise<void> {
    this.stage.loop.start();
    await this.playChosen();
    this.hint.show(START_HINT, 12);
    // An overlay has no buttons, so its microphone opens at once.
    if (this.overlay) this.toggleMicrophone();
  }

  private listen(): void {
    byId('share', HTMLButtonElement).addEventListener('click', () => this.soon(() => this.showCard(this.parts?.card.open !== true)));
    this.pauseButton.addEventListener('click', () => this.pause());
    byId('open-help', HTMLButtonElement).addEventListener('click', () => this.showHelp());
    this.drawerButton.addEventListener('click', () => this.toggleDrawer());
    watchDrops(byId('drop', HTMLElement), (dropped) => this.take(dropped));
    // Links leave out what is empty, so nothing of the link before is kept there.
    window.addEventListener('hashchange', () => this.change(settingsFromLink(location.hash, { ...this.settings, name: '', from: '', wish: '', age: 0, model: '' })));
    const scene = (name: Settings['scene']) => () => this.change({ scene: name });
    listenToKeys(
      this.breath.keys,
      (this.keys = {
        l: () => this.act(),
        b: () => this.toggleMicrophone(),
        '1': scene('candle'),
        '2': scene('leaves'),
        i: () => this.toggleDrawer(),
        s: () => this.soon(() => this.showCard(true)),
        a: () => this.toggleSenses(),
        n: () => this.change({ noise: this.settings.noise > 0 ? 0 : 1 }),
        p: () => this.pause(),
        f: () => this.fullScreen(),
        '?': () => this.showHelp(),
        h: () => this.showHelp(),
        ',': () => this.goRound(-TURN),
        '.': () => this.goRound(TURN),
        '-': () => this.controls.step(-1, this.settings),
        '+': () => this.controls.step(1, this.settings),
        '=': () => this.controls.step(1, this.settings),
        escape: () => (this.parts?.card.open === true ? this.showCard(false) : this.showDrawer(false)),
      }),
      () => this.touch(),
      () => this.singleKeys,
    );
  }

  change(change: Partial<Settings>): void {
    // A change of scene selects its shipped model.
    if (change.model === undefined && change.scene !== undefined) change = { ...change, model: '' };
    const needsModel = this.player.apply(change);
    this.stage.detail = this.settings.detail;
    const link = linkOf(this.settings, this.own);
    if (location.hash !== link && !this.overlay) history.replaceState(null, '', link);
    const { playing } = this.player;
    if (needsModel) this.playChosen().catch((error: Error) => this.notices.say(error.message));
    else if (playing !== null) this.controls.show(playing.tab, this.settings);
    this.greet();
    // Updates the drawer after a key changed what it shows.
    const drawer = this.parts?.drawer;
    if (!needsModel && playing !== null && drawer?.open === true && !drawer.holdsFocus) drawer.fill();
  }

  private async playChosen(): Promise<void> {
    try {
      await this.player.playChosen();
    } catch (error) {
      // Reported by the late modules, which are loaded once something plays.
      if (this.player.playing === null) await this.player.playShipped();
      this.soon((late) => late.sayWrong(this, error));
    }
  }

  private onPlaying(playing: Playing): void {
    if (playing.tab !== null) this.settings.scene = playing.tab;
    this.controls.show(playing.tab, this.settings);
    this.parts?.drawer.fill();
    this.wasLit = true;
    this.greet();
    if (this.touched) this.hint.hide();
  }

  /** Runs an action with the late modules, or reports that they could not be loaded. */
  private soon(act: (late: Late) => void): void {
    this.late().then(act, (error: Error) => this.notices.say(error.message));
  }

  /** Plays a dropped model, or opens the studio with dropped films, pictures or tables. */
  take(dropped: Dropped): void {
    this.soon((late) => late.openDropped(this, dropped));
  }

  act(): void {
    this.touch();
    this.player.playing?.scene.act();
  }

  private touch(): void {
    if (this.touched) return;
    this.touched = true;
    this.hint.hide();
  }

  toggleMicrophone(): void {
    this.touch();
    this.soon(() => {
      const ear = this.parts?.ear;
      if (ear?.state === 'asleep') return; // the press has resumed the sound
      if (ear?.state === 'off') void ear.open();
      else ear?.close();
    });
  }

  toggleSenses(): void {
    const senses = this.parts?.senses;
    senses?.toggle();
    this.parts?.drawer.showSenses(senses?.on === true);
  }

  pause(): void {
    const paused = !this.stage.paused;
    this.stage.paused = paused;
    this.pauseButton.setAttribute('aria-pressed', String(paused));
    this.pauseButton.setAttribute('aria-label', paused ? 'Go on' : 'Pause');
    if (paused) this.hint.show('Paused. P goes on.');
    else this.hint.hide();
  }

  private fullScreen(): void {
    if (document.fullscreenElement !== null) void document.exitFullscreen();
    else document.documentElement.requestFullscreen().catch(() => this.notices.say('This browser keeps its frame here.'));
  }

  private showHelp(): void {
    this.soon(() => this.help.showModal());
  }

  private toggleDrawer(): void {
    this.soon(() => this.showDrawer(this.parts?.drawer.open !== true));
  }

  showDrawer(open: boolean): void {
    const drawer = this.parts?.drawer;
    if (drawer === undefined || drawer.open === open) return;
    if (open) this.parts?.card.show(false);
    drawer.show(open);
    document.body.classList.toggle('beside', open);
    this.drawerButton.setAttribute('aria-expanded', String(open));
    if (!open) this.drawerButton.focus();
  }

  showCard(open: boolean): void {
    const card = this.parts?.card;
    if (card === undefined || card.open === open) return;
    this.touch();
    this.showDrawer(false);
    card.show(open);
    document.body.classList.toggle('beside', open);
    if (!open) byId('share', HTMLButtonElement).focus();
  }

  /** Shares a link to what plays, with a picture: by the device's share dialog, or as a copied link. */
  async send(): Promise<string> {
    const said = await this.copyLink();
    if (said.startsWith('Too large') || !window.matchMedia('(pointer: coarse)').matches || !('share' in navigator)) return said;
    const { name } = this.settings;
    const data: ShareData = { title: name === '' ? 'Blow it out' : `For ${name}: blow it out`, url: location.href };
    const picture = new File([await this.stage.snapshot()], 'candle.png', { type: 'image/png' });
    const whole = { ...data, files: [picture] };
    // Cancelling the dialog is not an error: the link is copied then.
    return navigator.share(navigator.canShare?.(whole) === true ? whole : data).then(() => 'Sent', () => said);
  }

  /** Sends one candle back to the sender, with thanks written in its smoke. */
  async sendBack(): Promise<void> {
    const { name, from } = this.settings;
    this.change({ name: from, from: name, candles: 1, age: 0, wish: 'Thank you' });
    const said = await this.send();
    this.notices.say(said === 'Copied' ? 'The link is copied: one candle, and your thanks in its smoke. Paste it where the first came from.' : `${said}.`);
  }

  private greet(): void {
    const { name, from, wish, tune } = this.settings;
    const { lit = 1, of = 1 } = this.probe.burning ?? {};
    const candle = this.player.playing?.tab === 'candle';
    const out = lit === 0 && of > 0;
    // On a cake the plaque names the recipient.
    const plaque = this.settings.candles > 1 || this.settings.age > 0;
    const words = !candle ? '' : out && wish !== '' ? wish : [name && !plaque && `For ${name}`, from && `from ${from}`].filter(Boolean).join(', ');
    if (this.greeting.textContent !== words) this.greeting.textContent = words;
    this.greeting.classList.toggle('wished', out && wish !== '');
    this.backButton.hidden = !candle || !out || !this.received || this.overlay;
    this.tuneButton.hidden = !candle || tune === 0;
  }

  async copyLink(): Promise<string> {
    const { playing } = this.player;
    const settings = { ...this.settings };
    if (playing?.shipped === false && settings.model === '') {
      const { MAX_PACKED_BYTES, packModel } = await this.late();
      if (playing.bytes.length > MAX_PACKED_BYTES) return 'Too large for a link: save and send it';
      settings.model = await packModel(playing.bytes);
    }
    const link = new URL(linkOf(settings, this.own), location.href).href;
    history.replaceState(null, '', link);
    try {
      await navigator.clipboard.writeText(link);
      return 'Copied';
    } catch {
      return 'It is in the address bar';
    }
  }

  private onContext(state: 'absent' | 'lost' | 'back'): void {
    const absent = byId('absent', HTMLElement);
    absent.hidden = state === 'back';
    absent.textContent = state === 'absent' ? NO_WEBGL : 'The graphics card took the picture away for a moment. It comes back by itself.';
  }

  private onFrame(cost: Readonly<FrameCost>, seconds: number): void {
    const { playing } = this.player;
    if (playing === null) return;
    const reading = playing.scene.reading();
    this.probe.push(cost);
    // Late modules are loaded even if nothing can be drawn.
    if (this.probe.firstPicture === 0 && (this.stage.shown || this.stage.frames > 60)) {
      this.probe.firstPicture = performance.now();
      this.bring();
      // The flame bends once, as if the visitor had breathed on entering.
      if (!this.overlay && this.stage.pace === 1) this.duckFrom = -DUCKS.after;
    }
    if (this.duckFrom < DUCKS.lasts) this.duck(Math.min(seconds, DUCKS.frame));
    if (this.parts !== null) {
      const turned = this.parts.senses.turned();
      if (turned !== 0 && playing.scene instanceof CandleScene) playing.scene.goRound(turned);
      this.parts.senses.frame(playing.scene instanceof CandleScene ? playing.scene.burning().lit : 0);
      this.parts.drawer.frame(reading, cost);
      const { state } = this.parts.ear;
      if (state === 'listening' && this.heardState === 'asking' && !this.parts.tuning.isOpen) this.hint.show('Now: blow', 4);
      this.heardState = state;
      this.controls.hear(state, this.parts.ear.level);
      this.parts.tuning.frame();
    }
    Object.assign(this.probe, reading, { frames: this.stage.frames });
    this.offerWind(playing, reading.wind);
    if (playing.scene instanceof CandleScene) return this.watchCandles(playing.scene);
    Object.assign(this.probe, { burning: null, leaves: playing.scene.leaves?.() ?? null });
    this.controls.setActive(true);
  }

  private duck(seconds: number): void {
    const before = this.duckFrom;
    this.duckFrom += seconds;
    if (before < 0 && this.duckFrom >= 0) this.breath.keys.held.add('arrival');
    if (this.duckFrom >= DUCKS.lasts) this.breath.keys.held.delete('arrival');
  }

  /** Says once per model that it was learned without wind, and offers a remedy. */
  private offerWind(playing: Playing, wind: number): void {
    if (playing.tab !== 'candle' || playing.model.inputs.length > 0 || playing.borrows) return;
    if (Math.abs(wind) < BLOWN || this.offered === playing) return;
    this.offered = playing;
    this.notices.say(`${playing.file} was learned without wind: it cannot lean or go out.`, {
      words: 'Borrow the shipped answer to wind',
      accept: () => this.player.borrowWind().catch((error: unknown) => this.soon((late) => late.sayWrong(this, error))),
    });
  }

  private watchCandles(scene: CandleScene): void {
    const burning = scene.burning();
    Object.assign(this.probe, { burning, smoking: scene.smoking, candleX: scene.firstX, azimuth: scene.orbit.azimuth, leaves: null });
    const allLit = burning.lit === burning.of;
    if (!allLit) this.parts?.ear.blownOut();
    this.controls.setActive(!allLit);
    if (burning.lit === 0 || allLit) this.greet();
    if (burning.lit === 0 && this.parts?.tune.plays === true) this.parts.tune.stop();
    this.tuneButton.setAttribute('aria-pressed', String(this.parts?.tune.plays === true));
    if (allLit === this.wasLit) return;
    this.wasLit = allLit;
    this.stage.relabel();
    if (allLit) this.hint.hide();
    else this.hint.show(burning.of === 1 ? 'Tap the wick to light it again, or bring the match' : 'Tap a candle to light it again, or bring the match');
  }

  private places(): ReturnType<Probe['places']> {
    const scene = this.player.playing?.scene;
    if (!(scene instanceof CandleScene)) return null;
    const { canvas } = this.stage;
    const share = canvas.clientWidth / Math.max(1, canvas.width);
    const page = ([x, y]: readonly [number, number]): [number, number] => [x * share, canvas.clientHeight - y * share];
    const { wick, match } = scene.places();
    return { wick: page(wick), match: page(match) };
  }

  /** Wind as a vector: to the right by keys and tilt, away from the eye by microphone and tilt. */
  private air(): Air {
    const { right, away } = this.breath.air;
    const tilt = this.parts?.senses.air ?? { right: 0, away: 0 };
    return { right: right + tilt.right, away: away + tilt.away };
  }

  /** Rotates the view round the candle, as requested by a key. */
  private goRound(radians: number): void {
    const scene = this.player.playing?.scene;
    if (scene instanceof CandleScene && !scene.goRound(radians)) this.notices.say('This flame was learned from one side and has no other.');
  }
}
