// Selects what plays: model, scene and settings.

import { fetchPart } from './part.js';
import type { Model, Library } from '@wisp/player';
import { figuresOf } from '@wisp/player/parts/candle/room';
import { CandleScene } from '@wisp/player/parts/candle/scene';
import type { SceneName, Settings } from './link.js';
import { fetchShipped, FLAME, LEAF } from './shipped.js';
import type { Scene, SceneSettings } from '@wisp/player/parts/stage/scene';
import type { Stage } from '@wisp/player/parts/stage/stage';

export interface Playing {
  model: Model;
  bytes: Uint8Array;
  file: string;
  /** false: a dropped file, or the model of a link */
  shipped: boolean;
  /** whether the wind response is borrowed from the shipped flame */
  borrows: boolean;
  scene: Scene;
  /** makes the scene anew, with the current settings */
  make: () => Scene;
  /** tab of the scene; null: none */
  tab: SceneName | null;
}

export class Player {
  playing: Playing | null = null;
  /** number of the latest opening; earlier ones that still load are abandoned */
  private opening = 0;

  constructor(private readonly wisp: Library, private readonly stage: Stage, readonly settings: Settings, private readonly changed: (playing: Playing) => void) {}

  /** Plays the settings' model: that of the link, or the scene's shipped one. Throws on failure. */
  async playChosen(): Promise<void> {
    const { model } = this.settings;
    if (model === '') return this.playShipped();
    const turn = ++this.opening;
    const { fetchModel } = await fetchPart(() => import('./model_link.js'));
    const { bytes, file } = await fetchModel(model);
    if (turn === this.opening) await this.play(bytes, file, false, turn);
  }

  /** Lets a flame learned without wind respond as the shipped one does. */
  async borrowWind(): Promise<void> {
    const { playing } = this;
    if (!(playing?.scene instanceof CandleScene)) return;
    const lender = this.wisp.model(await fetchShipped(FLAME));
    await playing.scene.borrow(lender).finally(() => lender.free());
    if (this.playing === playing && !playing.borrows) {
      playing.borrows = true;
      this.changed(playing);
    }
  }

  /** Plays the shipped model of the settings' scene. Throws where it cannot be fetched. */
  async playShipped(): Promise<void> {
    const file = this.settings.scene === 'leaves' ? LEAF : FLAME;
    const turn = ++this.opening;
    const bytes = await fetchShipped(file);
    if (turn === this.opening) await this.play(bytes, file, true, turn);
  }

  /** Plays a given file. Throws the error of an invalid file; the current model then continues. */
  async playFile(name: string, bytes: Uint8Array): Promise<void> {
    await this.play(bytes, name, false, ++this.opening);
    this.settings.model = '';
  }

  /** Applies changed settings; returns true where they need another model. */
  apply(change: Partial<Settings>): boolean {
    const before = { ...this.settings };
    Object.assign(this.settings, change);
    const { playing } = this;
    const { scene } = this.settings;
    if (change.model !== undefined && change.model !== before.model) return true;
    if (change.scene !== undefined && (scene !== before.scene || scene !== playing?.tab || !playing.shipped)) return true;
    if (playing === null) return false;
    if (this.settings.seed === before.seed) playing.scene.apply(this.sceneSettings(playing.tab));
    else {
      // A scene takes its seed when it is made.
      this.stage.show((playing.scene = playing.make()));
      if (playing.borrows) this.borrowWind().catch(() => undefined);
    }
    this.stage.relabel();
    return false;
  }

  private sceneSettings(tab: SceneName | null): SceneSettings {
    const { seed, noise, candles, leaves, age, name, wish } = this.settings;
    return { seed, noise, count: tab === 'leaves' ? leaves : candles, figures: age > 0 ? figuresOf(String(age)) : '', name, wish };
  }

  private async play(bytes: Uint8Array, file: string, shipped: boolean, turn: number): Promise<void> {
    const model = this.wisp.model(bytes);
    const { make, tab } = await this.sceneOf(model);
    if (turn !== this.opening) return model.free();
    const before = this.playing?.model;
    const scene = make();
    this.stage.show(scene);
    before?.free();
    this.playing = { scene, make, tab, model, bytes, file, shipped, borrows: false };
    this.changed(this.playing);
  }

  private async sceneOf(model: Model): Promise<Pick<Playing, 'make' | 'tab'>> {
    if (model.view === 'outline') return { make: () => new CandleScene(model, this.sceneSettings('candle')), tab: 'candle' };
    if (model.view === 'pose' || model.view === 'position') {
      const { LeavesScene } = await fetchPart(() => import('@wisp/player/parts/leaves/scene'));
      return { make: () => new LeavesScene(model, this.sceneSettings('leaves')), tab: 'leaves' };
    }
    const { PlainScene } = await fetchPart(() => import('./plain/scene.js'));
    return { make: () => new PlainScene(model, this.sceneSettings(null)), tab: null };
  }
}
