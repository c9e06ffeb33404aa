// Wind and the tip's lean, all of a recording below each other, with the moment that is shown.

import { element } from '../../panel/element.js';
import type { Outlines } from '../outlines.js';
import { surfaceOf } from './surface.js';

/** A line: its name, colour and values; what is NaN leaves a gap. */
interface Line {
  name: string;
  colour: string;
  values: ArrayLike<number>;
  low: number;
  high: number;
}

function rangeOf(values: ArrayLike<number>, least: readonly [number, number]): { low: number; high: number } {
  let [low, high] = least;
  for (let k = 0; k < values.length; ++k) {
    const value = values[k] as number;
    if (value < low) low = value;
    if (value > high) high = value;
  }
  return { low, high };
}

export class Traces {
  readonly place = element('div', { class: 'traces' });
  private readonly canvas = element('canvas', { role: 'img', 'aria-label': 'Wind that was heard, and how the tip of the flame leans' });
  private lines: Line[] = [];
  private seconds = 0;
  private readonly marker = element('i', { hidden: true });

  constructor() {
    this.place.append(this.canvas, this.marker);
    new ResizeObserver(() => this.draw()).observe(this.place);
  }

  /** Shows a recording's. */
  fill({ wind, lean, rows, rate }: Outlines): void {
    this.seconds = rows / rate;
    this.marker.hidden = true;
    this.lines = [
      ...(wind === null ? [] : [{ name: 'Wind', colour: '#7fc4ff', values: wind, ...rangeOf(wind, [0, 1]) }]),
      { name: 'Tip', colour: '#ffb35c', values: lean, ...rangeOf(lean, [-0.2, 0.2]) },
    ];
    this.draw();
  }

  /** The moment that is shown, as a share of all. */
  mark(share: number): void {
    // The lines are not drawn anew for it.
    this.marker.hidden = false;
    this.marker.style.left = `${(100 * share).toFixed(2)}%`;
  }

  private draw(): void {
    const surface = surfaceOf(this.canvas);
    if (surface === null || this.lines.length === 0) return;
    const { context, width, height } = surface;
    const each = (height - 16) / this.lines.length;
    this.lines.forEach((line, k) => drawLine(context, line, width, k * each, each - 6));
    context.fillStyle = '#b9b3ac';
    context.font = '11px ui-sans-serif, system-ui, sans-serif';
    const step = [1, 2, 5, 10, 20, 30, 60, 120, 300, 600].find((length) => this.seconds / length <= 9) ?? 1200;
    for (let at = 0; at <= this.seconds; at += step) {
      const x = (at / this.seconds) * width;
      context.textAlign = at === 0 ? 'left' : x > width - 20 ? 'right' : 'center';
      context.fillText(`${at} s`, x, height - 2);
    }
  }
}

function drawLine(context: CanvasRenderingContext2D, line: Line, width: number, top: number, height: number): void {
  const { values, low, high, colour, name } = line;
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
