// The modules that capture, learn and validate, one call at a time. A page runs them in a worker; Node may call them directly.

import { compiled, Module } from './module.js';
import type { Captured, Learned, PictureSettings, Recipe, Region, Seen, Series, TableSettings } from './types.js';

/** A picture in a decoder's layout. */
export interface RawPicture {
  layout: 'grey' | 'yuv' | 'rgb';
  width: number;
  height: number;
  data: Uint8Array;
  /** one plane for grey, else three: offset in `data`, bytes per row, bytes per pixel */
  planes: { offset: number; stride: number; step: number }[];
  /** colour planes are 2^shift times smaller */
  shiftX?: number;
  shiftY?: number;
  fullRange?: boolean;
  bt709?: boolean;
}

/** Settings of a capture, and its source. */
export interface CaptureSettings extends PictureSettings {
  name: string;
  /** frames a second */
  rate: number;
  /** whether the frames are numbered picture files, without sound */
  pictures?: boolean;
}

export { Elsewhere, StudioError } from './module.js';

const LAYOUTS = { grey: 0, yuv: 1, rgb: 2 } as const;

type Box = [x: number, y: number, width: number, height: number];
type SeenText = { frames: number; decided: boolean; box?: Box; moving?: Box } & Partial<Pick<Seen, 'channel' | 'threshold' | 'clipped' | 'flames'>>;
type ReportText = Pick<Learned, 'report' | 'curves' | 'text'>;
type RecordingText = Omit<Captured, 'csv' | 'series'> & { series: Omit<Series, 'samples'>[] };

/**
 * `studio.wasm` captures, and learns and judges everything but chains. `chains.wasm` learns and judges chains and
 * leaves, from recordings. Each throws `Elsewhere` for models of the other.
 */
export class Engine extends Module {
  private frameAt = 0;
  private frameBytes = 0;
  private width = 0;
  private height = 0;

  static async start(module: WebAssembly.Module | BufferSource): Promise<Engine> {
    return new Engine(await compiled(module));
  }

  /** Begins a capture; a running one is abandoned. */
  begin(settings: CaptureSettings): void {
    this.withText(JSON.stringify(settings), (at, size) => this.call('studio_begin', at, size));
  }

  /** Takes the next frame with its time on any clock; or, before the first, a glimpse from anywhere in the clip. */
  frame(picture: RawPicture, seconds: number, glimpse = false): void {
    const { data, planes, width, height } = picture;
    this.width = width;
    this.height = height;
    if (this.frameBytes < data.length) {
      if (this.frameAt !== 0) this.functions.free!(this.frameAt);
      this.frameAt = this.take(data.length);
      this.frameBytes = data.length;
    }
    this.bytes(this.frameAt, data.length).set(data);
    const plane = (k: number): [number, number] => {
      const { offset, stride } = planes[k] ?? planes[0]!;
      return [this.frameAt + offset, stride];
    };
    const step = planes[planes.length > 1 ? 1 : 0]!.step;
    this.call(
      'studio_frame', LAYOUTS[picture.layout], width, height, ...plane(0), ...plane(1), ...plane(2), step,
      picture.shiftX ?? 0, picture.shiftY ?? 0, Number(picture.fullRange ?? picture.layout !== 'yuv'), Number(picture.bt709 ?? false),
      seconds, Number(glimpse),
    );
  }

  /** Takes the next sound, interleaved. `begin`: seconds from the first frame to the first block; later ignored. */
  sound(samples: Float32Array, channels: number, rate: number, begin: number): void {
    const bytes = new Uint8Array(samples.buffer, samples.byteOffset, samples.byteLength);
    this.withBytes(bytes, (at) => this.call('studio_sound', at, samples.length, channels, rate, begin));
  }

  /** Findings in the frames so far. */
  seen(): Seen {
    this.call('studio_seen');
    const { frames: frame, decided, box, moving, ...found } = JSON.parse(this.text()) as SeenText;
    const outline = Float32Array.from(this.numbers());
    const { width, height } = this;
    const state = !decided ? 'waiting' : outline.length > 0 ? 'following' : 'gone';
    const undecided = { threshold: null, channel: null, clipped: null, flames: null };
    return { frame, width, height, state, outline, box: regionOf(box), moving: regionOf(moving), ...undecided, ...found };
  }

  finish(): Captured { this.call('studio_finish'); return this.recording(); }

  /** Reads a recording or table; its report, with `advise`, lists defects that will harm a model, with remedies. */
  table(name: string, bytes: Uint8Array, settings: TableSettings = {}, how: 'table' | 'advise' = 'table'): Captured {
    this.read(`studio_${how}`, bytes, { ...settings, name });
    return this.recording();
  }

  /** Learns from recordings, each as the CSV of `Captured`. */
  learn(recordings: readonly Uint8Array[], recipe: Recipe): Learned {
    this.gather(recordings, recipe.sources);
    this.withText(JSON.stringify(recipe), (at, size) => this.call('studio_learn', at, size));
    const model = this.answerBytes();
    return { model, ...(JSON.parse(this.text()) as Omit<Learned, 'model'>) };
  }

  validate(model: Uint8Array, recordings: readonly Uint8Array[]): ReportText {
    this.gather(recordings);
    this.withBytes(model, (at, size) => this.call('studio_validate', at, size));
    return JSON.parse(this.text()) as ReportText;
  }

  private gather(recordings: readonly Uint8Array[], names: readonly string[] = []): void {
    this.functions.studio_clear!();
    for (const [k, bytes] of recordings.entries()) this.read('studio_add', bytes, { name: names[k] ?? 'recording.csv' });
  }

  private read(by: string, bytes: Uint8Array, settings: TableSettings & { name: string }): void {
    this.withBytes(bytes, (at, size) => this.withText(JSON.stringify(settings), (words, length) => this.call(by, at, size, words, length)));
  }

  private recording(): Captured {
    const read = JSON.parse(this.text()) as RecordingText;
    const numbers = this.numbers();
    const series = read.series.map((one, k) => ({ ...one, samples: numbers.slice(k * read.rows, (k + 1) * read.rows) }));
    return { ...read, csv: this.answerBytes(), series };
  }
}

const regionOf = (box?: Box): Region | null => (box === undefined ? null : { x: box[0], y: box[1], width: box[2], height: box[3] });
