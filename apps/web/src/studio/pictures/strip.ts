// A film strip: recorded frames above, and the model's play in the same wind at the same times below.

import type { Library } from '@wisp/player';
import type { Region } from '@wisp/studio';
import { element } from '../../panel/element.js';
import { partOf } from './duet.js';
import { paintFlame } from './flame_paint.js';
import type { Outlines } from '../outlines.js';
import { Play } from '../play.js';
import type { Take } from '../session.js';
import { drawKept, fitPart, placed, stroke, surfaceOf, type Fit } from './surface.js';

const PICTURES = 9;
const FEWER = 6;
/** Width in CSS pixels below which a strip shows fewer frames. */
const NARROW = 560;

export class Strip {
  readonly place = element('figure', { class: 'strip' });
  private readonly canvas = element('canvas', { role: 'img', 'aria-label': 'Film strip: recorded above, played below' });

  constructor(private readonly wisp: Library, private readonly take: Take, private readonly outlines: Outlines, private readonly model: Uint8Array) {
    this.place.append(this.canvas, element('figcaption', {}, 'Recorded above, played below, at the same moments.'));
    new ResizeObserver(() => this.draw()).observe(this.canvas);
  }

  private draw(): void {
    const surface = surfaceOf(this.canvas);
    if (surface === null) return;
    const { context, width, height } = surface;
    const { rate } = this.outlines;
    const play = new Play(this.wisp, this.outlines, this.model);
    const rowsShown = this.rowsShown(width < NARROW ? FEWER : PICTURES);
    const each = width / rowsShown.length;
    rowsShown.forEach((row, k) => {
      // Stepwise, as a long jump would restart the play.
      for (let on = 0; on < row; on += 100) play.goTo(on);
      play.goTo(row);
      const cell = { x: k * each + 1, width: each - 2, height: height / 2 - 1 };
      this.drawRecorded(context, row, { ...cell, y: 0 });
      this.inside(context, { ...cell, y: height / 2 + 1 }, (fit) => {
        if (play.size > 0) paintFlame(context, placed(play.line(), fit), fit.scale * this.outlines.height);
      });
    });
    context.fillStyle = '#b9b3ac';
    context.font = '11px ui-sans-serif, system-ui, sans-serif';
    rowsShown.forEach((row, k) => context.fillText(`${(row / rate).toFixed(1)} s`, k * each + 6, 13));
    play.free();
  }

  /** Rows with kept pictures, evenly over the film; fewer where few pictures were kept. */
  private rowsShown(pictures: number): number[] {
    const { rows, rate } = this.outlines;
    const wanted = Array.from({ length: pictures }, (_, k) => {
      const seconds = ((k + 0.5) / pictures) * (rows / rate);
      return Math.max(0, Math.min(rows - 1, Math.round((this.take.reel.at(seconds)?.seconds ?? seconds) * rate)));
    });
    return [...new Set(wanted)];
  }

  private inside(context: CanvasRenderingContext2D, cell: Region, draw: (fit: Fit) => void): void {
    context.save();
    context.beginPath();
    context.roundRect(cell.x, cell.y, cell.width, cell.height, 4);
    context.clip();
    context.fillStyle = '#050507';
    context.fillRect(cell.x, cell.y, cell.width, cell.height);
    draw(fitPart(partOf(this.outlines), cell));
    context.restore();
  }

  private drawRecorded(context: CanvasRenderingContext2D, row: number, cell: Region): void {
    this.inside(context, cell, (fit) => {
      const kept = this.take.reel.at(row / this.outlines.rate);
      if (kept !== null) drawKept(context, kept, fit);
      const line = this.outlines.line(row);
      if (line !== null) stroke(context, line, fit, '#7fe3ff', 1.2);
    });
  }
}
