// Plays a learned outline along a recording's wind, row by row, at the film's scale.

import type { Bank, Instance, Library } from '@wisp/player';
import { FlameShape, MAX_POINTS } from '@wisp/player/parts/candle/flame_shape';
import type { Outlines } from './outlines.js';

/** Maximum number of rows played to reach a later row; for a row further ahead the model is reset and starts there. */
const JUMP = 240;

export class Play {
  private readonly bank: Bank;
  private readonly flame: Instance;
  private readonly unit: number;
  private readonly hasWind: boolean;
  /** recorded wind that equals 1 in the model */
  private readonly one: number;
  private readonly burns: boolean;
  private readonly shape = new FlameShape();
  private row = -1;

  constructor(wisp: Library, private readonly outlines: Outlines, bytes: Uint8Array) {
    const model = wisp.model(bytes);
    this.bank = model.bank({ polylinePoints: MAX_POINTS });
    this.flame = this.bank.spawn();
    this.hasWind = model.inputs.length > 0 && outlines.wind !== null;
    this.burns = model.facts.blowOut !== null;
    this.unit = model.provenance.figures.find(({ name }) => name === 'pixels_per_unit')?.value ?? outlines.height;
    // The unit "0.95 m/s" of an input means that 1 in the model is 0.95 m/s in the recording.
    this.one = parseFloat(model.inputs[0]?.unit ?? '') || 1;
    model.free();
  }

  /** Size of the flame, 0 to 1. */
  get size(): number { return this.burns ? this.bank.flameState(this.flame).flameSize : 1; }

  /** Plays to a row; restarts for an earlier row or one far ahead. */
  goTo(row: number): void {
    if (row < this.row || row > this.row + JUMP) {
      this.bank.reset(this.flame);
      this.row = row - 1;
    }
    while (this.row < row) {
      this.row += 1;
      if (this.hasWind) this.bank.setInstanceInputs(this.flame, [(this.outlines.wind?.[this.row] || 0) / this.one]);
      // Relights the flame while the film shows one.
      if (this.burns && !this.bank.flameState(this.flame).lit && this.filmBurns()) this.bank.relight(this.flame);
      this.bank.step();
    }
  }

  /** Outline in pixels of the film, x and y alternating. */
  line(): Float32Array {
    const { x, y } = this.outlines.base;
    this.shape.update(this.bank.polyline(this.flame), this.size);
    return this.shape.placed(this.unit, x, y);
  }

  free(): void { this.bank.free(); }

  // Whether the film shows a flame in weak wind: it then did not go out in the gust before, or was lit again.
  private filmBurns(): boolean {
    const { lean, wind } = this.outlines;
    return Number.isFinite(lean[this.row]) && (wind?.[this.row] ?? 0) < 0.2;
  }
}
