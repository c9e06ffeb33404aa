// The wind estimator: wind from a microphone's samples.

import * as at from './layout.js';
import { Native } from './native.js';

export type WindOptions = { sampleRate: number } & Partial<at.Values<typeof at.windOptions.fields>>;

/** The wind during one frame. Amplitudes are root mean squares with full scale 1. */
export type WindFrame = at.Values<typeof at.windFrame.fields>;

/** Calibration of a microphone in a room. Set at a later start, it replaces the initial guess. `gustRms` 0: unknown. */
export type WindCalibration = at.Values<typeof at.windCalibration.fields>;

/** Requests of a guided calibration to the user, in the order of WISP_WIND_*. */
export const windAsks = ['breathe gently', 'blow hard'] as const;
export type WindAsk = (typeof windAsks)[number];

const samplesAtOnce = 3360; // a multiple of every number of channels, 1 to 8, so whole rows stay together
const framesAtOnce = 64;

/** Made by `Wisp.windLevel()`. Frames do not depend on the block size of the sound. */
export class WindLevel {
  private pointer: number;
  private readonly samples: number;
  private readonly frames: number;
  private readonly counts: number;

  /** @internal */
  constructor(private readonly native: Native, options: WindOptions) {
    this.pointer = at.madeFrom(native, 'wind', at.windOptions, options);
    this.samples = native.allocate(samplesAtOnce * 4);
    this.frames = native.allocate(framesAtOnce * at.windFrame.size);
    this.counts = native.allocate(64);
  }

  /**
   * Takes interleaved samples, ±1 or 16 bits. Returns the frames completed by them.
   * Throws when their number is not a multiple of the channels.
   */
  feed(samples: Float32Array | Int16Array): WindFrame[] {
    this.living();
    const { native, counts } = this;
    const wide = samples instanceof Float32Array;
    const feed = native.functions[wide ? 'wisp_wind_feed' : 'wisp_wind_feed_int16']!;
    const frames: WindFrame[] = [];
    // Each call says how many samples it has taken: fewer than were given where it completes many frames.
    for (let from = 0; from < samples.length; from += native.data.getUint32(counts, true)) {
      const piece = samples.subarray(from, from + samplesAtOnce);
      if (wide) native.floats(this.samples, piece.length).set(piece);
      else new Int16Array(native.bytes.buffer, this.samples, piece.length).set(piece);
      native.check(feed(this.pointer, this.samples, piece.length, this.frames, framesAtOnce, counts, counts + 4));
      const made = native.data.getUint32(counts + 4, true);
      for (let k = 0; k < made; ++k) frames.push(at.valuesAt(native, this.frames + k * at.windFrame.size, at.windFrame));
    }
    return frames;
  }

  /** The latest frame; all zero before the first. */
  get latest(): WindFrame {
    this.living();
    this.native.check(this.native.functions.wisp_wind_latest!(this.pointer, this.frames));
    return at.valuesAt(this.native, this.frames, at.windFrame);
  }

  /** Calibrates with the coming `seconds` of sound, 0.5 to 30, as the requested sound. Numbers as `ask` are ignored. */
  calibrate(ask: WindAsk | number, seconds = 3): void {
    if (typeof ask === 'string') this.native.check(this.native.functions.wisp_wind_calibrate!(this.pointer, windAsks.indexOf(ask), seconds));
  }

  get calibrating(): boolean {
    return this.native.functions.wisp_wind_calibrating!(this.pointer) === 1;
  }

  /** Whether the last calibration has ended and heard the requested sound. */
  get calibrated(): boolean {
    return this.native.functions.wisp_wind_calibrated!(this.pointer) === 1;
  }

  /**
   * Rise of the background's level above that of the first seconds, or above its minimum since then, dB, ≥ 0. From 6
   * on a steady sound (rain, a fan) may be mistaken for wind; reset() takes that sound for background.
   */
  get roomRise(): number {
    return this.native.functions.wisp_wind_room_rise!(this.pointer);
  }

  get calibration(): WindCalibration {
    this.living();
    const { native, counts: p } = this;
    native.data.setUint32(p, at.windCalibration.size, true);
    native.check(native.functions.wisp_wind_get_calibration!(this.pointer, p));
    return at.valuesAt(native, p, at.windCalibration);
  }

  set calibration(known: WindCalibration) {
    this.living();
    const { native, counts: p } = this;
    native.data.setUint32(p, at.windCalibration.size, true);
    at.putAt(native, p, at.windCalibration, { ...known });
    native.check(native.functions.wisp_wind_set_calibration!(this.pointer, p));
  }

  /** Seconds by which a frame comes after the wind that it measures, beyond the frame's own duration. */
  get latencySeconds(): number {
    return this.native.functions.wisp_wind_latency!(this.pointer);
  }

  /** Resets everything except the options. */
  reset(): void {
    this.native.check(this.native.functions.wisp_wind_reset!(this.pointer));
  }

  /** Frees the estimator's memory; may be called twice. */
  free(): void {
    if (this.pointer === 0) return;
    this.native.functions.wisp_wind_free!(this.pointer);
    this.pointer = 0;
    for (const room of [this.samples, this.frames, this.counts]) this.native.free(room);
  }

  // Throws the library's error if the estimator is freed, before its freed buffers are used.
  private living(): void {
    if (this.pointer === 0) this.native.check(this.native.functions.wisp_wind_reset!(0));
  }
}
