// A scrolling plot of the last seconds of one number.

import { element } from './element.js';

/** Number of values shown. */
const KEPT = 360;

/** Colours of a line in the dark and the light drawer. */
type Ink = readonly [night: string, day: string];

const day = window.matchMedia('(prefers-color-scheme: light)');
const ZERO: Ink = ['rgb(255 240 220 / 22%)', 'rgb(60 40 20 / 26%)'];
const shade = ([night, light]: Ink): string => (day.matches ? light : night);

export class Plot {
  private readonly canvas = element('canvas', { class: 'plot', 'aria-hidden': 'true' });
  private readonly output = element('output');
  /** name and mean, and below them the line */
  readonly parts: readonly HTMLElement[];
  private readonly values: number[] = [];

  /** `least`: minimum range of the axis, as low and high end; `samples`: number of last values whose mean is shown. */
  constructor(
    words: string,
    private readonly colour: Ink,
    private readonly least: readonly [number, number],
    private readonly samples = 4,
    private readonly unit = '',
  ) {
    this.parts = [element('div', { class: 'plot-line' }, element('span', {}, words), this.output), this.canvas];
  }

  push(value: number): void {
    this.values.push(value);
    if (this.values.length > KEPT) this.values.shift();
  }

  draw(): void {
    const { values } = this;
    const last = values.slice(-this.samples);
    this.output.value = `${(last.reduce((sum, value) => sum + value, 0) / Math.max(1, last.length)).toFixed(2)}${this.unit}`;
    const context = this.canvas.getContext('2d');
    if (context === null) return;
    const share = Math.min(2, window.devicePixelRatio);
    const width = Math.round(this.canvas.clientWidth * share);
    const height = Math.round(this.canvas.clientHeight * share);
    if (this.canvas.width !== width || this.canvas.height !== height) {
      this.canvas.width = width;
      this.canvas.height = height;
    }
    context.clearRect(0, 0, width, height);
    const [low, high] = [Math.min(this.least[0], ...values), Math.max(this.least[1], ...values)];
    const y = (value: number): number => height - 3 - ((value - low) / (high - low || 1)) * (height - 6);
    context.strokeStyle = shade(ZERO);
    context.lineWidth = 1;
    context.beginPath();
    context.moveTo(0, Math.round(y(0)) + 0.5);
    context.lineTo(width, Math.round(y(0)) + 0.5);
    context.stroke();
    context.strokeStyle = shade(this.colour);
    context.lineWidth = 1.6 * share;
    context.lineJoin = 'round';
    context.beginPath();
    values.forEach((value, k) => context.lineTo(width - ((values.length - 1 - k) / (KEPT - 1)) * width, y(value)));
    context.stroke();
  }
}
