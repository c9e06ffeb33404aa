// The microphone of the page: asked for when somebody presses Blow, listened to for wind alone, given back on the next
// press.

import type { Library } from '@wisp/player';
import { MicrophoneError, openMicrophone, type Microphone, type MicrophoneTrouble } from '@wisp/player/microphone';
import type { Hearing } from '../panel/controls.js';

/** Seconds that the room is listened to before it counts. */
const CALIBRATION = 3;

/** A room that is so much louder than it was, dB, has something steady in it that passes for wind. */
const LOUDER = 6;

const STEADY =
  'It has become louder here since I listened to the room: a fan, rain or an engine may pass for breath. Press Blow twice to listen anew.';

export interface EarEvents {
  wind(wind: number): void;
  /** something went wrong, in words for people */
  trouble(words: string): void;
  /** it hears no more, for whatever reason */
  ended(): void;
}

const ELSE = ' Until then a quick move past the flame makes wind too.';

const WORDS: Readonly<Record<MicrophoneTrouble, string>> = {
  unsupported: 'Browsers give a microphone only to pages that come over HTTPS, or from this very machine.' + ELSE,
  denied: 'The microphone was not allowed. It can be allowed in the address bar.' + ELSE,
  none: 'No microphone was found. Plug one in and press Blow again.' + ELSE,
  busy: 'Another program holds the microphone. Close it there and press Blow again.' + ELSE,
  lost: 'The microphone is gone. Press Blow when it is back.' + ELSE,
  failed: 'The microphone could not be used.' + ELSE,
};

export class Ear {
  state: Hearing = 'off';
  private microphone: Microphone | null = null;
  private wind = 0;
  private since = 0;
  private louder = false;
  /** counts openings: one that was closed again before it was allowed is dropped */
  private turn = 0;

  constructor(
    private readonly wisp: Library,
    private readonly events: EarEvents,
  ) {}

  /** How far the calibration is, or how strong the breath is: 0 to 1. */
  get level(): number {
    if (this.state === 'calibrating') return (performance.now() - this.since) / 1000 / CALIBRATION;
    return this.state === 'listening' ? this.wind / 1.5 : 0;
  }

  /** Asks for the microphone. Resolves when it listens, or does not. */
  async open(): Promise<void> {
    if (this.state !== 'off') return;
    const turn = ++this.turn;
    this.state = 'asking';
    try {
      const microphone = await openMicrophone(this.wisp, {
        calibrate: CALIBRATION,
        onWind: ({ wind, roomRise, calibrating }) => {
          this.hear(wind, calibrating);
          this.watchRoom(roomRise);
        },
        onLost: (error) => this.fail(error),
      });
      if (turn !== this.turn) {
        microphone.stop();
        return;
      }
      this.microphone = microphone;
      this.state = 'calibrating';
      this.since = performance.now();
      if (!microphone.raw) {
        this.events.trouble('This browser or system smooths the sound of the microphone: blow a little harder.');
      }
    } catch (error) {
      if (turn === this.turn) this.fail(error);
    }
  }

  /** Gives the microphone back. */
  close(): void {
    this.turn += 1;
    this.microphone?.stop();
    this.microphone = null;
    this.state = 'off';
    this.wind = 0;
    this.events.ended();
  }

  private hear(wind: number, calibrating: boolean): void {
    this.wind = calibrating ? 0 : wind;
    if (this.microphone !== null) this.state = calibrating ? 'calibrating' : 'listening';
    if (!calibrating) this.events.wind(wind);
  }

  /** Says once that something steady has begun since the room was learned. */
  private watchRoom(rise: number): void {
    if (rise >= LOUDER && !this.louder) this.events.trouble(STEADY);
    this.louder = rise >= LOUDER;
  }

  private fail(error: unknown): void {
    this.close();
    this.events.trouble(WORDS[error instanceof MicrophoneError ? error.trouble : 'failed']);
  }
}
