// Opens a microphone as a source of wind. No permission is requested before `openMicrophone()` is called, and no sound
// leaves the audio thread: only wind does.

import type { Library } from './library.js';
import { windAsks, type WindAsk, type WindCalibration } from './wind.js';
import type { WindCommand, WindMessage, WindProcessorOptions } from './worklet.js';

/** A frame of wind, as posted by the worklet. */
export type Wind = Extract<WindMessage, { type: 'wind' }>;

/**
 * Reason why a microphone gives no wind.
 * 'unsupported': no microphones or no AudioWorklet here (a page needs HTTPS, or localhost). 'denied': the user or the
 * page's policy refused. 'none': no microphone is connected. 'busy': another program uses it. 'lost': it was unplugged
 * or taken away. 'failed': another reason.
 */
export type MicrophoneTrouble = 'unsupported' | 'denied' | 'none' | 'busy' | 'lost' | 'failed';

export class MicrophoneError extends Error {
  constructor(readonly trouble: MicrophoneTrouble, message: string, options?: ErrorOptions) {
    super(message, options);
    this.name = 'MicrophoneError';
  }
}

export interface MicrophoneOptions {
  /** Frames of wind per second, best the model's own rate. Default 60. */
  frameRate?: number;
  /** Called with each frame. */
  onWind?: (wind: Wind) => void;
  /** Called once when the microphone disappears or the estimator fails; the microphone is then closed. */
  onLost?: (error: MicrophoneError) => void;
  /**
   * Called when sound stops although the microphone is open (a telephone call, a locked screen, a muted track), and
   * when it returns. Sound resumes at the next click or key, or when the page becomes visible.
   */
  onAsleep?: (asleep: boolean) => void;
  /** Called at the end of a calibration; `heard`: whether the requested sound was heard. */
  onCalibrated?: (calibration: WindCalibration, heard: boolean) => void;
  /** Earlier calibration of this microphone and room. */
  calibration?: WindCalibration;
  /** An audio context of the caller; `stop()` does not close it. */
  context?: AudioContext;
  /** Id of the microphone, as from `navigator.mediaDevices.enumerateDevices()`. */
  deviceId?: string;
  /** Address of the worklet's script, if not beside this one. */
  workletUrl?: URL | string;
}

/** Requested settings as applied by the browser; null where the browser does not report one. */
export interface MicrophoneSettings {
  echoCancellation: boolean | null;
  noiseSuppression: boolean | null;
  autoGainControl: boolean | null;
  sampleRate: number;
  label: string;
  deviceId: string;
}

const troubleOf: Record<string, [MicrophoneTrouble, string]> = {
  NotAllowedError: ['denied', 'The microphone was not allowed. Allow it in the settings of this page to blow.'],
  SecurityError: ['denied', 'This page may not use a microphone.'],
  NotFoundError: ['none', 'No microphone was found. Plug one in to blow.'],
  OverconstrainedError: ['none', 'That microphone is not there.'],
  NotReadableError: ['busy', 'The microphone cannot be read; another program may be using it.'],
  AbortError: ['busy', 'The microphone could not be started.'],
};

function refusal(error: unknown): MicrophoneError {
  if (error instanceof MicrophoneError) return error;
  const name = error instanceof Error || error instanceof DOMException ? error.name : '';
  const [trouble, message] = troubleOf[name] ?? ['failed', `The microphone could not be opened: ${String(error)}`];
  return new MicrophoneError(trouble, message, { cause: error });
}

/** Turns off the browser's speech processing, which would suppress wind as noise. */
const RAW = { echoCancellation: false, noiseSuppression: false, autoGainControl: false };

function settingsOf(track: MediaStreamTrack, context: AudioContext): MicrophoneSettings {
  const found = track.getSettings();
  return {
    echoCancellation: typeof found.echoCancellation === 'boolean' ? found.echoCancellation : null,
    noiseSuppression: found.noiseSuppression ?? null,
    autoGainControl: found.autoGainControl ?? null,
    sampleRate: context.sampleRate,
    label: track.label,
    deviceId: found.deviceId ?? '',
  };
}

/** Milliseconds between checks for sound; soundless checks in a row above which it is asleep, and is reopened. */
const LOOK_EVERY = 500;
const ASLEEP = 2;
const STUCK = 4;

/** Events that may resume an interrupted sound. */
const WAKES = ['pointerdown', 'keydown', 'visibilitychange'] as const;

export type Microphone = Readonly<Pick<OpenMicrophone, 'settings' | 'raw' | 'asleep' | 'latest' | 'calibrate' | 'calibration' | 'reset' | 'stop'>>;

class OpenMicrophone {
  settings!: MicrophoneSettings;
  /** Whether the microphone is open but gives no sound. */
  asleep = false;
  /** The latest frame; null before the first. */
  latest: Wind | null = null;
  private node!: AudioWorkletNode;
  private source!: MediaStreamAudioSourceNode;
  private track!: MediaStreamTrack;
  private readonly asked: { resolve(known: WindCalibration): void; reject(error: MicrophoneError): void }[] = [];
  private open = true;
  private silentLooks = 0;
  private reopening = false;
  private readonly looks: ReturnType<typeof setInterval>;
  private known: WindCalibration | undefined; // for a microphone that is opened again

  constructor(
    private readonly wisp: Library,
    private stream: MediaStream,
    private context: AudioContext,
    private readonly options: MicrophoneOptions,
  ) {
    this.known = options.calibration;
    this.attach();
    this.looks = setInterval(() => this.look(), LOOK_EVERY);
    navigator.mediaDevices.addEventListener('devicechange', this.devicesChanged);
    for (const name of WAKES) document.addEventListener(name, this.wake, { capture: true, passive: true });
  }

  private attach(): void {
    const { wisp, context, options, stream } = this;
    this.track = stream.getAudioTracks()[0]!;
    this.settings = settingsOf(this.track, context);
    const processorOptions: WindProcessorOptions = { module: wisp.module, frameRate: options.frameRate ?? 60 };
    if (this.known) processorOptions.calibration = this.known;
    this.node = new AudioWorkletNode(context, 'wisp-wind', { numberOfInputs: 1, numberOfOutputs: 0, processorOptions });
    this.node.port.onmessage = (event: MessageEvent<WindMessage>) => this.hear(event.data);
    this.node.onprocessorerror = () => this.lose('failed', 'The wind could not be worked out from the sound.');
    this.source = context.createMediaStreamSource(stream);
    this.source.connect(this.node);
    this.track.addEventListener('ended', this.ended);
    context.addEventListener('statechange', this.wake);
    for (const _ of this.asked) this.tell({ type: 'tell calibration' }); // the previous worklet did not answer
  }

  private detach(): void {
    this.track.removeEventListener('ended', this.ended);
    this.context.removeEventListener('statechange', this.wake);
    this.tell({ type: 'stop' });
    this.node.port.onmessage = null;
    this.source.disconnect();
    release(this.stream, this.context, this.options);
  }

  private readonly wake = (): void => {
    if (this.asleep && this.context.state !== 'closed') this.context.resume().catch(() => {});
  };

  /** Checks whether sound came since the last check. A muted track sends silence and counts as none. */
  private look(): void {
    this.silentLooks += 1;
    const asleep = this.silentLooks > ASLEEP || this.track.muted;
    if (asleep !== this.asleep) {
      this.asleep = asleep;
      this.options.onAsleep?.(asleep);
    }
    if (!asleep) return;
    this.wake();
    // A running context with a stopped clock does not recover: it is opened again.
    const stuck = this.context.state === 'running' && !this.track.muted && this.silentLooks > STUCK;
    if (stuck && document.visibilityState === 'visible') void this.reopen();
  }

  private async reopen(): Promise<void> {
    if (this.reopening || this.options.context !== undefined) return;
    this.reopening = true;
    try {
      const [stream, context] = await openSound(this.options, (...sound) => sound);
      if (!this.open) return release(stream, context, this.options);
      this.detach();
      [this.stream, this.context] = [stream, context];
      this.attach();
      this.silentLooks = 0;
    } catch (error) {
      const { trouble, message } = refusal(error);
      this.lose(trouble, message);
    } finally {
      this.reopening = false;
    }
  }

  /** Whether the sound is unprocessed: none of the browser's speech processing is known to be on. */
  get raw(): boolean {
    const { echoCancellation, noiseSuppression, autoGainControl } = this.settings;
    return !echoCancellation && !noiseSuppression && !autoGainControl;
  }

  /**
   * Listens for 0.5 to 30 s for the requested sound; `onCalibrated` reports whether it was heard. Calibrate
   * with both sounds in turn if a sensitive microphone turns soft breath into strong wind. Throws a RangeError for
   * another sound, or a time that is not a number; the microphone goes on.
   */
  calibrate(ask: WindAsk, seconds = 3): void {
    if (!windAsks.includes(ask) || isNaN(seconds)) throw new RangeError(`A microphone is not calibrated by '${ask}' for ${seconds} seconds.`);
    this.tell({ type: 'calibrate', seconds, ask: windAsks.indexOf(ask) });
  }

  /** Current calibration of microphone and room. Rejects with a MicrophoneError if the microphone is closed. */
  calibration(): Promise<WindCalibration> {
    return new Promise((resolve, reject) => {
      if (!this.open) return reject(closed());
      this.asked.push({ resolve, reject });
      this.tell({ type: 'tell calibration' });
    });
  }

  reset(): void {
    this.known = undefined;
    this.tell({ type: 'reset' });
  }

  /** Closes the microphone; the browser's indicator goes out. May be called twice. */
  stop(): void {
    if (!this.open) return;
    this.open = false;
    clearInterval(this.looks);
    navigator.mediaDevices.removeEventListener('devicechange', this.devicesChanged);
    for (const name of WAKES) document.removeEventListener(name, this.wake, { capture: true });
    this.detach();
    for (const { reject } of this.asked.splice(0)) reject(closed());
  }

  private hear(message: WindMessage): void {
    if (message.type === 'failed') return this.lose('failed', message.message);
    if (message.type === 'wind') {
      this.latest = message;
      this.silentLooks = 0;
      this.options.onWind?.(message);
      return;
    }
    this.known = message.known;
    if (message.type === 'calibrated') this.options.onCalibrated?.(message.known, message.heard);
    else this.asked.shift()?.resolve(message.known);
  }

  private readonly ended = (): void => this.lose('lost', 'The microphone was unplugged or taken away.');

  // Some browsers keep the track of an unplugged microphone alive; a device no longer listed is lost.
  private readonly devicesChanged = async (): Promise<void> => {
    const { deviceId } = this.settings;
    if (deviceId === '') return;
    const devices = await navigator.mediaDevices.enumerateDevices();
    const isThere = devices.some((device) => device.kind === 'audioinput' && device.deviceId === deviceId);
    if (!isThere) this.ended();
  };

  private lose(trouble: MicrophoneTrouble, message: string): void {
    if (!this.open) return;
    this.stop();
    this.options.onLost?.(new MicrophoneError(trouble, message));
  }

  private tell(command: WindCommand): void {
    this.node.port.postMessage(command);
  }
}

/**
 * Requests a microphone and starts the wind estimator. Call it in a click or key handler, where browsers let sound
 * start. Throws a MicrophoneError with the reason if none can be opened.
 */
export async function openMicrophone(wisp: Library, options: MicrophoneOptions = {}): Promise<Microphone> {
  return openSound(options, (stream, context) => new OpenMicrophone(wisp, stream, context, options));
}

const closed = (): MicrophoneError => new MicrophoneError('lost', 'The microphone is closed.');

/** Closes a microphone, and its audio context unless that is the caller's. */
function release(stream: MediaStream | undefined, context: AudioContext | undefined, options: MicrophoneOptions): void {
  for (const track of stream?.getTracks() ?? []) track.stop();
  if (options.context === undefined) void context?.close();
}

/** Opens a microphone, and returns what `use` makes of it; closes it if that fails. */
async function openSound<T>(options: MicrophoneOptions, use: (stream: MediaStream, context: AudioContext) => T): Promise<T> {
  let { context } = options;
  let stream: MediaStream | undefined;
  try {
    if (!globalThis.navigator?.mediaDevices?.getUserMedia || typeof AudioWorkletNode === 'undefined') {
      throw new MicrophoneError('unsupported', 'There is no microphone here: a page needs HTTPS or localhost for it.');
    }
    const chosen = options.deviceId ? { deviceId: { exact: options.deviceId } } : {};
    stream = await navigator.mediaDevices.getUserMedia({ audio: { ...RAW, channelCount: 1, ...chosen }, video: false });
    context ??= new AudioContext({ latencyHint: 'interactive' });
    await context.audioWorklet.addModule(options.workletUrl ?? new URL('./worklet.js', import.meta.url));
    // Not awaited, as some browsers keep the promise pending until the next click or key.
    context.resume().catch(() => {});
    return use(stream, context);
  } catch (error) {
    release(stream, context, options);
    throw refusal(error);
  }
}
