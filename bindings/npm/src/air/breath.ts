// Breath per frame, from microphone and keys together.

import type { Air } from '../stage/scene.js';
import { KeyBreath } from './keys.js';

/** Milliseconds for which the microphone's last wind is used; after that it counts as silent. */
const STALE = 250;

/** Numbers of the page's frames in which a block of wind arrived and was first used, for measuring latency. */
export interface SoundPath {
  /** number of wind blocks received from the microphone */
  heard: number;
  /** frame of the page in which the latest block arrived, and the frame that first used it */
  heardAtFrame: number;
  usedAtFrame: number;
}

export class Breath {
  readonly keys = new KeyBreath();
  readonly path: SoundPath = { heard: 0, heardAtFrame: 0, usedAtFrame: 0 };
  /** breath of this frame: keys blow across; the microphone blows from the eye's position */
  air: Air = { right: 0, away: 0 };
  private microphone = 0;
  private at = -Infinity;

  /** Takes wind from the microphone, ≥ 0. It blows from the eye, or from the left in a scene with a fixed view. */
  hear(wind: number, frame: number): void {
    this.microphone = wind;
    this.at = performance.now();
    this.path.heard += 1;
    this.path.heardAtFrame = frame;
  }

  deafen(): void {
    this.microphone = 0;
  }

  /** Updates the keys' breath and returns its sum with the microphone's wind, positive to the right; 1 is strong. */
  update(seconds: number, frame: number): number {
    if (performance.now() - this.at > STALE) this.microphone = 0;
    if (this.path.usedAtFrame < this.path.heardAtFrame) this.path.usedAtFrame = frame;
    this.air = { right: this.keys.update(seconds), away: this.microphone };
    return this.air.right + this.microphone;
  }
}
