// The film during analysis: picture, detected outline, and a box for choosing the object.

import type { Region, Seen } from '@wisp/studio';
import { element } from '../../panel/element.js';
import type { Kept } from '../reel.js';
import { atRefresh, contain, drawKept, stroke, surfaceOf, type Fit } from './surface.js';

/** Number of past positions drawn behind a moving object. */
const TRAIL = 40;
/** Maximum number of frames between positions of one fall. */
const APART = 12;

/** Minimum side of a box, CSS pixels; smaller ones are accidental presses. */
const SLIP = 12;
/** Share of the picture by which a key moves or widens the box. */
const KEY_STEP = 0.03;

export class Viewer {
  readonly place = element('div', { class: 'viewer' });
  readonly video = element('video', { muted: true, playsinline: true, hidden: true, 'aria-hidden': 'true', tabindex: -1 });
  private readonly over = element('canvas', {
    class: 'over',
    tabindex: 0,
    role: 'img',
    'aria-label': 'The film with what was found. Drag a box over it, or use the arrow keys, Shift and the arrow keys, and Enter, to say where to look.',
    pointerdown: (event) => this.begin(event as PointerEvent),
    pointermove: (event) => this.stretch(event as PointerEvent),
    pointerup: () => this.end(),
    pointercancel: () => this.drop(),
    keydown: (event) => this.key(event as KeyboardEvent),
  });
  private readonly caption = element('p', { class: 'caption', hidden: true });
  private picture: ImageBitmap | null = null;
  /** last findings with an outline, and their picture */
  private followed: { seen: Seen; picture: ImageBitmap } | null = null;
  private kept: Kept | null = null;
  private size: { width: number; height: number } | null = null;
  private seen: Seen | null = null;
  private box: Region | null = null;
  /** past centres of a falling object */
  private trail: number[] = [];
  private lines: readonly Float32Array[] = [];
  private readonly draw = atRefresh(() => this.drawNow());
  private from: { x: number; y: number } | null = null;

  /** `chosen`: receives the chosen region, pixels of the film; null: anywhere */
  constructor(private readonly chosen: (region: Region | null) => void) {
    // The camera's own sound is never played.
    this.video.muted = true;
    this.place.append(this.video, this.over, this.caption);
    new ResizeObserver(() => this.draw()).observe(this.place);
  }

  /** Shows words over the picture; '' for none. */
  say(words: string): void {
    this.caption.hidden = words === '';
    if (this.caption.textContent !== words) this.caption.textContent = words;
  }

  /** Whether there is a picture of a film. */
  get shows(): boolean { return this.picture !== null; }

  /** Clears picture and findings. */
  clear(): void {
    if (this.picture !== this.followed?.picture) this.picture?.close();
    this.followed?.picture.close();
    this.picture = this.kept = this.size = this.seen = this.box = this.followed = null;
    this.trail = [];
    this.lines = [];
    this.say('');
    this.draw();
  }

  /** Shows a camera's live picture; null: none. */
  camera(stream: MediaStream | null): void {
    this.video.srcObject = stream;
    this.video.hidden = stream === null;
    if (stream === null) return;
    this.clear();
    this.video.play().catch(() => undefined);
  }

  /** Shows findings in the film, and takes ownership of their picture. */
  show(seen: Seen): void {
    this.follow(seen, seen.frame - (this.seen?.frame ?? 0));
    this.seen = seen;
    if (seen.width > 0) this.size = { width: seen.width, height: seen.height };
    if (seen.picture !== undefined) {
      if (this.picture !== this.followed?.picture) this.picture?.close();
      this.picture = seen.picture;
      if (seen.state === 'following') {
        this.followed?.picture.close();
        this.followed = { seen, picture: seen.picture };
      }
    }
    this.draw();
  }

  /** Shows the last picture with an outline: later ones are dark if the flame was blown out. */
  showFollowed(): void {
    if (this.followed === null) return;
    if (this.picture !== this.followed.picture) this.picture?.close();
    this.picture = this.followed.picture;
    this.seen = this.followed.seen;
    this.draw();
  }

  /** Shows detected lines over the film's picture. `lines` receives the picture's size. */
  showLines(lines: (size: { width: number; height: number }) => readonly Float32Array[]): void {
    this.trail = [];
    this.lines = this.size === null ? [] : lines(this.size);
    if (this.seen !== null) this.seen = { ...this.seen, moving: null };
    this.draw();
  }

  private follow({ moving }: Seen, passed: number): void {
    if (moving === null || passed > APART) this.trail = [];
    if (moving !== null) this.trail = [...this.trail, moving.x + moving.width / 2, moving.y + moving.height / 2].slice(-2 * TRAIL);
  }

  /** Shows one moment of a film, of which only small pictures are kept. */
  still(kept: Kept): void {
    this.kept = kept;
    this.size = kept.whole;
    this.seen = null;
    this.draw();
  }

  /** Shows the chosen region, pixels of the film. */
  showBox(region: Region | null): void { this.box = region; this.draw(); }

  private get dimensions(): { width: number; height: number } | null {
    if (!this.video.hidden && this.video.videoWidth > 0) return { width: this.video.videoWidth, height: this.video.videoHeight };
    return this.size;
  }

  private get fit(): Fit | null {
    const { dimensions } = this;
    return dimensions === null ? null : contain(dimensions, this.over.clientWidth, this.over.clientHeight);
  }

  // One canvas for picture and overlay: a second would be a screen-sized layer, redrawn ten times a second during analysis.
  private drawNow(): void {
    const surface = surfaceOf(this.over);
    const { fit, seen, box } = this;
    if (surface === null || fit === null) return;
    const { context } = surface;
    if (this.video.hidden) this.drawFilm(context, fit);
    if (seen !== null && seen.outline.length > 2) drawOutline(context, seen.outline, fit);
    for (const line of this.lines) drawOutline(context, line, fit);
    if (seen?.moving != null) drawMoving(context, seen.moving, this.trail, fit);
    if (box !== null) drawBox(context, box, fit, surface.width, surface.height);
  }

  private drawFilm(context: CanvasRenderingContext2D, fit: Fit): void {
    const { size, picture, kept } = this;
    if (size === null) return;
    if (picture !== null) context.drawImage(picture, fit.x, fit.y, fit.scale * size.width, fit.scale * size.height);
    else if (kept !== null) drawKept(context, kept, fit);
  }

  private filmPoint({ offsetX, offsetY }: PointerEvent): { x: number; y: number } | null {
    const { fit, dimensions } = this;
    if (fit === null || dimensions === null) return null;
    const within = (value: number, most: number): number => Math.round(Math.max(0, Math.min(most, value)));
    return { x: within((offsetX - fit.x) / fit.scale, dimensions.width), y: within((offsetY - fit.y) / fit.scale, dimensions.height) };
  }

  private begin(event: PointerEvent): void {
    this.from = this.filmPoint(event);
    if (this.from !== null) this.over.setPointerCapture(event.pointerId);
  }

  private stretch(event: PointerEvent): void {
    const to = this.filmPoint(event);
    const { from } = this;
    if (from === null || to === null) return;
    this.showBox({ x: Math.min(from.x, to.x), y: Math.min(from.y, to.y), width: Math.abs(to.x - from.x), height: Math.abs(to.y - from.y) });
  }

  private end(): void {
    const { box, fit, from } = this;
    this.from = null;
    if (from === null || box === null || fit === null) return;
    if (Math.min(box.width, box.height) * fit.scale < SLIP) this.drop();
    else this.chosen(box);
  }

  private drop(): void {
    this.from = null;
    this.showBox(null);
    this.chosen(null);
  }

  private key(event: KeyboardEvent): void {
    const all = this.dimensions;
    if (all === null) return;
    const ways: Readonly<Record<string, readonly [number, number]>> = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };
    const way = ways[event.key];
    if (way !== undefined) {
      event.preventDefault();
      const box = this.box ?? { x: all.width / 4, y: all.height / 4, width: all.width / 2, height: all.height / 2 };
      const [across, down] = [way[0] * KEY_STEP * all.width, way[1] * KEY_STEP * all.height];
      const moved = event.shiftKey ? { ...box, width: box.width + across, height: box.height + down } : { ...box, x: box.x + across, y: box.y + down };
      this.showBox(inside(moved, all));
    } else if (event.key === 'Enter' && this.box !== null) this.chosen(this.box);
    else if (event.key === 'Escape' && this.box !== null) this.drop();
  }
}

function inside(box: Region, all: { width: number; height: number }): Region {
  const width = Math.round(Math.max(16, Math.min(all.width, box.width)));
  const height = Math.round(Math.max(16, Math.min(all.height, box.height)));
  const at = (value: number, most: number): number => Math.round(Math.max(0, Math.min(most, value)));
  return { x: at(box.x, all.width - width), y: at(box.y, all.height - height), width, height };
}

/** Draws the detected outline as a bright line with a dark border, visible on the flame and beside it. */
function drawOutline(context: CanvasRenderingContext2D, outline: Float32Array, fit: Fit): void {
  context.lineJoin = 'round';
  stroke(context, outline, fit, 'rgb(0 0 0 / 60%)', 4.5);
  stroke(context, outline, fit, '#7fe3ff', 2);
}

/** Draws a moving object and its past path. */
function drawMoving(context: CanvasRenderingContext2D, { x, y, width, height }: Region, trail: readonly number[], fit: Fit): void {
  drawOutline(context, Float32Array.from(trail), fit);
  const air = 4;
  context.strokeRect(fit.x + fit.scale * x - air, fit.y + fit.scale * y - air, fit.scale * width + 2 * air, fit.scale * height + 2 * air);
}

function drawBox(context: CanvasRenderingContext2D, box: Region, fit: Fit, width: number, height: number): void {
  const [x, y] = [fit.x + fit.scale * box.x, fit.y + fit.scale * box.y];
  const [across, down] = [fit.scale * box.width, fit.scale * box.height];
  context.fillStyle = 'rgb(5 5 8 / 55%)';
  context.beginPath();
  context.rect(0, 0, width, height);
  context.rect(x, y, across, down);
  context.fill('evenodd');
  context.strokeStyle = '#ffb35c';
  context.lineWidth = 1.5;
  context.setLineDash([6, 5]);
  context.strokeRect(x, y, across, down);
  context.setLineDash([]);
}
