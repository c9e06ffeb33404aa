// The module itself: capture, learn and validate, one call after the other. In a page a worker has it; Node may call it
// where it stands.

import type { Captured, Curve, Learned, PictureSettings, Recipe, Region, Report, Seen, Series, TableSettings } from './types.js';

type Functions = Record<string, (...values: number[]) => number>;

/** A picture as decoders lay it out. */
export interface RawPicture {
  layout: 'grey' | 'yuv' | 'rgb';
  width: number;
  height: number;
  data: Uint8Array;
  /** one for grey, else three: where in `data` it begins, bytes a row, bytes from pixel to pixel */
  planes: { offset: number; stride: number; step: number }[];
  /** colour planes are 2^shift times smaller */
  shiftX?: number;
  shiftY?: number;
  fullRange?: boolean;
  bt709?: boolean;
}

/** What is captured, and from where. */
export interface CaptureSettings extends PictureSettings {
  name: string;
  /** frames a second */
  rate: number;
  /** pictures, which have no sound */
  pictures?: boolean;
}

/** Why something could not be done, in a sentence. */
export class StudioError extends Error {
  override name = 'StudioError';
}

const NO_MEMORY = 'there is not enough memory for this: give a shorter film, or a smaller picture';
const FAULT = 'Wisp stopped at a fault of its own; what was gathered before is kept. A report with this file would help to mend it';
const LAYOUTS = { grey: 0, yuv: 1, rgb: 2 } as const;

interface SeenText {
  frames: number;
  decided: boolean;
  channel?: string;
  threshold?: number;
  clipped?: number;
  flames?: number;
  box?: [number, number, number, number];
  moving?: [number, number, number, number];
}

interface ReportText {
  report: Report;
  curves: Curve[];
  text: string;
}

type RecordingText = ReportText & { rate: number; rows: number; episodes: number[]; series: Omit<Series, 'samples'>[] };

export class Engine {
  /** Told of progress; returns whether to go on. */
  onProgress: (stage: string, share: number) => boolean = () => true;
  private readonly functions: Functions;
  private readonly memory: WebAssembly.Memory;
  private frameAt = 0;
  private frameBytes = 0;
  private width = 0;
  private height = 0;

  private constructor(module: WebAssembly.Module) {
    const { memory, ...functions } = new WebAssembly.Instance(module, this.imports(module)).exports;
    this.memory = memory as WebAssembly.Memory;
    this.functions = functions as unknown as Functions;
    this.functions._initialize?.();
  }

  /** Starts a module. */
  static async start(module: WebAssembly.Module | BufferSource): Promise<Engine> {
    return new Engine(module instanceof WebAssembly.Module ? module : await WebAssembly.compile(module));
  }

  /** Bytes of memory that it has by now; it grows and never shrinks. */
  get memoryBytes(): number {
    return this.memory.buffer.byteLength;
  }

  /** Begins a capture; one that was going on is given up. */
  begin(settings: CaptureSettings): void {
    this.withText(JSON.stringify(settings), (at, size) => this.call('studio_begin', at, size));
  }

  /** The next frame, and its time on any clock; or, before the first, a glimpse from anywhere in the clip. */
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

  /** The next sound, interleaved; of the first block `begin` counts, seconds after the first frame. */
  sound(samples: Float32Array, channels: number, rate: number, begin: number): void {
    const at = this.take(samples.byteLength);
    new Float32Array(this.memory.buffer, at, samples.length).set(samples);
    try {
      this.call('studio_sound', at, samples.length, channels, rate, begin);
    } finally {
      this.functions.free!(at);
    }
  }

  /** What the frames so far have shown. */
  seen(): Seen {
    this.call('studio_seen');
    const text = JSON.parse(this.text()) as SeenText;
    const outline = Float32Array.from(this.numbers());
    return {
      frame: text.frames,
      width: this.width,
      height: this.height,
      state: !text.decided ? 'waiting' : outline.length > 0 ? 'following' : 'gone',
      outline,
      box: text.box === undefined ? null : regionOf(text.box),
      moving: text.moving === undefined ? null : regionOf(text.moving),
      threshold: text.threshold ?? null,
      channel: text.channel ?? null,
      clipped: text.clipped ?? null,
      flames: text.flames ?? null,
    };
  }

  /** Ends the capture. */
  finish(): Captured {
    this.call('studio_finish');
    return this.recording();
  }

  /** Reads a recording or a table. */
  table(name: string, bytes: Uint8Array, settings: TableSettings = {}): Captured {
    this.withBytes(bytes, (at, size) =>
      this.withText(JSON.stringify({ ...settings, name }), (words, length) => this.call('studio_table', at, size, words, length)),
    );
    return this.recording();
  }

  /** Learns from recordings, each as the CSV of `Captured`. */
  learn(recordings: readonly Uint8Array[], recipe: Recipe): Learned {
    this.gather(recordings);
    this.withText(JSON.stringify(recipe), (at, size) => this.call('studio_learn', at, size));
    const model = this.answerBytes();
    return { model, ...(JSON.parse(this.text()) as Omit<Learned, 'model'>) };
  }

  /** Judges a model on recordings. */
  validate(model: Uint8Array, recordings: readonly Uint8Array[]): ReportText {
    this.gather(recordings);
    this.withBytes(model, (at, size) => this.call('studio_validate', at, size));
    return JSON.parse(this.text()) as ReportText;
  }

  private gather(recordings: readonly Uint8Array[]): void {
    this.functions.studio_clear!();
    for (const bytes of recordings) {
      this.withBytes(bytes, (at, size) => this.withText('{"name":"the recording"}', (words, length) => this.call('studio_add', at, size, words, length)));
    }
  }

  private recording(): Captured {
    const { series, rows, ...rest } = JSON.parse(this.text()) as RecordingText;
    const numbers = this.numbers();
    const { report, text, rate, episodes } = rest;
    return {
      csv: this.answerBytes(),
      rate,
      rows,
      episodes,
      series: series.map((one, k) => ({ ...one, samples: numbers.slice(k * rows, (k + 1) * rows) })),
      report,
      text,
    };
  }

  /** Calls a function that answers, and throws the sentence where it fails. */
  private call(name: string, ...values: number[]): void {
    let status;
    try {
      status = this.functions[name]!(...values);
    } catch (error) {
      throw error instanceof WebAssembly.RuntimeError ? new StudioError(FAULT, { cause: error }) : error;
    }
    if (status !== 0) throw new StudioError(this.text());
  }

  private text(): string {
    return new TextDecoder().decode(this.bytes(this.functions.studio_text!(), this.functions.studio_text_size!()));
  }

  private answerBytes(): Uint8Array {
    return this.bytes(this.functions.studio_bytes!(), this.functions.studio_bytes_size!()).slice();
  }

  private numbers(): Float64Array {
    return new Float64Array(this.memory.buffer, this.functions.studio_numbers!(), this.functions.studio_numbers_size!()).slice();
  }

  private bytes(at: number, size: number): Uint8Array {
    return new Uint8Array(this.memory.buffer, at, size);
  }

  private take(size: number): number {
    const at = this.functions.malloc!(Math.max(1, size));
    if (at === 0) outOfMemory();
    return at;
  }

  private withBytes(bytes: Uint8Array, use: (at: number, size: number) => void): void {
    const at = this.take(bytes.length);
    this.bytes(at, bytes.length).set(bytes);
    try {
      use(at, bytes.length);
    } finally {
      this.functions.free!(at);
    }
  }

  private withText(text: string, use: (at: number, size: number) => void): void {
    this.withBytes(new TextEncoder().encode(text), use);
  }

  /** What the module asks for: progress is told, and what an operating system would do is not done. */
  private imports(module: WebAssembly.Module): WebAssembly.Imports {
    const imports: WebAssembly.Imports = {};
    const progress = (at: number, size: number, share: number): number =>
      Number(this.onProgress(new TextDecoder().decode(this.bytes(at, size)), share));
    for (const { module: from, name } of WebAssembly.Module.imports(module)) {
      imports[from] ??= {};
      imports[from]![name] = name === 'studio_progress' ? progress : name === 'studio_out_of_memory' ? outOfMemory : absent(name);
    }
    return imports;
  }
}

/** Ends the call that wants more memory than there is. What the module held is lost with it. */
function outOfMemory(): never {
  throw new StudioError(NO_MEMORY, { cause: 'memory' });
}

/** There are no files, no clock and no environment. */
function absent(name: string): () => number {
  if (name === 'emscripten_notify_memory_growth') return () => 0;
  const BAD_DESCRIPTOR = 8;
  if (/^(fd_|environ_|clock_)/.test(name)) return () => BAD_DESCRIPTOR;
  return () => {
    throw new StudioError(`the module wants ${name} of an operating system, and a page has none`);
  };
}

const regionOf = ([x, y, width, height]: [number, number, number, number]): Region => ({ x, y, width, height });
