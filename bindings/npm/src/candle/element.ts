// <wisp-candle>: a candle, or a cake with several, for any page.

import type { Model } from '../index.js';
import { define, numberOf, SceneElement, type SceneAttributes } from '../stage/element.js';
import type { Scene, SceneSettings } from '../stage/scene.js';
import { MAX_CANDLES } from './room.js';
import { CandleScene } from './scene.js';

/**
 * Attributes in addition to those of every scene: `candles`, 1 to 100. Events: `load`, `error`, `extinguish` when the
 * last flame goes out, `light` when all burn again.
 */
export class WispCandle extends SceneElement {
  protected readonly usualModel = new URL('../models/flame.wisp', import.meta.url);
  private lit = true;

  /** Number of burning candles, and of all candles. */
  get burning(): { lit: number; of: number } {
    return this.scene instanceof CandleScene ? this.scene.burning() : { lit: 0, of: 0 };
  }

  protected sceneOf(model: Model, settings: SceneSettings): Promise<Scene> {
    if (model.view !== 'outline') throw new Error(`${model.name || 'This model'} is no flame: its outputs are no outline.`);
    return Promise.resolve(new CandleScene(model, settings));
  }

  protected count(): number {
    return Math.round(numberOf(this, 'candles', 1, MAX_CANDLES, 1));
  }

  protected override watch(): void {
    const { lit, of } = this.burning;
    const now = this.lit ? lit > 0 || of === 0 : lit === of;
    if (now === this.lit) return;
    this.lit = now;
    this.stage?.relabel();
    this.dispatchEvent(new Event(now ? 'light' : 'extinguish'));
  }
}

define('wisp-candle', WispCandle);

declare global {
  interface HTMLElementTagNameMap { 'wisp-candle': WispCandle }
  namespace JSX {
    interface IntrinsicElements { 'wisp-candle': SceneAttributes & { candles?: number | string } }
  }
}
