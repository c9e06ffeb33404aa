// The page's microphone: opened by pressing Blow, used for wind only, and released by the next press.

import type { App } from '../app.js';
import { MicrophoneError, openMicrophone, type Microphone, type MicrophoneTrouble, type Wind } from '@wisp/player/microphone';
import type { Hearing } from '../panel/controls.js';

/** Rise of the room's level in dB above which a steady sound may be mistaken for wind. */
const LOUDER = 6;

/** Wind at which a blow begins, and at which it ends. */
const BLOW = { from: 0.35, to: 0.1 };

/** RMS of the wind's band, and seconds without a gap, from which any sound counts as a blow. */
const LOUD = { level: 0.03, seconds: 0.4 };

/** Number of unsuccessful blows after which tuning is offered. */
const VAIN_BLOWS = 3;

/** Share of samples at full scale above which a microphone needs tuning to separate soft from hard. */
const CLIPPED = 0.02;

/** Factors of the quiet level's RMS above which any sound counts as the requested blow during tuning. */
const RISES: Readonly<Record<Asked, number>> = { 'breathe gently': 3, 'blow hard': 5 };
/** Frames before a step that define the quiet level, and its minimum (RMS), since microphones are silent at first. */
const READY = 60;
const SILENT = 3e-4;

const shareOf = (values: readonly number[], share: number): number => [...values].sort((a, b) => a - b)[Math.floor(share * values.length)] ?? 0;

/** Detection by loudness: threshold as a share of the hard blow's RMS, minimum seconds, and wind of the hard blow. */
const PLAIN = { share: 0.4, seconds: 0.12, strong: 1.8 };

const HISS =
  'Blowing is hardly more than a hiss at this microphone, so from now on it goes by loudness: loud words may put it out too.';

const STEADY = 'It has become louder here: a fan, rain or an engine may pass for breath. ';

const UNTUNED = {
  'too hard': 'Blow after blow, and it burns on. It can be tuned to your breath and this microphone.',
  'too easy': 'This microphone is very sensitive: a soft breath may pass for a hard one. It can be tuned to your breath.',
} as const;

/** Requests of a guided calibration. */
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

/** Words for the overlay, which has no button, in OBS, which has no address bar. */
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
  /** result of the guided calibration, kept for the next opening */
  private known: Calibration | null = null;
  private device: string | undefined;
  private tuning = false;
  private answer: ((heard: boolean) => void) | null = null;
  /** strength of breath, also while it does not reach the scene */
  private heard = 0;
  /** RMS of sound: `smooth`: now; `quiet`: before a calibration step; `stepped`: `smooth` of each frame since it began;
   * `plain`: of the hard blow on a microphone without low frequencies, else null */
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
  /** number of the latest opening or closing; an opening that was closed before permission is abandoned */
  private turn = 0;

  constructor(private readonly app: App) {}

  /** Strength of breath: 1 at a wind of 1.5, more in stronger wind; 0 unless it listens. */
  get level(): number {
    return this.state === 'listening' ? (this.tuning ? this.heard : this.wind) / 1.5 : 0;
  }

  /** Requests the microphone. Resolves when it listens or was refused. */
  async open(): Promise<void> {
    if (this.state !== 'off') return;
    const turn = ++this.turn;
    this.state = 'asking';
    try {
      const microphone = await openMicrophone(this.app.wisp, {
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
          if (!asleep) return;
          this.wind = this.heard = 0;
          this.app.breath.deafen();
        },
        onLost: (error) => this.fail(error),
      });
      if (turn !== this.turn) return microphone.stop();
      this.microphone = microphone;
      this.state = 'listening';
      if (!microphone.raw) this.app.notices.say('This browser or system smooths the sound of the microphone: blow a little harder.');
    } catch (error) {
      if (turn === this.turn) this.fail(error);
    }
  }

  /** Names of the available microphones, and which is open; empty before permission. */
  async choices(): Promise<{ id: string; name: string; open: boolean }[]> {
    const devices = (await navigator.mediaDevices?.enumerateDevices?.()) ?? [];
    const own = this.microphone?.settings.deviceId;
    return devices.filter(({ kind, label }) => kind === 'audioinput' && label !== '').map(({ deviceId, label }) => ({ id: deviceId, name: label, open: deviceId === own }));
  }

  /** Switches to another microphone and discards the calibration of the first. */
  async choose(id: string): Promise<void> {
    this.device = id;
    this.known = this.plain = null;
    this.close();
    await this.open();
  }

  /** Releases the microphone. */
  close(): void {
    this.turn += 1;
    this.microphone?.stop();
    this.microphone = null;
    this.state = 'off';
    this.wind = this.heard = 0;
    this.answered(false);
    this.app.breath.deafen();
  }

  /** Begins or ends a guided calibration, during which sound makes no wind. */
  tune(on: boolean): void {
    this.tuning = on;
    this.offered = true;
    if (on) this.app.breath.deafen();
  }

  /** Listens for one step of the calibration. Returns whether the sound was heard; false if the microphone is off. */
  listenFor(asked: Asked, seconds: number): Promise<boolean> {
    this.answered(false);
    this.asked = asked;
    this.quiet = shareOf(this.stepped.slice(-READY), 0.25);
    this.stepped = [];
    if (this.microphone === null) return Promise.resolve(false);
    this.microphone.calibrate(asked, seconds);
    return new Promise((resolve) => (this.answer = resolve));
  }

  /** Resets the number of unsuccessful blows, as a candle went out. */
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
    // Averaged over a tenth of a second, so that noise alone is no rise.
    this.smooth += 0.15 * (rms - this.smooth);
    this.stepped.push(this.smooth);
    if (this.stepped.length > 10 * READY) this.stepped.splice(0, READY);
    this.heard = confidence > 0.5 ? speed : 0;
    this.wind = this.tuning ? 0 : Math.max(frame.wind, this.byLoudness(frame));
    if (!this.tuning) this.app.breath.hear(this.wind, this.app.stage.frames);
  }

  /** Whether sound above the quiet level may be taken for the requested blow. Stores the loudness of a hard blow. */
  private believes(): boolean {
    const loud = shareOf(this.stepped, 0.8);
    const rose = loud > RISES[this.asked] * Math.max(SILENT, Math.min(this.quiet, shareOf(this.stepped, 0.1)));
    if (rose && this.tuning && this.asked === 'blow hard') {
      this.plain = loud;
      this.app.notices.say(HISS);
    }
    return rose && this.tuning;
  }

  /** Wind from loudness alone, for microphones without low frequencies: lasting sound above PLAIN.share of `plain`. */
  private byLoudness({ rms, time }: Wind): number {
    if (this.plain === null) return 0;
    if (rms < PLAIN.share * this.plain) this.plainSince = time;
    return time - this.plainSince > PLAIN.seconds ? PLAIN.strong * Math.min(1, rms / this.plain) : 0;
  }

  /** Offers tuning where breath overdrives a microphone, or where several blows extinguish nothing. */
  private watchBlows({ wind, clipped, confidence, level, time }: Wind): void {
    if (this.offered || this.tuning || this.state !== 'listening') return;
    if (clipped > CLIPPED && confidence > 0.5) return this.offer('too easy');
    if (this.blowing && wind < BLOW.to && level < LOUD.level && ++this.vain >= VAIN_BLOWS) return this.offer('too hard');
    if (level < LOUD.level) this.loudSince = time;
    const loud = time > this.loudSince + LOUD.seconds;
    if (wind > BLOW.from || loud) this.blowing = true;
    else if (wind < BLOW.to) this.blowing = false;
  }

  /** Offers tuning, at most once. */
  private offer(why: keyof typeof UNTUNED): void {
    this.offered = true;
    this.app.notices.say(UNTUNED[why], { words: 'Tune it to my breath', accept: () => this.app.parts?.tuning.open() });
  }

  /** Says that a steady sound has begun since the room's level was learned, each time the rise reaches LOUDER. */
  private watchRoom(rise: number): void {
    if (rise >= LOUDER && !this.louder) this.app.notices.say(`${STEADY}${this.app.overlay ? 'Load this page again' : 'Press Blow twice'}, and I take it for the room.`);
    this.louder = rise >= LOUDER;
  }

  private fail(error: unknown): void {
    this.close();
    const trouble = error instanceof MicrophoneError ? error.trouble : 'failed';
    // A chosen microphone that is not there: the next opening takes whichever there is.
    if (trouble === 'none' && this.device !== undefined) [this.device, this.known, this.plain] = [undefined, null, null];
    this.app.notices.say(((this.app.overlay && IN_OVERLAY[trouble]) || WORDS[trouble]) + ELSE);
  }
}
