// Placeholder before a film is chosen: a live flame with an outline and its control points.

import type { Bank, Instance, Library } from '@wisp/player';
import { FrameLoop } from '@wisp/player/parts/stage/frame_loop';
import { element } from '../../panel/element.js';
import { paintFlame } from './flame_paint.js';
import { stroke, surfaceOf, WHOLE } from './surface.js';

const POINTS = 64;
const NANOSECONDS = 1e9;
/** Height of the flame as a share of the canvas's. */
const HEIGHT = 0.5;

export class Invitation {
  readonly canvas = element('canvas', { class: 'invitation', role: 'img', 'aria-label': 'A flame, with the outline and the eight points that are learned of it' });
  private bank: Bank | null = null;
  private flame: Instance = 0n;
  readonly loop = new FrameLoop((passed) => this.frame(passed));
  private clock = 0;
  private readonly still = window.matchMedia('(prefers-reduced-motion: reduce)').matches;

  constructor(private readonly wisp: Library) {}

  /** Shows a live flame of a model. */
  fill(model: Uint8Array): void {
    const made = this.wisp.model(model);
    this.bank = made.bank({ polylinePoints: POINTS });
    this.flame = this.bank.spawn();
    made.free();
  }

  private frame(passed: number): void {
    const seconds = Math.min(0.1, passed);
    this.clock += seconds;
    const { bank } = this;
    const surface = surfaceOf(this.canvas);
    if (bank === null || surface === null) return;
    // An occasional breath.
    const breath = this.still ? 0 : Math.max(0, Math.sin(0.9 * this.clock)) ** 3 * 0.55;
    if (bank.inputs > 0) bank.setInstanceInputs(this.flame, [breath]);
    bank.advance(seconds * NANOSECONDS);
    const { context, width, height } = surface;
    const unit = HEIGHT * height;
    const foot = 0.5 * height + 0.5 * unit;
    const placed = (values: Float32Array): Float32Array => values.map((value, k) => (k % 2 === 0 ? width / 2 + unit * value : foot - unit * value));
    context.globalAlpha = 0.34;
    const line = placed(bank.polyline(this.flame));
    paintFlame(context, line, unit);
    context.globalAlpha = 1;
    const points = placed(bank.instanceOutputs(this.flame));
    context.setLineDash([3, 5]);
    stroke(context, points, WHOLE, 'rgb(255 240 220 / 22%)', 1);
    context.setLineDash([]);
    stroke(context, line, WHOLE, '#7fe3ff', 2);
    context.fillStyle = '#f3ece2';
    for (let k = 0; k < points.length; k += 2) {
      context.beginPath();
      context.arc(points[k] as number, points[k + 1] as number, 3, 0, 2 * Math.PI);
      context.fill();
    }
  }
}
