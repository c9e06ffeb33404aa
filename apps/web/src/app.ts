// The page as a whole: stage, player, microphone and controls, and what passes between them.

import type { Wisp } from '@wisp/player';
import { CandleScene } from './candle/scene.js';
import { Refused, watchDrops } from './files.js';
import { linkOf, settingsFromLink, type Settings } from './link.js';
import { Controls } from './panel/controls.js';
import { Drawer } from './panel/drawer.js';
import { byId } from './panel/element.js';
import { fillHelp } from './panel/help.js';
import { listenToKeys } from './panel/keys.js';
import { Hint, Notices } from './panel/notices.js';
import { Player, type Playing } from './player.js';
import { Costs, type Probe } from './probe.js';
import type { Scene } from './stage/scene.js';
import { Stage, type FrameCost } from './stage/stage.js';
import { Breath } from './wind/breath.js';
import { Ear } from './wind/ear.js';

const START_HINT = 'Move past it, or press Blow and blow';

export class App {
  readonly stage: Stage;
  private readonly player: Player;
  private readonly breath = new Breath();
  private readonly ear: Ear;
  private readonly controls: Controls;
  private readonly drawer: Drawer;
  private readonly drawerButton = byId('open-drawer', HTMLButtonElement);
  private readonly help = byId('help', HTMLDialogElement);
  private readonly notices = new Notices(byId('notices', HTMLElement));
  private readonly hint = new Hint(byId('hint', HTMLElement));
  private readonly costs = new Costs();
  private readonly probe: Probe;
  private touched = false;
  private wasLit = true;

  constructor(
    private readonly wisp: Wisp,
    private readonly settings: Settings,
  ) {
    this.stage = new Stage(byId('stage', HTMLCanvasElement), {
      breath: (seconds) => this.breath.update(seconds, this.stage.frames),
      touched: () => this.touch(),
      context: (state) => this.onContext(state),
      framed: (cost) => this.onFrame(cost),
    });
    this.stage.detail = settings.detail;
    this.player = new Player(wisp, this.stage, settings, (playing) => this.onPlaying(playing));
    this.ear = new Ear(wisp, {
      wind: (wind) => this.breath.hear(wind, this.stage.frames),
      trouble: (words) => this.notices.say(words),
      ended: () => this.breath.deafen(),
    });
    this.controls = new Controls({
      change: (change) => this.change(change),
      blow: () => this.toggleMicrophone(),
      act: () => this.act(),
    });
    this.drawer = new Drawer(byId('drawer', HTMLElement), {
      change: (change) => this.change(change),
      open: (file) => this.openFile(file),
      closed: () => this.showDrawer(false),
      link: () => this.copyLink(),
    });
    this.probe = this.makeProbe();
    window.wisp = this.probe;
    this.listen();
  }

  /** Plays the first scene. */
  async start(): Promise<void> {
    this.stage.start();
    await this.playShipped();
    this.hint.show(START_HINT, 12);
  }

  private listen(): void {
    fillHelp(this.help);
    byId('open-help', HTMLButtonElement).addEventListener('click', () => this.help.showModal());
    this.drawerButton.addEventListener('click', () => this.showDrawer(!this.drawer.open));
    watchDrops(byId('drop', HTMLElement), (file) => this.openFile(file));
    window.addEventListener('hashchange', () => this.change(settingsFromLink(location.hash, this.settings)));
    const scene = (name: Settings['scene']) => () => this.change({ scene: name });
    listenToKeys(
      this.breath.keys,
      {
        l: () => this.act(),
        b: () => this.toggleMicrophone(),
        '1': scene('candle'),
        '2': scene('leaves'),
        i: () => this.showDrawer(!this.drawer.open),
        n: () => this.change({ noise: this.settings.noise > 0 ? 0 : 1 }),
        p: () => this.pause(),
        f: () => this.fullScreen(),
        '?': () => this.help.showModal(),
        h: () => this.help.showModal(),
        '-': () => this.controls.step(-1, this.settings),
        '+': () => this.controls.step(1, this.settings),
        '=': () => this.controls.step(1, this.settings),
        escape: () => this.showDrawer(false),
      },
      () => this.touch(),
    );
  }

  private change(change: Partial<Settings>): void {
    const needsModel = this.player.apply(change);
    const link = linkOf(this.settings);
    if (location.hash !== link) history.replaceState(null, '', link);
    const { playing } = this.player;
    if (needsModel) void this.playShipped();
    else if (playing !== null) this.controls.show(playing.tab, this.settings);
    // Where a key has changed what the drawer shows.
    if (!needsModel && playing !== null && this.drawer.open && !this.drawer.holdsFocus) this.drawer.fill(playing, this.settings);
  }

  private async playShipped(): Promise<void> {
    try {
      await this.player.playShipped();
    } catch (error) {
      this.notices.say(`${error instanceof Error ? error.message : String(error)} What plays goes on.`);
    }
  }

  private openFile(file: File): void {
    this.player.playFile(file).then(
      () => this.notices.say(`Playing ${file.name}.`),
      (error: unknown) => {
        if (!(error instanceof Refused)) throw error;
        this.notices.say(`${error.message} What plays goes on.`);
      },
    );
  }

  private onPlaying(playing: Playing): void {
    if (playing.tab !== null) this.settings.scene = playing.tab;
    this.controls.show(playing.tab, this.settings);
    this.drawer.fill(playing, this.settings);
    this.wasLit = true;
    if (this.touched) this.hint.hide();
  }

  private act(): void {
    this.touch();
    this.player.playing?.scene.act();
  }

  private touch(): void {
    if (this.touched) return;
    this.touched = true;
    this.hint.hide();
  }

  private toggleMicrophone(): void {
    this.touch();
    if (this.ear.state === 'off') void this.ear.open();
    else this.ear.close();
  }

  private pause(): void {
    this.stage.paused = !this.stage.paused;
    if (this.stage.paused) this.hint.show('Paused. P goes on.');
    else this.hint.hide();
  }

  private fullScreen(): void {
    if (document.fullscreenElement !== null) void document.exitFullscreen();
    else document.documentElement.requestFullscreen().catch(() => this.notices.say('This browser keeps its frame here.'));
  }

  private showDrawer(open: boolean): void {
    if (this.drawer.open === open) return;
    this.drawer.show(open);
    this.stage.canvas.classList.toggle('beside', open);
    this.drawerButton.setAttribute('aria-expanded', String(open));
    if (!open) this.drawerButton.focus();
  }

  private async copyLink(): Promise<string> {
    const link = new URL(linkOf(this.settings), location.href).href;
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
    absent.textContent =
      state === 'absent'
        ? 'This browser shows no WebGL 2, which the picture is drawn with. A current Firefox, Chrome, Edge or Safari does; it may be switched off in the settings.'
        : 'The graphics card took the picture away for a moment. It comes back by itself.';
  }

  private onFrame(cost: Readonly<FrameCost>): void {
    const { playing } = this.player;
    if (playing === null) return;
    const reading = playing.scene.reading();
    this.costs.push(cost);
    this.drawer.frame(reading, cost);
    this.controls.hear(this.ear.state, this.ear.level);
    if (this.probe.firstPicture === 0) this.probe.firstPicture = performance.now();
    this.probe.frames = this.stage.frames;
    this.probe.wind = reading.wind;
    this.probe.answer = reading.answer;
    if (playing.scene instanceof CandleScene) this.watchCandles(playing.scene);
    else this.watchOthers(playing.scene);
  }

  private watchOthers(scene: Scene): void {
    this.probe.burning = null;
    this.probe.leaves = scene.leaves?.() ?? null;
    this.controls.setActive(true);
  }

  private watchCandles(scene: CandleScene): void {
    const burning = scene.burning();
    this.probe.burning = burning;
    this.probe.smoking = scene.smoking;
    this.probe.candleX = scene.firstX;
    this.probe.leaves = null;
    const allLit = burning.lit === burning.of;
    this.controls.setActive(!allLit);
    if (allLit === this.wasLit) return;
    this.wasLit = allLit;
    this.stage.canvas.setAttribute('aria-label', scene.describe());
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

  private makeProbe(): Probe {
    const { costs, ear, breath, wisp } = this;
    return {
      frames: 0,
      costs: () => costs.list(),
      firstPicture: 0,
      wind: 0,
      answer: 0,
      burning: null,
      smoking: false,
      places: () => this.places(),
      leaves: null,
      candleX: 0,
      get hearing() {
        return ear.state;
      },
      sound: breath.path,
      get memory() {
        return wisp.memoryBytes;
      },
    };
  }
}
