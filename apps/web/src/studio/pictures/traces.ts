// Plots of wind and the tip's lean over a whole recording, with a marker of the shown time.

import type { Seen } from '@wisp/studio';
import { element } from '../../panel/element.js';
import type { Outlines } from '../outlines.js';
import { atRefresh, surfaceOf } from './surface.js';

/** A line: name, colour, values (NaN leaves a gap), and minimum range. */
interface Line { name: string; colour: string; values: ArrayLike<number>; least: readonly [low: number, high: number] }

/** Lines of wind (or the loudness of sound) and of the tip. */
const linesOf = (name: string, wind: ArrayLike<number> | null, lean: ArrayLike<number>): Line[] => [
  ...(wind === null ? [] : [{ name, colour: '#7fc4ff', values: wind, least: [0, 1] as const }]),
  { name: 'Tip', colour: '#ffb35c', values: lean, least: [-0.2, 0.2] },
];

/** Displacement of an outline's tip to the right of its base, in heights; NaN without an outline. */
function leanOf(outline: Float32Array): number {
  if (outline.length < 6) return NaN;
  const last = outline.length - 2;
  const base = { x: ((outline[0] as number) + (outline[last] as number)) / 2, y: ((outline[1] as number) + (outline[last + 1] as number)) / 2 };
  let tip = 0;
  for (let k = 2; k < outline.length; k += 2) if ((outline[k + 1] as number) < (outline[tip + 1] as number)) tip = k;
  return ((outline[tip] as number) - base.x) / Math.max(1, base.y - (outline[tip + 1] as number));
}

/** Appends values up to a frame, interpolated from the last value. */
function extend(values: number[], frame: number, value: number): void {
  const from = values.length;
  const before = values.at(-1) ?? NaN;
  const last = Number.isNaN(before) ? value : before;
  for (let k = from; k < frame; ++k) values.push(last + ((value - last) * (k + 1 - from)) / (frame - from));
}

export class Traces {
  readonly place = element('div', { class: 'traces' });
  private readonly canvas = element('canvas', { role: 'img', 'aria-label': 'Wind that was heard, and how the tip of the flame leans' });
  private lines: Line[] = [];
  private seconds = 0;
  private live: { lean: number[]; loud: number[] } = { lean: [], loud: [] };
  private readonly marker = element('i', { hidden: true });
  private readonly draw = atRefresh(() => this.drawNow());

  constructor() {
    this.place.append(this.canvas, this.marker);
    new ResizeObserver(() => this.draw()).observe(this.place);
  }

  /** Shows a recording. */
  fill({ wind, lean, rows, rate }: Outlines): void { this.show(linesOf('Wind', wind, lean), rows / rate); }

  /** Clears the plots; add() then appends findings as they arrive. */
  begin(): void { this.live = { lean: [], loud: [] }; this.show([], 0); }

  private show(lines: Line[], seconds: number): void {
    [this.lines, this.seconds] = [lines, seconds];
    this.marker.hidden = true;
    // A resize observer does not report an element reinserted at the same size.
    this.draw();
  }

  /** Adds findings and loudness, 0 to 1; null: unknown during analysis of a film. */
  add({ frame, outline }: Seen, loud: number | null): void {
    const { live } = this;
    extend(live.lean, frame, leanOf(outline));
    if (loud !== null) extend(live.loud, frame, loud);
    this.lines = linesOf('Sound', live.loud.length === 0 ? null : live.loud, live.lean);
    this.draw();
  }

  /** Marks the shown time, as a share of the recording. */
  mark(share: number): void {
    // Moves the marker only; the lines are not redrawn.
    this.marker.hidden = false;
    this.marker.style.left = `${(100 * share).toFixed(2)}%`;
  }

  private drawNow(): void {
    const surface = surfaceOf(this.canvas);
    if (surface === null || this.lines.length === 0) return;
    const named = this.seconds > 0;
    const { context, width, height } = surface;
    const each = (height - 16) / this.lines.length;
    this.lines.forEach((line, k) => drawLine(context, line, width, k * each, each - 6));
    context.fillStyle = '#b9b3ac';
    context.font = '11px ui-sans-serif, system-ui, sans-serif';
    const step = [1, 2, 5, 10, 20, 30, 60, 120, 300, 600].find((length) => this.seconds / length <= 9) ?? 1200;
    for (let at = 0; named && at <= this.seconds; at += step) {
      const x = (at / this.seconds) * width;
      context.textAlign = at === 0 ? 'left' : x > width - 20 ? 'right' : 'center';
      context.fillText(`${at} s`, x, height - 2);
    }
  }
}

function drawLine(context: CanvasRenderingContext2D, line: Line, width: number, top: number, height: number): void {
  const { values, colour, name } = line;
  let [low, high] = line.least;
  for (let k = 0; k < values.length; ++k) {
    const value = values[k] as number;
    if (value < low) low = value;
    if (value > high) high = value;
  }
  const y = (value: number): number => top + height - ((value - low) / (high - low || 1)) * (height - 4) - 2;
  context.fillStyle = 'rgb(255 240 220 / 12%)';
  context.fillRect(0, Math.round(y(0)), width, 1);
  context.strokeStyle = colour;
  context.lineWidth = 1.4;
  context.lineJoin = 'round';
  context.beginPath();
  let drawn = false;
  for (let k = 0; k < values.length; ++k) {
    const value = values[k] as number;
    const x = (k / Math.max(1, values.length - 1)) * width;
    if (Number.isNaN(value)) drawn = false;
    else if (drawn) context.lineTo(x, y(value));
    else context.moveTo(x, y(value));
    if (!Number.isNaN(value)) drawn = true;
  }
  context.stroke();
  context.textAlign = 'left';
  context.font = '12px ui-sans-serif, system-ui, sans-serif';
  const room = context.measureText(name).width + 10;
  context.fillStyle = 'rgb(7 8 12 / 78%)';
  context.fillRect(0, top + 1, room, 16);
  context.fillStyle = colour;
  context.fillText(name, 3, top + 13);
}
