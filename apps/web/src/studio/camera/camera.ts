// Unprocessed camera and microphone, on a common clock.
//
// The clock is performance.now(). Frames come from the camera's track where supported (MediaStreamTrackProcessor), with
// the camera clock's time; else from the displayed picture, with the capture time where the browser reports it
// (captureTime). Sound blocks have the audio time of their first sample. A clock's offset from performance.now() is the
// minimum difference between a time stamp and its arrival, as arrivals are late, never early. The offset is estimated
// during preview and constant during filming. The remaining delay of tens of milliseconds is estimated in learning.

import type { LiveCapture, Region } from '@wisp/studio';
import { KEPT_HEIGHT } from '../reel.js';

/** Reason for a missing camera, as a sentence for people. */
export class CameraTrouble extends Error {}

/** Maximum number of frames waiting for analysis; on slow machines further frames are dropped. */
const MAX_WAITING = 6;
/** Milliseconds without a picture after which a camera counts as asleep. */
const ASLEEP = 1500;
/** Pictures per second kept for replay. */
export const KEPT_RATE = 12;

const VIDEO: MediaTrackConstraints = {
  width: { ideal: 1280 }, height: { ideal: 720 }, frameRate: { ideal: 60 }, facingMode: { ideal: 'environment' },
};
// Speech enhancement would remove the wind as noise.
const AUDIO: MediaTrackConstraints = { echoCancellation: false, noiseSuppression: false, autoGainControl: false, channelCount: 1 };

const TROUBLE: Readonly<Record<string, string>> = {
  NotAllowedError: 'The camera was not allowed. It can be allowed in the address bar; a film from your phone does as well.',
  SecurityError: 'The camera was not allowed. It can be allowed in the address bar; a film from your phone does as well.',
  NotFoundError: 'No camera was found. Plug one in, or choose a film from your phone.',
  OverconstrainedError: 'No camera was found. Plug one in, or choose a film from your phone.',
  NotReadableError: 'Another program holds the camera. Close it there and try again.',
  AbortError: 'The camera could not be started. Unplug it, plug it in and try again.',
};

/** Camera settings, where supported; not yet in TypeScript's types. */
interface Abilities extends MediaTrackCapabilities {
  exposureMode?: string[];
  whiteBalanceMode?: string[];
  focusMode?: string[];
  exposureCompensation?: { min: number; max: number; step: number };
}

/** Reader of a track's frames; not yet in TypeScript's types, nor in every browser. */
type TrackProcessor = new (of: { track: MediaStreamTrack; maxBufferSize?: number }) => { readable: ReadableStream<VideoFrame> };
const { MediaStreamTrackProcessor: Processor } = globalThis as { MediaStreamTrackProcessor?: TrackProcessor };

async function ask(hears: boolean): Promise<{ stream: MediaStream; silent: string }> {
  const devices = navigator.mediaDevices as MediaDevices | undefined;
  if (devices?.getUserMedia === undefined) {
    throw new CameraTrouble('Browsers give a camera only to pages that come over HTTPS, or from this very machine. Choose a film instead.');
  }
  try {
    return { stream: await devices.getUserMedia(hears ? { video: VIDEO, audio: AUDIO } : { video: VIDEO }), silent: '' };
  } catch (error) {
    const name = error instanceof DOMException ? error.name : '';
    // Browsers do not say whether camera or microphone was refused, so the camera alone is requested.
    if (hears && name in TROUBLE) {
      const stream = await devices.getUserMedia({ video: VIDEO }).catch(() => null);
      const why = name === 'NotAllowedError' ? 'The microphone was not allowed' : 'There is no microphone';
      if (stream !== null) return { stream, silent: `${why}: the flicker can be learned, what wind does cannot.` };
    }
    throw new CameraTrouble(TROUBLE[name] ?? `The camera could not be used: ${error instanceof Error ? error.message : String(error)}`);
  }
}

interface CameraEvents {
  /** the camera was disconnected */
  lost(): void;
  /** the microphone was disconnected; filming continues without it */
  deaf(): void;
  /** RMS of a block of sound, as a share of full scale */
  loud(level: number): void;
}

export class Camera {
  private readonly picture: MediaStreamTrack;
  private context: AudioContext | null = null;
  /** seconds from the audio clock to performance.now() */
  private offset = Infinity;
  private live: LiveCapture | null = null;
  private every = 1;
  /** whether filming, not preview: sound is passed on, and the clocks' offsets are constant */
  private heeds = false;
  private ended = false;
  /** arrival of the last frame, as performance.now() */
  private latest = performance.now();

  /** `hears`: whether to open the microphone too */
  static async open(events: CameraEvents, hears: boolean): Promise<Camera> {
    const { stream, silent } = await ask(hears);
    const camera = new Camera(stream, silent, events);
    await camera.listen().catch(() => events.deaf());
    return camera;
  }

  /** `silent`: problem with the sound; '' if none. */
  private constructor(readonly stream: MediaStream, readonly silent: string, private readonly events: CameraEvents) {
    this.picture = stream.getVideoTracks()[0] as MediaStreamTrack;
    this.picture.addEventListener('ended', () => this.ended || events.lost());
    stream.getAudioTracks()[0]?.addEventListener('ended', () => this.ended || events.deaf());
  }

  /** Frames a second stated by the camera. */
  get rate(): number { return this.picture.getSettings().frameRate || 30; }

  /** Whether an open camera gives no picture: used by another program or a call, or muted. */
  get asleep(): boolean { return this.picture.muted || performance.now() - this.latest > ASLEEP; }

  /** Resumes interrupted sound. */
  wake(): void {
    if (this.context !== null && this.context.state !== 'running' && this.context.state !== 'closed') this.context.resume().catch(() => undefined);
  }

  /** Locks exposure, colours and focus. Returns a warning if the exposure cannot be locked, else ''. */
  async lock(): Promise<string> {
    const abilities = this.abilities();
    const kept: Record<string, string> = {};
    for (const name of ['exposureMode', 'whiteBalanceMode', 'focusMode'] as const) {
      if (abilities[name]?.includes('manual') === true) kept[name] = 'manual';
    }
    await this.picture.applyConstraints({ advanced: [kept as MediaTrackConstraintSet] }).catch(() => undefined);
    return kept.exposureMode === undefined ? 'This camera changes its exposure by itself. Keep the light in the room as it is.' : '';
  }

  /** Reduces the exposure where that is possible. */
  async darker(): Promise<void> {
    const range = this.abilities().exposureCompensation;
    if (range === undefined) return;
    const now = (this.picture.getSettings() as { exposureCompensation?: number }).exposureCompensation ?? 0;
    const next = Math.max(range.min, now - Math.max(range.step, (range.max - range.min) / 12));
    if (next < now) await this.picture.applyConstraints({ advanced: [{ exposureCompensation: next } as MediaTrackConstraintSet] });
  }

  /** Starts to receive frames, from the camera or from the video element that shows it. Call once; close() ends it. */
  watch(video: HTMLVideoElement): void {
    if (Processor === undefined) this.watchPicture(video);
    else void this.watchTrack(new Processor({ track: this.picture, maxBufferSize: MAX_WAITING }).readable.getReader());
  }

  private async watchTrack(frames: ReadableStreamDefaultReader<VideoFrame>): Promise<void> {
    let offset = Infinity;
    for (let count = 1; ; ++count) {
      const { value: frame } = await frames.read();
      if (frame === undefined) return;
      const seconds = frame.timestamp / 1e6;
      this.latest = performance.now();
      if (!this.heeds || offset === Infinity) offset = Math.min(offset, performance.now() / 1000 - seconds);
      const { live } = this;
      if (live !== null && live.waiting < MAX_WAITING && count % this.every === 0) live.frame(frame, seconds + offset);
      else frame.close();
      if (this.ended) await frames.cancel();
    }
  }

  private watchPicture(video: HTMLVideoElement): void {
    let frames = 0;
    const frame = (now: number, taken?: VideoFrameCallbackMetadata): void => {
      if (this.ended) return;
      frames += 1;
      this.latest = performance.now();
      const { live } = this;
      if (live !== null && live.waiting < MAX_WAITING && frames % this.every === 0) void this.hand(live, video, (taken?.captureTime ?? now) / 1000);
      this.next(video, frame);
    };
    this.next(video, frame);
  }

  /** Passes one frame in `every` to a capture from now on, and if every frame, the sound; null: to none. */
  feed(live: LiveCapture | null, every = 1): void {
    this.live = live;
    this.every = every;
    this.heeds = every === 1;
  }

  close(): void {
    this.ended = true;
    this.live = null;
    for (const track of this.stream.getTracks()) track.stop();
    void this.context?.close();
  }

  private abilities(): Abilities {
    // Some browsers have no getCapabilities().
    return (this.picture.getCapabilities as (() => Abilities) | undefined)?.call(this.picture) ?? {};
  }

  /** Calls `frame` for the next displayed picture, with its capture time. */
  next(video: HTMLVideoElement, frame: (now: number, taken?: VideoFrameCallbackMetadata) => void): void {
    if ('requestVideoFrameCallback' in video) video.requestVideoFrameCallback(frame);
    else requestAnimationFrame((now) => frame(now));
  }

  private async hand(live: LiveCapture, video: HTMLVideoElement, seconds: number): Promise<void> {
    if (typeof VideoFrame !== 'undefined') {
      live.frame(new VideoFrame(video, { timestamp: Math.round(1e6 * seconds) }), seconds);
      return;
    }
    const bitmap = await createImageBitmap(video);
    if (this.live === live) live.frame(bitmap, seconds);
    else bitmap.close();
  }

  private async listen(): Promise<void> {
    if (this.stream.getAudioTracks().length === 0) return;
    const context = new AudioContext();
    this.context = context;
    await context.audioWorklet.addModule(new URL('./blocks.worklet.js', import.meta.url));
    const node = new AudioWorkletNode(context, 'wisp-blocks', { numberOfInputs: 1, numberOfOutputs: 0, channelCount: 1, channelCountMode: 'explicit' });
    node.port.onmessage = ({ data }: MessageEvent<{ samples: Float32Array<ArrayBuffer>; since: number }>) => this.hear(data.samples, data.since);
    context.createMediaStreamSource(this.stream).connect(node);
    context.resume().catch(() => undefined);
  }

  private hear(samples: Float32Array<ArrayBuffer>, since: number): void {
    const rate = this.context?.sampleRate ?? 48_000;
    if (!this.heeds || this.offset === Infinity) this.offset = Math.min(this.offset, performance.now() / 1000 - (since + samples.length / rate));
    let sum = 0;
    for (const sample of samples) sum += sample * sample;
    this.events.loud(Math.sqrt(sum / samples.length));
    if (this.heeds && Number.isFinite(this.offset)) this.live?.sound(samples, rate, since + this.offset);
  }
}

/** A small picture of a region of the camera's view; null where none can be made. */
export function smallPicture(video: HTMLVideoElement, part: Region): ImageBitmap | null {
  const share = Math.min(1, KEPT_HEIGHT / part.height);
  const canvas = new OffscreenCanvas(Math.max(1, Math.round(share * part.width)), Math.max(1, Math.round(share * part.height)));
  const context = canvas.getContext('2d');
  if (context === null) return null;
  context.drawImage(video, part.x, part.y, part.width, part.height, 0, 0, canvas.width, canvas.height);
  return canvas.transferToImageBitmap();
}
