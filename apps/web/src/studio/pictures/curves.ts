// Plots of a report's curves: those with the same axes share one.

import type { Captured, Curve } from '@wisp/studio';
import { element } from '../../panel/element.js';
import { surfaceOf } from './surface.js';

const COLOURS = ['#7fc4ff', '#ffb35c', '#9fd8a4', '#e690b8'];
const MARGIN = { left: 44, right: 8, top: 8, bottom: 30 };
const MOST_PLOTS = 6;

const short = (value: number): string => (value === 0 ? '0' : String(Number(value.toPrecision(3))).replace('-', '−'));

/** Plots of all of them. */
export function plotsOf(curves: readonly Curve[]): HTMLElement[] {
  const groups = new Map<string, Curve[]>();
  for (const curve of curves) {
    const axes = `${curve.id.replace(/[.:#].*$/, '')}\n${curve.x_label}\n${curve.y_label}`;
    groups.set(axes, [...(groups.get(axes) ?? []), curve]);
  }
  return [...groups.values()].slice(0, MOST_PLOTS).map(plotOf);
}

/** Columns of a table, as curves over time; no more points than can be seen. */
export function curvesOf({ series, rate, rows }: Captured): Curve[] {
  const every = Math.max(1, Math.ceil(rows / 2000));
  return series.map(({ name, unit, samples, role }) => {
    const kept = Array.from({ length: Math.floor(rows / every) }, (_, k) => k * every);
    return {
      id: role,
      label: `${name}, ${role === 'input' ? 'goes in' : 'comes out'}`,
      x_label: 'seconds',
      y_label: unit,
      x: kept.map((row) => row / rate),
      y: kept.map((row) => samples[row] ?? NaN),
    };
  });
}

function plotOf(curves: readonly Curve[]): HTMLElement {
  const labels = curves.map(({ label }) => label);
  const canvas = element('canvas', { role: 'img', 'aria-label': `${labels.join(', ')} over ${curves[0]?.x_label ?? ''}` });
  const legend = element('figcaption');
  labels.forEach((label, k) => {
    const name = element('span', { class: 'legend' }, label);
    name.style.setProperty('--colour', COLOURS[k % COLOURS.length] as string);
    legend.append(name);
  });
  new ResizeObserver(() => draw(canvas, curves)).observe(canvas);
  return element('figure', { class: 'curves' }, canvas, legend);
}

function extent(values: readonly number[]): [number, number] {
  let [low, high] = [Infinity, -Infinity];
  for (const value of values) {
    if (value < low) low = value;
    if (value > high) high = value;
  }
  return low < high ? [low, high] : [low - 0.5, low + 0.5];
}

function draw(canvas: HTMLCanvasElement, curves: readonly Curve[]): void {
  const surface = surfaceOf(canvas);
  if (surface === null) return;
  const { context, width, height } = surface;
  const [left, right] = extent(curves.flatMap(({ x }) => [extent(x.filter(Number.isFinite))].flat()));
  const [low, high] = extent(curves.flatMap(({ y }) => [extent(y.filter(Number.isFinite))].flat()));
  const x = (value: number): number => MARGIN.left + ((value - left) / (right - left)) * (width - MARGIN.left - MARGIN.right);
  const y = (value: number): number => height - MARGIN.bottom - ((value - low) / (high - low)) * (height - MARGIN.top - MARGIN.bottom);
  context.font = '11px ui-sans-serif, system-ui, sans-serif';
  for (const value of [low, (low + high) / 2, high]) {
    context.fillStyle = 'rgb(255 240 220 / 12%)';
    context.fillRect(MARGIN.left, Math.round(y(value)), width - MARGIN.left - MARGIN.right, 1);
    context.fillStyle = '#b9b3ac';
    context.textAlign = 'right';
    context.fillText(short(value), MARGIN.left - 6, y(value) + 4);
  }
  context.textAlign = 'left';
  context.fillText(short(left), MARGIN.left, height - 15);
  context.textAlign = 'right';
  context.fillText(short(right), width - MARGIN.right, height - 15);
  context.textAlign = 'center';
  context.fillText(curves[0]?.x_label ?? '', (MARGIN.left + width) / 2, height - 3);
  context.lineWidth = 1.5;
  context.lineJoin = 'round';
  curves.forEach((curve, k) => {
    context.strokeStyle = COLOURS[k % COLOURS.length] as string;
    context.beginPath();
    let on = false;
    curve.x.forEach((across, at) => {
      const value = curve.y[at] as number;
      const here = Number.isFinite(across) && Number.isFinite(value);
      if (here && on) context.lineTo(x(across), y(value));
      else if (here) context.moveTo(x(across), y(value));
      on = here;
    });
    context.stroke();
  });
}
