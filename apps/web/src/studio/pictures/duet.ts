// The film and the flame learned from it, side by side: same wind, time and scale.

import type { Library } from '@wisp/player';
import { FrameLoop } from '@wisp/player/parts/stage/frame_loop';
import type { Region } from '@wisp/studio';
import { element } from '../../panel/element.js';
import { paintFlame } from './flame_paint.js';
import type { Take } from '../session.js';
import { Play } from '../play.js';
import { drawKept, fitPart, placed, shaded, stroke, surfaceOf, type Fit } from './surface.js';
import type { Outlines } from '../outlines.js';

/** Maximum seconds by which a frame advances the clock. */
const LONGEST = 0.1;

/** Returns the region of the film that both pictures show: all positions of the flame, with a margin. */
export function partOf({ bounds, base, height }: Outlines): Region {
  const left = Math.min(bounds.x, base.x - 0.45 * height);
  const right = Math.max(bounds.x + bounds.width, base.x + 0.45 * height);
  const air = 0.3 * height;
  return { x: left - air, y: bounds.y - air, width: right - left + 2 * air, height: bounds.height + 1.7 * air };
}

export class Duet {
  readonly place = element('div', { class: 'duet' });
  private readonly film = element('canvas', { role: 'img', 'aria-label': 'The film' });
  private readonly flame = element('canvas', { role: 'img', 'aria-label': 'The flame that learned from it, in the same wind' });
  private readonly video = element('video', { muted: true, playsinline: true, loop: true });
  private readonly play: Play;
  private readonly part: Region;
  private readonly address: string | null;
  private filmed = false;
  /** film time of the displayed picture, seconds; null: not reported by the browser */
  private shown: number | null = null;
  private clock = 0;
  readonly loop = new FrameLoop((passed) => this.frame(passed));

  /** `moved`: receives the shown time, as a share of the film */
  constructor(wisp: Library, private readonly take: Take, private readonly outlines: Outlines, model: Uint8Array, private readonly moved: (share: number) => void) {
    this.play = new Play(wisp, outlines, model);
    this.part = partOf(outlines);
    for (const [canvas, words] of [[this.film, 'Your film'], [this.flame, 'What it learned']] as const) {
      this.place.append(element('figure', {}, canvas, element('figcaption', {}, words)));
    }
    this.address = take.film === null ? null : URL.createObjectURL(take.film);
    if (this.address !== null) this.openFilm(this.address);
  }

  stop(): void { this.loop.stop(); this.video.pause(); }

  dispose(): void {
    this.stop();
    this.play.free();
    this.video.removeAttribute('src');
    this.video.load();
    if (this.address !== null) URL.revokeObjectURL(this.address);
  }

  private openFilm(address: string): void {
    this.video.muted = true;
    // A film that the video element cannot play is shown by its kept pictures.
    this.video.addEventListener('loadeddata', () => (this.filmed = true));
    this.video.addEventListener('error', () => (this.filmed = false));
    this.video.src = address;
    this.watchFilm();
  }

  private watchFilm(): void {
    if (!('requestVideoFrameCallback' in this.video)) return;
    this.video.requestVideoFrameCallback((_, { mediaTime }) => {
      this.shown = mediaTime;
      // Draws picture and outline together, as the video may show another frame at the next refresh.
      this.drawFilm(this.rowAt(mediaTime));
      this.watchFilm();
    });
  }

  private frame(passed: number): void {
    const seconds = Math.min(LONGEST, passed);
    const { rows, rate } = this.outlines;
    if (this.filmed) {
      if (this.video.paused) this.video.play().catch(() => (this.filmed = false));
      // Follows the displayed frame where its time is known: on slow machines it lags behind currentTime.
      this.clock = this.shown ?? this.video.currentTime;
    } else this.clock = (this.clock + seconds) % (rows / rate);
    const row = this.rowAt(this.clock);
    this.play.goTo(row);
    if (!this.filmed || this.shown === null) this.drawFilm(row);
    this.drawFlame();
    this.moved(row / rows);
  }

  private rowAt(seconds: number): number {
    return Math.max(0, Math.min(this.outlines.rows - 1, Math.floor(seconds * this.outlines.rate + 1e-3)));
  }

  private drawFilm(row: number): void {
    const surface = surfaceOf(this.film);
    if (surface === null) return;
    const { context, width, height } = surface;
    const fit = fitPart(this.part, { x: 0, y: 0, width, height });
    if (this.filmed) context.drawImage(this.video, fit.x, fit.y, fit.scale * this.video.videoWidth, fit.scale * this.video.videoHeight);
    else {
      const kept = this.take.reel.at(row / this.outlines.rate);
      if (kept !== null) drawKept(context, kept, fit);
    }
    const line = this.outlines.line(row);
    context.lineJoin = 'round';
    if (line !== null) stroke(context, line, fit, 'rgb(127 227 255 / 75%)', 1.5);
  }

  private drawFlame(): void {
    const surface = surfaceOf(this.flame);
    if (surface === null) return;
    const { context, width, height } = surface;
    const fit = fitPart(this.part, { x: 0, y: 0, width, height });
    const { base } = this.outlines;
    this.drawCandle(context, fit, width, height);
    drawWick(context, fit.x + fit.scale * base.x, fit.y + fit.scale * base.y, fit.scale * this.outlines.height);
    if (this.play.size > 0) paintFlame(context, placed(this.play.line(), fit), fit.scale * this.outlines.height);
  }

  /** Draws the flame's support from a picture of the film, from the flame's base downwards. */
  private drawCandle(context: CanvasRenderingContext2D, fit: Fit, width: number, height: number): void {
    const kept = this.take.reel.at(0.4 * (this.outlines.rows / this.outlines.rate));
    if (kept === null) return;
    const { base, height: tall } = this.outlines;
    const foot = Math.round(fit.y + fit.scale * (base.y + 0.03 * tall)); // whole pixels: no row is partly covered
    context.save();
    context.beginPath();
    context.rect(0, foot, width, height - foot);
    context.clip();
    drawKept(context, kept, fit);
    // The film's background fades in.
    context.fillStyle = shaded(context.createLinearGradient(0, foot, 0, foot + 0.14 * fit.scale * tall), [[0, '#030304'], [1, 'rgb(3 3 4 / 0%)']]);
    context.fillRect(0, foot, width, height - foot);
    context.restore();
  }
}

function drawWick(context: CanvasRenderingContext2D, x: number, y: number, height: number): void {
  context.strokeStyle = shaded(context.createLinearGradient(0, y - 0.05 * height, 0, y + 0.14 * height), [[0, '#6b4a36'], [1, 'rgb(50 40 36 / 0%)']]);
  context.lineWidth = Math.max(2, 0.03 * height);
  context.lineCap = 'round';
  context.beginPath();
  context.moveTo(x, y + 0.14 * height);
  context.lineTo(x, y - 0.05 * height);
  context.stroke();
}
