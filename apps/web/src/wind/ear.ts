// The microphone of the page: asked for when somebody presses Blow, listened to for wind alone, given back on the next
// press.

import type { Library } from '@wisp/player';
import { MicrophoneError, openMicrophone, type Microphone, type MicrophoneTrouble, type Wind } from '@wisp/player/microphone';
import type { Hearing } from '../panel/controls.js';

/** A room that is so much louder than it was, dB, has something steady in it that passes for wind. */
const LOUDER = 6;

/** Wind at which a blow begins, and at which it is over. */
const BLOW = { from: 0.35, to: 0.1 };

/** Sound as loud as this (RMS of the wind's band), for so long without a gap, counts as a blow whatever it sounds like. */
const LOUD = { level: 0.03, seconds: 0.4 };

/** Blows that put nothing out until tuning is offered. */
const VAIN_BLOWS = 3;

/** Share of samples at full scale from which a microphone is too sensitive to tell soft from hard by itself. */
const CLIPPED = 0.02;

/** While Tune waits for a blow, sound that exceeds the quietest by this much is taken for it, even without a blow's spectrum. */
const RISES: Readonly<Record<Asked, number>> = { 'breathe gently': 3, 'blow hard': 5 };
/** Frames before a step that say how quiet it is; sound below this says nothing: microphones open with silence. */
const READY = 60;
const SILENT = 3e-4;

const shareOf = (values: readonly number[], share: number): number => [...values].sort((a, b) => a - b)[Math.floor(share * values.length)] ?? 0;

/** By loudness alone: from this share of the loud blow on, for so many seconds, it blows; the loud blow itself is that strong. */
const PLAIN = { share: 0.4, seconds: 0.12, strong: 1.8 };

const HISS =
  'Blowing is hardly more than a hiss at this microphone, so from now on it goes by loudness: loud words may put it out too.';

const STEADY = 'It has become louder here: a fan, rain or an engine may pass for breath. ';

export interface EarEvents {
  wind(wind: number): void;
  /** something went wrong, in words for people */
  trouble(words: string): void;
  /** it hears no more, for whatever reason */
  ended(): void;
  /** tuning to this microphone and this breath would help: said at most once, and why */
  untuned(why: 'too hard' | 'too easy'): void;
}

/** What a guided calibration asks for. */
export type Asked = Parameters<Microphone['calibrate']>[0];

type Calibration = Awaited<ReturnType<Microphone['calibration']>>;

const ELSE = ' Until then a quick move past the flame makes wind too.';

const WORDS: Readonly<Record<MicrophoneTrouble, string>> = {
  unsupported: 'Browsers give a microphone only to pages that come over HTTPS, or from this very machine.',
  denied: 'The microphone was not allowed. It can be allowed in the address bar.',
  none: 'No microphone was found. Plug one in and press Blow again.',
  busy: 'Another program holds the microphone. Close it there and press Blow again.',
  lost: 'The microphone is gone. Press Blow when it is back.',
  failed: 'The microphone could not be used.',
};

/** An overlay has no button, and OBS no address bar. */
const IN_OVERLAY: Partial<typeof WORDS> = {
  denied: 'The microphone was not allowed. OBS allows it when it is started with --enable-media-stream.',
  none: 'No microphone was found. Plug one in and load this page again.',
  busy: 'Another program holds the microphone. Close it there and load this page again.',
  lost: 'The microphone is gone. Load this page again when it is back.',
};

export class Ear {
  state: Hearing = 'off';
  private microphone: Microphone | null = null;
  private wind = 0;
  private louder = false;
  /** what a guided calibration has found out: kept for when the microphone is opened again */
  private known: Calibration | null = null;
  private device: string | undefined;
  private tuning = false;
  private answer: ((heard: boolean) => void) | null = null;
  /** how strong a breath is, also while nothing of it reaches the scene */
  private heard = 0;
  /** of sound, root mean squares: the quiet before a step of the calibration, what came during a step of the calibration, what a loud blow has
   * where it has no rumble; null: it has */
  private smooth = 0;
  private quiet = 0;
  private stepped: number[] = [];
  private asked: Asked = 'breathe gently';
  private plain: number | null = null;
  private plainSince = 0;
  private blowing = false;
  private loudSince = 0;
  private vain = 0;
  private offered = false;
  /** counts openings: one that was closed again before it was allowed is dropped */
  private turn = 0;

  constructor(
    private readonly wisp: Library,
    private readonly events: EarEvents,
    private readonly overlay: boolean,
  ) {}

  /** How strong the breath is: 0 to 1. */
  get level(): number {
    return this.state === 'listening' ? (this.tuning ? this.heard : this.wind) / 1.5 : 0;
  }

  /** Asks for the microphone. Resolves when it listens, or does not. */
  async open(): Promise<void> {
    if (this.state !== 'off') return;
    const turn = ++this.turn;
    this.state = 'asking';
    try {
      const microphone = await openMicrophone(this.wisp, {
        ...(this.known === null ? {} : { calibration: this.known }),
        ...(this.device === undefined ? {} : { deviceId: this.device }),
        onWind: (frame) => {
          this.hear(frame);
          this.watchRoom(frame.roomRise);
          this.watchBlows(frame);
        },
        onCalibrated: (known, heard) => {
          if (this.tuning && heard) this.known = known;
          this.answered(heard || this.believes());
          if (heard && this.asked === 'blow hard') this.plain = null;
        },
        onAsleep: (asleep) => {
          if (this.state !== 'off') this.state = asleep ? 'asleep' : 'listening';
          if (asleep) this.wind = this.heard = 0;
          if (asleep) this.events.ended();
        },
        onLost: (error) => this.fail(error),
      });
      if (turn !== this.turn) {
        microphone.stop();
        return;
      }
      this.microphone = microphone;
      this.state = 'listening';
      if (!microphone.raw) {
        this.events.trouble('This browser or system smooths the sound of the microphone: blow a little harder.');
      }
    } catch (error) {
      if (turn === this.turn) this.fail(error);
    }
  }

  /** The microphones that there are, by their names, and which one is open; none before one was allowed. */
  async choices(): Promise<{ id: string; name: string; open: boolean }[]> {
    const devices = (await navigator.mediaDevices?.enumerateDevices?.()) ?? [];
    const own = this.microphone?.settings.deviceId;
    return devices.filter(({ kind, label }) => kind === 'audioinput' && label !== '').map(({ deviceId, label }) => ({ id: deviceId, name: label, open: deviceId === own }));
  }

  /** Listens to another one; what was found out of the first is not true of it. */
  async choose(id: string): Promise<void> {
    this.device = id;
    this.known = null;
    this.plain = null;
    this.close();
    await this.open();
  }

  /** Gives the microphone back. */
  close(): void {
    this.turn += 1;
    this.microphone?.stop();
    this.microphone = null;
    this.state = 'off';
    this.wind = 0;
    this.heard = 0;
    this.answered(false);
    this.events.ended();
  }

  /** While a guided calibration is on, what is heard does not blow at anything. */
  tune(on: boolean): void {
    this.tuning = on;
    this.offered = true;
    if (on) this.events.ended();
  }

  /** Listens for one step of the calibration; whether it was heard. Never when the microphone is off. */
  listenFor(asked: Asked, seconds: number): Promise<boolean> {
    this.answered(false);
    this.asked = asked;
    this.quiet = shareOf(this.stepped.slice(-READY), 0.25);
    this.stepped = [];
    if (this.microphone === null) return Promise.resolve(false);
    this.microphone.calibrate(asked, seconds);
    return new Promise((resolve) => (this.answer = resolve));
  }

  /** A candle went out: blowing does something. */
  blownOut(): void {
    this.vain = 0;
    this.blowing = false;
  }

  private answered(heard: boolean): void {
    const answer = this.answer;
    this.answer = null;
    answer?.(heard);
  }

  private hear(frame: Wind): void {
    const { rms, speed, confidence } = frame;
    // A tenth of a second of it: noise by itself is no rise.
    this.smooth += 0.15 * (rms - this.smooth);
    this.stepped.push(this.smooth);
    if (this.stepped.length > 10 * READY) this.stepped.splice(0, READY);
    this.heard = confidence > 0.5 ? speed : 0;
    this.wind = this.tuning ? 0 : Math.max(frame.wind, this.byLoudness(frame));
    if (!this.tuning) this.events.wind(this.wind);
  }

  /** Whoever was asked to blow has blown: what rose above the quiet was that. */
  private believes(): boolean {
    const loud = shareOf(this.stepped, 0.8);
    const rose = loud > RISES[this.asked] * Math.max(SILENT, Math.min(this.quiet, shareOf(this.stepped, 0.1)));
    if (rose && this.tuning && this.asked === 'blow hard') {
      this.plain = loud;
      this.events.trouble(HISS);
    }
    return rose && this.tuning;
  }

  /** Wind from loudness alone, of a microphone that passes no rumble: lasting sound, over the level that Tune recorded. */
  private byLoudness({ rms, time }: Wind): number {
    if (this.plain === null) return 0;
    if (rms < PLAIN.share * this.plain) this.plainSince = time;
    return time - this.plainSince > PLAIN.seconds ? PLAIN.strong * Math.min(1, rms / this.plain) : 0;
  }

  /** Offers tuning where a microphone is overdriven by breath, or where blow after blow puts nothing out. */
  private watchBlows({ wind, clipped, confidence, level, time }: Wind): void {
    if (this.offered || this.tuning || this.state !== 'listening') return;
    if (clipped > CLIPPED && confidence > 0.5) return this.offer('too easy');
    if (this.blowing && wind < BLOW.to && level < LOUD.level && ++this.vain >= VAIN_BLOWS) return this.offer('too hard');
    if (level < LOUD.level) this.loudSince = time;
    const loud = time > this.loudSince + LOUD.seconds;
    if (wind > BLOW.from || loud) this.blowing = true;
    else if (wind < BLOW.to) this.blowing = false;
  }

  private offer(why: 'too hard' | 'too easy'): void {
    this.offered = true;
    this.events.untuned(why);
  }

  /** Says once that something steady has begun since the room was learned. */
  private watchRoom(rise: number): void {
    if (rise >= LOUDER && !this.louder) this.events.trouble(`${STEADY}${this.overlay ? 'Load this page again' : 'Press Blow twice'}, and I take it for the room.`);
    this.louder = rise >= LOUDER;
  }

  private fail(error: unknown): void {
    this.close();
    const trouble = error instanceof MicrophoneError ? error.trouble : 'failed';
    this.events.trouble(((this.overlay && IN_OVERLAY[trouble]) || WORDS[trouble]) + ELSE);
  }
}
