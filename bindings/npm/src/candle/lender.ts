// Lends one flame model's response to wind to another model that was learned without wind: the outline's displacement
// from rest, and extinction.

import type { Bank, FlameState, Instance, Model } from '../index.js';

/** Flame size below which the lending outline is too small to show its displacement. */
const MIN_SIZE = 0.05;
const SETTLES = 2e9;

export class Lender {
  readonly bank: Bank;
  private readonly rest: Float32Array;
  private readonly moved: Float32Array;

  constructor(model: Model, capacity: number, points: number) {
    this.bank = model.bank({ capacity, polylinePoints: points });
    // Noise off: the borrowing model has its own.
    this.bank.setNoise(0);
    const still = this.bank.spawn();
    this.bank.advance(SETTLES);
    this.rest = this.bank.polyline(still).slice();
    this.moved = new Float32Array(this.rest.length);
    this.bank.end(still);
  }

  /** Returns a borrowing flame's outline with the displacement of a lending instance. `own`: outline in still air. */
  lend(instance: Instance, own: Float32Array, state: Readonly<FlameState>): Float32Array {
    const { moved, rest } = this;
    moved.set(own);
    const size = state.flameSize;
    const lent = this.bank.polyline(instance);
    const height = heightOf(moved) / heightOf(rest);
    for (let k = 0; k < moved.length; ++k) {
      const shift = size > MIN_SIZE ? (lent[k] as number) / size - (rest[k] as number) : 0;
      moved[k] = size * ((moved[k] as number) + height * shift);
    }
    return moved;
  }
}

function heightOf(outline: Float32Array): number {
  let height = 0.1;
  for (let k = 1; k < outline.length; k += 2) height = Math.max(height, outline[k] as number);
  return height;
}
