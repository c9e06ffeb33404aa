// For lessons: flames of several orders, and one without noise, side by side in the same wind as the large one.

import type { Bank, Instance, Model, Library } from '@wisp/player';
import { FlameShape } from '@wisp/player/parts/candle/flame_shape';
import { ORDERS } from '../link.js';
import { fetchShipped, shippedFlame } from '../shipped.js';
import { element } from './element.js';

const POINTS = 40;
const NANOSECONDS = 1e9;
/** Frames of the tip's way that are drawn below each flame. */
const TRACE = 240;

/** One of the flames. */
interface Pupil {
  bank: Bank;
  instance: Instance;
  canvas: HTMLCanvasElement;
  trace: Float32Array;
  shape: FlameShape;
}

export class Lesson {
  readonly place = element('div', { class: 'lesson' });
  private readonly pupils: Pupil[] = [];
  private gone = false;

  constructor(private readonly wisp: Library, seed: number) {
    void this.bring(seed).catch((error: unknown) => {
      this.place.textContent = error instanceof Error ? error.message : String(error);
    });
  }

  /** Takes in a frame: the wind that the large flame felt. */
  frame(wind: number, seconds: number): void {
    for (const pupil of this.pupils) {
      const { bank, instance, trace, shape } = pupil;
      bank.setInstanceInputs(instance, [wind]);
      bank.advance(seconds * NANOSECONDS);
      const state = bank.flameState(instance);
      // Whoever learns watches how it lives: what went out burns again.
      if (!state.lit && state.sinceOut > NANOSECONDS) bank.relight(instance);
      const outline = bank.polyline(instance);
      shape.update(outline, state.flameSize);
      trace.copyWithin(0, 1);
      trace[TRACE - 1] = shape.tipX;
      draw(pupil, outline);
    }
  }

  dispose(): void {
    this.gone = true;
    for (const { bank } of this.pupils.splice(0)) bank.free();
  }

  private async bring(seed: number): Promise<void> {
    const files = await Promise.all(ORDERS.map((order) => fetchShipped(shippedFlame(order))));
    if (this.gone) return;
    const models = files.map((bytes) => this.wisp.model(bytes));
    ORDERS.forEach((order, k) => this.add(`Order ${order}`, models[k] as Model, seed, 1));
    this.add(`Order ${ORDERS[1] as number}, no noise`, models[1] as Model, seed, 0);
    for (const model of models) model.free();
  }

  private add(words: string, model: Model, seed: number, noise: number): void {
    const bank = model.bank({ polylinePoints: POINTS, seed });
    bank.setNoise(noise);
    const canvas = element('canvas', { width: 150, height: 240, role: 'img', 'aria-label': `${words}: a flame in the same wind, and the way of its tip` });
    this.place.append(element('figure', {}, canvas, element('figcaption', {}, words)));
    this.pupils.push({ bank, instance: bank.spawn(), canvas, trace: new Float32Array(TRACE), shape: new FlameShape() });
  }
}

function draw({ canvas, trace }: Pupil, outline: Float32Array): void {
  const context = canvas.getContext('2d');
  if (context === null) return;
  const { width, height } = canvas;
  const unit = 0.55 * height;
  const foot = 0.68 * height;
  context.clearRect(0, 0, width, height);
  context.fillStyle = '#ffb35c';
  context.beginPath();
  for (let k = 0; k < outline.length; k += 2) context.lineTo(width / 2 + unit * (outline[k] as number), foot - unit * (outline[k + 1] as number));
  context.fill();
  context.strokeStyle = '#7fc4ff';
  context.lineWidth = 1.5;
  context.beginPath();
  trace.forEach((tip, k) => context.lineTo((k / (TRACE - 1)) * width, 0.86 * height - 0.26 * height * tip));
  context.stroke();
}
