// Plots of a report's curves; curves with the same axes share a plot.

import type { Library } from '@wisp/player';
import type { Captured, Curve } from '@wisp/studio';
import { element } from '../../panel/element.js';
import { surfaceOf } from './surface.js';

const COLOURS = ['#7fc4ff', '#ffb35c', '#9fd8a4', '#e690b8'];
const MARGIN = { left: 54, right: 8, top: 8, bottom: 30 };
const MAX_PLOTS = 6;

const short = (value: number): string => (value === 0 ? '0' : String(Number(value.toPrecision(Math.abs(value) < 1e-3 ? 2 : 3))).replace('-', '−'));

/** Prefixes of ids of curves that are plotted, in the plots' order, each with the plot's title. */
const FAMILIES: readonly (readonly [RegExp, string])[] = [
  [/^column/, ''],
  [/^fall\./, 'Recorded'],
  [/^played\./, 'What it learned'],
  [/^(measured|predicted|simulated)\./, 'Measured and played'],
  [/^tip\./, 'The tip, sideways'],
  [/^step\./, 'Answer to a step'],
  [/^flicker\.x/, 'Spectrum of the flicker, sideways'],
  [/^flicker\./, 'Spectrum of the flicker, up and down'],
  [/^residual\./, 'What is left over'],
  [/^(poles|zeros)/, 'Poles and zeros'],
  [/^(input|output):/, ''],
];

/** Key shared by the curves of one plot: family and channel; null: not plotted. */
function plotKey({ id }: Curve): string | null {
  const family = FAMILIES.findIndex(([begins]) => begins.test(id));
  if (family < 0) return null;
  const channel = /^(?:measured|predicted|simulated)\.(\d+)/.exec(id)?.[1] ?? /^flicker\.(\w)/.exec(id)?.[1] ?? /^(input|output):/.exec(id)?.[1];
  const own = channel ?? (/^(step|residual|column)/.test(id) ? id.replace(/\.(low|high|bound)$/, '') : '');
  return `${family} ${own}`;
}

export function plotsOf(curves: readonly Curve[]): HTMLElement[] {
  const groups = new Map<string, Curve[]>();
  for (const curve of curves) {
    const key = plotKey(curve);
    // A curve contained in two reports is drawn once.
    if (key === null || groups.get(key)?.some(({ id }) => id === curve.id) === true) continue;
    groups.set(key, [...(groups.get(key) ?? []), curve]);
  }
  return [...groups.entries()]
    .sort(([one], [other]) => parseInt(one) - parseInt(other))
    .slice(0, MAX_PLOTS)
    .map(([key, group], _, all) => plotOf(group, FAMILIES[parseInt(key)]?.[1] ?? '', all.map(([, other]) => other)));
}

/** Name of a curve in the legend. */
const nameOf = ({ id, label }: Pick<Curve, 'id' | 'label'>): string => (id.startsWith('zeros') ? `zeros, ${label}` : label);

const isPlace = ({ id }: Curve): boolean => /^(poles|zeros)/.test(id);

/** Whether a curve is a recorded or played fall, which needs no name in the legend. */
const isFall = ({ id }: Curve): boolean => /^(fall|played)\./.test(id);

/** Whether a curve is an interval's edge, drawn beside its main curve. */
const isEdge = ({ id }: Curve): boolean => /\.(low|high|bound)$/.test(id);

/** Minimum and maximum width / height of plots of falls. */
const SHAPES = [0.45, 1.8] as const;

/** Maximum number of falls shown. */
const MAX_FALLS = 12;

/** Side view of a path, relative to its first known position. */
function wayOf(id: string, across: readonly number[], up: readonly number[]): Curve {
  const begin = across.findIndex((value, k) => Number.isFinite(value) && Number.isFinite(up[k]));
  const from = (values: readonly number[]): number[] => values.map((value) => value - (values[begin] as number));
  return { id, label: id, x_label: 'metres', y_label: 'm', x: from(across), y: from(up) };
}

/** Sideways and vertical position of every recorded fall, metres. */
function waysOf({ series, episodes, rows }: Captured): [Float64Array, Float64Array][] {
  const [x, z] = ['pos.x', 'pos.z'].map((name) => series.find((one) => one.name === name)?.samples);
  if (x === undefined || z === undefined) return [];
  return episodes.map((begin, k) => [x.subarray(begin, episodes[k + 1] ?? rows), z.subarray(begin, episodes[k + 1] ?? rows)]);
}

const fallsOf = (captured: Captured): Curve[] => waysOf(captured).slice(0, MAX_FALLS).map(([x, z], k) => wayOf(`fall.${k}`, [...x], [...z]));

/** Falls as lines over their film, pixels, x and y alternating. `metres`: height of the wall in the picture. */
export function linesOfFalls(captured: Captured, metres: number, { width, height }: { width: number; height: number }): Float32Array[] {
  const scale = height / metres;
  return waysOf(captured).map(([x, z]) => Float32Array.from({ length: 2 * x.length }, (_, k) => (k % 2 === 0 ? width / 2 + scale * (x[k / 2] as number) : height - scale * (z[(k - 1) / 2] as number))));
}

/** Plays falls of a model, equal in number and duration to the recorded ones that are shown. */
export function fallsPlayed(wisp: Library, bytes: Uint8Array, { episodes, rows }: Captured): Curve[] {
  const shown = episodes.slice(0, MAX_FALLS);
  const model = wisp.model(bytes);
  const bank = model.bank({ capacity: Math.max(1, shown.length), seed: 1 });
  const instances = shown.map(() => bank.spawn());
  const [x, z] = ['pos.x', 'pos.z'].map((name) => model.outputs.findIndex((one) => one.name === name)) as [number, number];
  model.free();
  const lengths = shown.map((begin, k) => (episodes[k + 1] ?? rows) - begin);
  const ways = shown.map((): [number[], number[]] => [[], []]);
  for (let row = 0; row < Math.max(0, ...lengths); ++row) {
    bank.step();
    instances.forEach((instance, k) => {
      if (row >= (lengths[k] as number)) return;
      const values = bank.instanceOutputs(instance);
      ways[k]?.[0].push(values[x] as number);
      ways[k]?.[1].push(values[z] as number);
    });
  }
  bank.free();
  return ways.map(([across, up], k) => wayOf(`played.${k}`, across, up));
}

/** Columns of a table as curves over time, reduced to at most 2000 points each. */
function curvesOf({ series, rate, rows }: Captured): Curve[] {
  const every = Math.max(1, Math.ceil(rows / 2000));
  return series.map(({ name, unit, samples, role }) => {
    const kept = Array.from({ length: Math.floor(rows / every) }, (_, k) => k * every);
    const label = `${name}, ${role === 'input' ? 'goes in' : 'comes out'}`;
    return { id: `${role}: ${name}`, label, x_label: 'seconds', y_label: unit, x: kept.map((row) => row / rate), y: kept.map((row) => samples[row] ?? NaN) };
  });
}

/** The recording as curves: falls from the side, or every column over time. */
export function recordedOf(captured: Captured): Curve[] {
  const falls = fallsOf(captured);
  return falls.length > 0 ? falls : curvesOf(captured);
}

/** `all`: curves of all plots, as plots of falls have a common scale. */
function plotOf(curves: readonly Curve[], title: string, all: readonly (readonly Curve[])[]): HTMLElement {
  // Recorded and played falls have a common scale.
  const scale = curves.some(isFall) ? all.filter((other) => other.some(isFall)).flat() : curves;
  const named = curves.filter((curve) => !isEdge(curve) && !isFall(curve));
  const canvas = element('canvas', { role: 'img', 'aria-label': `${title} ${named.map(({ label }) => label).join(', ')}` });
  if (curves.some(isFall)) {
    const [left, right] = extent(scale.flatMap(({ x }) => x));
    const [low, high] = extent(scale.flatMap(({ y }) => y));
    canvas.style.aspectRatio = String(Math.max(SHAPES[0], Math.min(SHAPES[1], (right - left) / (high - low))));
  }
  const legend = element('figcaption', {}, ...(title === '' ? [] : [element('b', {}, title)]));
  named.forEach(({ label, id }, k) => {
    const name = element('span', { class: 'legend' }, nameOf({ id, label }));
    name.style.setProperty('--colour', COLOURS[k % COLOURS.length] as string);
    legend.append(name);
  });
  new ResizeObserver(() => draw(canvas, curves, scale)).observe(canvas);
  return element('figure', { class: curves.some(isFall) ? 'curves falls' : 'curves' }, legend, canvas);
}

function extent(values: readonly number[]): [number, number] {
  let [low, high] = [Infinity, -Infinity];
  for (const value of values) { if (value < low) low = value; if (value > high) high = value; }
  return low < high ? [low, high] : [low - 0.5, low + 0.5];
}

/** `scale`: curves that define the axes' ranges. */
function draw(canvas: HTMLCanvasElement, curves: readonly Curve[], scale: readonly Curve[]): void {
  const surface = surfaceOf(canvas);
  if (surface === null) return;
  const { context, width, height } = surface;
  let [left, right] = extent(scale.flatMap(({ x }) => x.filter(Number.isFinite)));
  let [low, high] = extent(scale.flatMap(({ y }) => y.filter(Number.isFinite)));
  const places = curves.some(isPlace);
  if (places) {
    [left, right] = [Math.min(left, -1.05), Math.max(right, 1.05)];
    [low, high] = [Math.min(low, -1.05), Math.max(high, 1.05)];
  }
  if (places || curves.some(isFall)) {
    // Horizontal and vertical scales are equal.
    const shape = (width - MARGIN.left - MARGIN.right) / (height - MARGIN.top - MARGIN.bottom);
    const wider = Math.max(0, shape * (high - low) - (right - left)) / 2;
    const taller = Math.max(0, (right - left) / shape - (high - low)) / 2;
    [left, right, low, high] = [left - wider, right + wider, low - taller, high + taller];
  }
  const x = (value: number): number => MARGIN.left + ((value - left) / (right - left)) * (width - MARGIN.left - MARGIN.right);
  const y = (value: number): number => height - MARGIN.bottom - ((value - low) / (high - low)) * (height - MARGIN.top - MARGIN.bottom);
  context.font = '11px ui-sans-serif, system-ui, sans-serif';
  const write = (align: CanvasTextAlign, words: string, across: number, down: number): void => {
    Object.assign(context, { textAlign: align, fillStyle: '#b9b3ac' });
    context.fillText(words, across, down);
  };
  for (const value of [low, (low + high) / 2, high]) {
    context.fillStyle = 'rgb(255 240 220 / 12%)';
    context.fillRect(MARGIN.left, Math.round(y(value)), width - MARGIN.left - MARGIN.right, 1);
    write('right', short(value), MARGIN.left - 6, y(value) + 4);
  }
  write('left', short(left), MARGIN.left, height - 15);
  write('right', short(right), width - MARGIN.right, height - 15);
  write('center', curves[0]?.x_label ?? '', (MARGIN.left + width) / 2, height - 3);
  context.lineWidth = 1.5;
  context.lineJoin = 'round';
  if (places) {
    // The unit circle, the limit of stability.
    context.strokeStyle = 'rgb(255 240 220 / 40%)';
    context.beginPath();
    context.ellipse(x(0), y(0), x(1) - x(0), y(0) - y(1), 0, 0, 2 * Math.PI);
    context.stroke();
  }
  let drawn = -1;
  for (const curve of curves) {
    if (!isEdge(curve)) drawn += 1;
    context.strokeStyle = context.fillStyle = COLOURS[Math.max(0, drawn) % COLOURS.length] as string;
    context.globalAlpha = isEdge(curve) ? 0.35 : 1;
    const dots = isPlace(curve) || (/^lag/.test(curve.x_label) && !isEdge(curve));
    let on = false;
    context.beginPath();
    curve.x.forEach((across, at) => {
      const value = curve.y[at] as number;
      const here = Number.isFinite(across) && Number.isFinite(value);
      if (here && dots) context.fillRect(x(across) - 2.5, y(value) - 2.5, 5, 5);
      else if (here && on) context.lineTo(x(across), y(value));
      else if (here) context.moveTo(x(across), y(value));
      on = here;
    });
    context.stroke();
  }
  context.globalAlpha = 1;
}
