// Sound and touch, opt-in: crackle and breath, a phone that vibrates when the flame goes out, tilt.

import { Sound } from './sound.js';
import { Tilt } from './tilt.js';

/** Milliseconds that a phone vibrates when a flame goes out. */
const VIBRATES = 40;

export class Senses {
  private sound: Sound | null = null;
  private readonly tilt = new Tilt();
  private burning = 0;

  get on(): boolean {
    return this.sound !== null;
  }

  /** Wind that tilting makes. */
  get wind(): number {
    return this.tilt.wind;
  }

  /** On or off. To be called from a press or a key: browsers let sound begin only there. */
  toggle(): void {
    if (this.sound !== null) {
      this.sound.close();
      this.sound = null;
      this.tilt.close();
      return;
    }
    this.sound = new Sound();
    // Refused: there is sound without tilt.
    this.tilt.open().catch(() => undefined);
  }

  /** Takes in a frame. `heard`: the microphone listens, and must not hear our own breath. */
  frame(lit: number, of: number, wind: number, heard: boolean): void {
    if (lit < this.burning && this.on) navigator.vibrate?.(VIBRATES);
    this.burning = lit;
    this.sound?.frame(of === 0 ? 0 : lit / of, heard ? 0 : wind);
  }
}
