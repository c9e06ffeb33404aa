// The breath of a frame: what microphone and keys blow, together.

import type { Air } from '../stage/scene.js';
import { KeyBreath } from './keys.js';

/** Milliseconds for which the microphone's last wind counts; without a newer one it has fallen silent. */
const STALE = 250;

/** When the sound came that a picture shows: for measuring the way from one to the other. */
export interface SoundPath {
  /** blocks of wind that came from the microphone so far */
  heard: number;
  /** the frame of the page in which the latest came, and the one that first used it */
  heardAtFrame: number;
  usedAtFrame: number;
}

export class Breath {
  readonly keys = new KeyBreath();
  readonly path: SoundPath = { heard: 0, heardAtFrame: 0, usedAtFrame: 0 };
  /** of this frame: keys blow across, and whoever blows into the microphone sits where the eye is */
  air: Air = { right: 0, away: 0 };
  private microphone = 0;
  private at = -Infinity;

  /** Wind from the microphone: not negative. It blows from the eye, or from the left at what has no other sides. */
  hear(wind: number, frame: number): void {
    this.microphone = wind;
    this.at = performance.now();
    this.path.heard += 1;
    this.path.heardAtFrame = frame;
  }

  deafen(): void {
    this.microphone = 0;
  }

  /** The breath of this frame, signed towards the right; 1 is strong. */
  update(seconds: number, frame: number): number {
    if (performance.now() - this.at > STALE) this.microphone = 0;
    if (this.path.usedAtFrame < this.path.heardAtFrame) this.path.usedAtFrame = frame;
    this.air = { right: this.keys.update(seconds), away: this.microphone };
    return this.air.right + this.microphone;
  }
}
