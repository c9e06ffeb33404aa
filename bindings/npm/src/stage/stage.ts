// The stage: a canvas with its WebGL2 context, the frame loop, and the current scene.

import { FrameLoop } from './frame_loop.js';
import { PointerReader } from './pointer.js';
import type { Air, Scene } from './scene.js';

/** Maximum seconds per frame; after a pause the scene continues where it was. */
const LONGEST_FRAME = 0.1;
/** Maximum number of drawn pixels: more are invisible and heat a phone. */
const MAX_PIXELS = 2.6e6;
const MIN_DETAIL = 0.5;
/** Share of the full resolution below which expensive effects are left out. */
const PLAIN = 0.6;
/** Maximum mean seconds per frame that count as smooth; above it the resolution is lowered. */
const SMOOTH = 1 / 42;
/** Number of frames between checks of smoothness. */
const LOOK_EVERY = 45;
/** At low frame rates a check comes earlier: after this many seconds, and at least this many frames. */
const LOOK_SECONDS = 1.2;
const LOOK_FRAMES = 5;
const FAR_TOO_SLOW = 1 / 16;
/** Seconds above which a frame follows a pause, as of a hidden page, and the next check starts anew. */
const PAUSE = 1;
const FADE_SECONDS = 0.45;

/** Cost of a frame: milliseconds of this thread. */
export type FrameCost = Record<'update' | 'draw', number>;

export interface StageEvents {
  /** signed breath of this frame, from microphone and keys */
  breath(seconds: number): number;
  /** breath of this frame as a vector on the table; called after breath() */
  air(): Air;
  touched(): void;
  /** the WebGL context is missing, was lost, or was restored */
  context(state: 'absent' | 'lost' | 'back'): void;
  framed(cost: FrameCost, seconds: number): unknown;
}

export class Stage {
  readonly pointer: PointerReader;
  /** CSS pixels at the lower edge covered by controls */
  covered = 0;
  frames = 0;
  /** whether the last frame drew a picture */
  shown = false;
  paused = false;
  /** speed of time: 1, or less for users who prefer reduced motion */
  pace = 1;
  /** fixed number of drawn pixels per CSS pixel; 0: as many as stay smooth */
  detail = 0;
  private footer = 0;
  private readonly gl: WebGL2RenderingContext | null;
  private given = false;
  private loser: WEBGL_lose_context | null = null;
  private scene: Scene | null = null;
  /** whether the pointer makes no wind */
  still = false;
  private readonly wanted: BlobCallback[] = [];
  readonly loop = new FrameLoop((passed, now) => this.frame(passed, now));
  private fade = 0;
  private adapted = 1;
  private lookedAt = 0;
  private framesSinceLook = 0;

  constructor(
    readonly canvas: HTMLCanvasElement,
    private readonly events: StageEvents,
    /** whether only candles or leaves are drawn, without a room, on a transparent canvas */
    private readonly clear: boolean,
  ) {
    this.pointer = new PointerReader(canvas, () => this.scene, () => events.touched());
    canvas.addEventListener('webglcontextlost', (event) => this.lose(event));
    canvas.addEventListener('webglcontextrestored', () => this.regain());
    this.gl = canvas.getContext('webgl2', { alpha: clear, antialias: false, depth: false, powerPreference: 'high-performance' });
    if (this.gl === null) events.context('absent');
  }

  /** Shows a scene, or none, and disposes of the previous one. */
  show(scene: Scene | null): void {
    this.scene?.dispose();
    this.scene = scene;
    this.fade = 0;
    if (this.gl !== null && !this.gl.isContextLost()) scene?.attach(this.gl);
    this.relabel();
  }

  /** Updates the canvas's accessible description from the scene. */
  relabel(): void {
    this.canvas.setAttribute('aria-label', this.scene?.describe() ?? '');
  }

  /** Releases the scene and the context, as a browser has few of them; take() gets the context back. */
  giveBack(): void {
    this.given = true;
    this.loser ??= this.gl?.getExtension('WEBGL_lose_context') ?? null;
    this.loser?.loseContext();
    this.show(null);
  }

  take(): void {
    if (!this.given) return;
    this.given = false;
    this.restore();
  }

  /** The next picture as a file; waits while there is none. */
  snapshot(): Promise<Blob> {
    return new Promise((resolve, reject) => {
      this.wanted.push((blob) => (blob === null ? reject(new Error('The picture could not be made.')) : resolve(blob)));
    });
  }

  private lose(event: Event): void {
    event.preventDefault();
    if (this.given) return;
    this.events.context('lost');
    // take() was called before the loss caused by giveBack() was reported.
    if (this.loser !== null) setTimeout(() => this.restore());
  }

  private restore(): void {
    if (this.gl?.isContextLost() === true) this.loser?.restoreContext();
  }

  private regain(): void {
    if (this.gl !== null) this.scene?.attach(this.gl);
    this.events.context('back');
  }

  private frame(passed: number, now: number): void {
    const seconds = this.paused ? 0 : this.pace * Math.min(LONGEST_FRAME, Math.max(0, passed));
    if (this.scene === null) return;
    const before = performance.now();
    this.pointer.update(seconds);
    if (this.still) this.pointer.now.speedX = this.pointer.now.speedY = 0;
    const breath = this.events.breath(seconds);
    this.scene.update({ seconds, breath, air: this.events.air(), pointer: this.pointer.now });
    const between = performance.now();
    this.fade = Math.min(1, this.fade + passed / FADE_SECONDS);
    this.shown = this.gl !== null && !this.gl.isContextLost() && this.draw(this.scene);
    // A scene fades in from its first picture.
    if (!this.shown) this.fade = 0;
    // A canvas keeps its picture only until this frame ends.
    if (this.shown || this.gl === null) for (const take of this.wanted.splice(0)) this.canvas.toBlob(take, 'image/png');
    this.frames += 1;
    this.events.framed({ update: between - before, draw: performance.now() - between }, seconds);
    if (passed === 0 || passed > PAUSE) this.lookedAt = this.framesSinceLook = 0; // out of view before
    this.lookHowSmooth(now);
  }

  private draw(scene: Scene): boolean {
    this.resize();
    const { fade, footer, clear } = this;
    return scene.draw(this.canvas.width, this.canvas.height, { fade, footer, clear, plain: this.detail === 0 && this.adapted < PLAIN });
  }

  private resize(): void {
    const box = this.canvas.getBoundingClientRect();
    this.footer = Math.min(0.4, this.covered / Math.max(1, box.height));
    let share = this.detail > 0 ? this.detail : Math.min(2, window.devicePixelRatio) * this.adapted;
    share = Math.min(share, Math.sqrt(MAX_PIXELS / Math.max(1, box.width * box.height)));
    const width = Math.max(1, Math.round(box.width * share));
    const height = Math.max(1, Math.round(box.height * share));
    if (this.canvas.width === width && this.canvas.height === height) return;
    this.canvas.width = width;
    this.canvas.height = height;
  }

  /** Lowers the resolution where frames are slow, and never raises it, as alternation would be visible. */
  private lookHowSmooth(now: number): void {
    this.framesSinceLook += 1;
    const seconds = (now - this.lookedAt) / 1000;
    if (this.framesSinceLook < LOOK_EVERY && (seconds < LOOK_SECONDS || this.framesSinceLook < LOOK_FRAMES)) return;
    const mean = seconds / this.framesSinceLook;
    // Far too slow: removes all expensive effects at once.
    const coarser = mean > FAR_TOO_SLOW ? 0.5 : 0.8;
    if (this.lookedAt > 0 && mean > SMOOTH) this.adapted = Math.max(MIN_DETAIL, this.adapted * coarser);
    this.lookedAt = now;
    this.framesSinceLook = 0;
  }
}
