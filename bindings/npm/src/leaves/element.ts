// <wisp-leaves>: falling leaves, for any page.

import type { Model } from '../index.js';
import { define, numberOf, SceneElement, type SceneAttributes } from '../stage/element.js';
import type { Scene, SceneSettings } from '../stage/scene.js';
import { MAX_LEAVES } from './limits.js';
import { LeavesScene } from './scene.js';

const USUAL = 200;

/** Attributes in addition to those of every scene: `leaves`, 1 to 10000. Events: `load`, `error`. */
export class WispLeaves extends SceneElement {
  protected readonly usualModel = null;

  protected sceneOf(model: Model, settings: SceneSettings): Promise<Scene> {
    if (model.view !== 'pose' && model.view !== 'position') throw new Error(`${model.name || 'This model'} has no pose to fall with.`);
    return Promise.resolve(new LeavesScene(model, settings));
  }

  protected count(): number {
    return Math.round(numberOf(this, 'leaves', 1, MAX_LEAVES, USUAL));
  }
}

define('wisp-leaves', WispLeaves);

declare global {
  interface HTMLElementTagNameMap { 'wisp-leaves': WispLeaves }
  namespace JSX {
    interface IntrinsicElements { 'wisp-leaves': SceneAttributes & { leaves?: number | string } }
  }
}
