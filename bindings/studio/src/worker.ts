// The worker: the engine, with decoding.

import { Engine, type RawPicture } from './engine.js';
import { Exporter } from './exporter.js';
import { showFilm } from './film.js';
import type { FromWorker, Outcome, Task, ToWorker } from './messages.js';
import { Elsewhere, sentenceOf, StudioError } from './module.js';
import { paced } from './paced_decoder.js';
import { rawOfBitmap, rawOfFrame } from './pictures.js';
import { smallPicture } from './small.js';
import type { Captured, Seen } from './types.js';

// All decoding in this worker is paced. Browsers without a decoder can still learn from tables.
if (typeof VideoDecoder !== 'undefined') globalThis.VideoDecoder = paced(VideoDecoder);

const SHOWN_EVERY_MS = 100;
/** Share of a film after which a picture is shown in any case, since short films are analysed too fast otherwise. */
const SHOWN_SHARE = 1 / 16;
const SHOWN_PIXELS = 512;
/** Maximum wait for the page to draw: hidden pages draw nothing. */
const SHOWN_WITHIN_MS = 200;
/** Gaps in live sound that are longer than this are filled with silence. */
const LOST_SECONDS = 0.05;

async function fetched(address: URL): Promise<ArrayBuffer> {
  const response = await fetch(address).catch(() => null);
  if (response?.ok !== true) throw new StudioError(`the studio could not be fetched: ${response === null ? 'there is no network' : response.status}`);
  return response.arrayBuffer();
}

/** Loads a module at first use, and again after a failure. */
function onDemand<T>(start: () => Promise<T>): () => Promise<T> {
  let started: Promise<T> | null = null;
  return () =>
    (started ??= start().catch((error: unknown) => {
      started = null;
      throw error;
    }));
}

// Literal addresses, which bundlers recognise.
const engine = onDemand(async () => Engine.start(await fetched(new URL('./studio.wasm', import.meta.url))));
const chains = onDemand(async () => Engine.start(await fetched(new URL('./chains.wasm', import.meta.url))));
const exporter = onDemand(async () => Exporter.start(await fetched(new URL('./export.wasm', import.meta.url))));

// Loaded at once. Callers that await the engine report its failure.
engine().catch(() => undefined);

const tell = (message: FromWorker, carried: Transferable[] = []): void => self.postMessage(message, { transfer: carried });

/** Called when the page has drawn the findings. */
let shown: () => void = () => undefined;

/** Waits for shown(), or SHOWN_WITHIN_MS. With few processors, the page would otherwise draw only at the film's end. */
const drawn = (): Promise<void> =>
  new Promise((resolve) => {
    shown = resolve;
    setTimeout(resolve, SHOWN_WITHIN_MS);
  });

/** Returns a function that reports findings at intervals, with a small picture of the frame if there is one. */
function showing(of: number, wisp: Engine): (picture: RawPicture | null, share: number) => Promise<void> {
  let [last, before] = [0, 0];
  return async (picture, share) => {
    if (performance.now() - last < SHOWN_EVERY_MS && share - before < SHOWN_SHARE) return;
    before = share;
    const seen: Seen = wisp.seen();
    if (picture !== null) {
      const { data, width, height } = smallPicture(picture, SHOWN_PIXELS);
      seen.picture = await createImageBitmap(new ImageData(data, width, height));
    }
    if (share >= 0) tell({ of, progress: { stage: 'capturing', share } });
    tell({ of, seen }, seen.picture === undefined ? [] : [seen.picture]);
    // Not for cameras, which do not wait.
    if (picture !== null) await drawn();
    last = performance.now();
  };
}

/** Adds warnings to a capture's. */
function warned(captured: Captured, warnings: string[]): Captured {
  captured.report.warnings = [...(captured.report.warnings ?? []), ...warnings];
  return captured;
}

class Live {
  private first: number | null = null;
  private early: { sound: Float32Array; rate: number; seconds: number }[] = [];
  private heardTo: number | null = null;
  /** errors that ended the capture, and its sound alone; null while they run */
  private failure: unknown = null;
  private deaf: unknown = null;
  /** whether it was abandoned: the engine then captures something else, and waiting input is discarded */
  abandoned = false;
  private work: Promise<void> = Promise.resolve();
  private readonly show: ReturnType<typeof showing>;

  constructor(readonly of: number, private readonly engine: Engine) { this.show = showing(of, engine); }

  frame(frame: VideoFrame | ImageBitmap, seconds: number): void {
    this.work = this.work.then(async () => {
      try {
        if (this.failure !== null || this.abandoned) return;
        const raw = frame instanceof ImageBitmap ? rawOfBitmap(frame) : await rawOfFrame(frame);
        if (this.abandoned) return;
        this.engine.frame(raw, seconds);
        if (this.first === null) this.start(seconds);
        await this.show(null, -1);
      } catch (error) {
        this.failure = error;
      } finally {
        frame.close();
        tell({ of: this.of, looked: 1 });
      }
    });
  }

  sound(sound: Float32Array, rate: number, seconds: number): void {
    this.work = this.work.then(() => {
      if (this.abandoned) return;
      if (this.first === null) this.early.push({ sound, rate, seconds });
      else this.hear(sound, rate, seconds);
    });
  }

  async finish(): Promise<Captured> {
    await this.work;
    const failure = sentenceOf(this.failure ?? this.deaf);
    // What was captured is used, as the film until a phone was turned, unless the module is unusable.
    if (failure !== null && (this.first === null || (failure instanceof StudioError && failure.cause !== undefined))) throw failure;
    return warned(this.engine.finish(), failure instanceof Error ? [`${failure.message}; the rest is used`] : []);
  }

  private start(seconds: number): void {
    this.first = seconds;
    for (const { sound, rate, seconds: at } of this.early) this.hear(sound, rate, at);
    this.early = [];
  }

  private hear(sound: Float32Array, rate: number, seconds: number): void {
    try {
      const lost = this.heardTo === null ? 0 : seconds - this.heardTo;
      if (lost > LOST_SECONDS) this.engine.sound(new Float32Array(Math.round(lost * rate)), 1, rate, 0);
      this.engine.sound(sound, 1, rate, seconds - (this.first ?? 0));
      // Time stamps jitter, samples do not: only lost sound moves the clock.
      this.heardTo = (this.heardTo === null || lost > LOST_SECONDS ? seconds : this.heardTo) + sound.length / rate;
    } catch (error) {
      this.deaf ??= error;
    }
  }
}

let live: Live | null = null;
let capturing: Promise<unknown> = Promise.resolve();

/** Captures share the engine: each begins when the one before has ended, except that a live one is then abandoned. */
function inTurn<T>(capture: () => T | Promise<T>): Promise<T> {
  const ended = capturing.then(capture);
  capturing = ended.catch(() => undefined);
  return ended;
}

function abandonLive(): void {
  if (live !== null) live.abandoned = true;
  live = null;
}

async function film(of: number, wisp: Engine, file: File, settings: object): Promise<Captured> {
  abandonLive();
  const warnings = await showFilm(wisp, file, { ...settings, name: file.name }, showing(of, wisp));
  return warned(wisp.finish(), warnings);
}

async function pictures(of: number, wisp: Engine, files: File[], rate: number, settings: object): Promise<Captured> {
  abandonLive();
  const show = showing(of, wisp);
  const collator = new Intl.Collator('en', { numeric: true });
  const sorted = files.toSorted((a, b) => collator.compare(a.name, b.name));
  wisp.begin({ ...settings, name: 'pictures', rate, pictures: true });
  for (const [k, file] of sorted.entries()) {
    const bitmap = await createImageBitmap(file, { colorSpaceConversion: 'none' }).catch(() => null);
    if (bitmap === null) throw new StudioError(`${file.name} is not a picture that can be read here`);
    const picture = rawOfBitmap(bitmap);
    bitmap.close();
    wisp.frame(picture, k / rate);
    await show(picture, (k + 1) / sorted.length);
  }
  return wisp.finish();
}

/** Reports an engine's progress. */
function watched(of: number, wisp: Engine): Engine {
  wisp.onProgress = (stage, share) => {
    tell({ of, progress: { stage, share } });
    return true;
  };
  return wisp;
}

/** Runs work in the module responsible for it. */
async function byEither<T>(of: number, work: (wisp: Engine) => T): Promise<T> {
  try {
    return work(watched(of, await engine()));
  } catch (error) {
    if (!(error instanceof Elsewhere)) throw error;
    return work(watched(of, await chains()));
  }
}

async function perform(of: number, task: Task): Promise<Outcome | null> {
  if (task.do === 'export') return (await exporter()).files(task.model, task.settings);
  const wisp = watched(of, await engine());
  switch (task.do) {
    case 'film': return inTurn(() => film(of, wisp, task.file, task.settings));
    case 'pictures': return inTurn(() => pictures(of, wisp, task.files, task.rate, task.settings));
    case 'table':
    case 'advise': return wisp.table(task.name, task.bytes, task.settings, task.do);
    case 'learn': return byEither(of, (learner) => learner.learn(task.recordings, task.recipe));
    case 'validate': return byEither(of, (learner) => learner.validate(task.model, task.recordings));
    case 'live': return inTurn(() => {
      abandonLive();
      wisp.begin(task.settings);
      live = new Live(of, wisp);
      return null;
    });
    case 'finish': return inTurn(() => {
      const ending = live;
      if (ending?.of !== of) throw new StudioError('nothing is being filmed');
      live = null;
      return ending.finish();
    });
  }
}

async function answer(of: number, task: Task): Promise<void> {
  try {
    const done = await perform(of, task);
    if (done !== null) tell({ of, done });
  } catch (thrown) {
    const error = sentenceOf(thrown);
    // A StudioError with a cause has made the module unusable.
    tell({ of, failed: error instanceof Error ? error.message : String(error), dead: error instanceof StudioError && error.cause !== undefined });
  }
}

self.addEventListener('message', ({ data }: MessageEvent<ToWorker>) => {
  if ('task' in data) void answer(data.of, data.task);
  else if ('shown' in data) shown();
  else if ('frame' in data) {
    if (live?.of === data.of) live.frame(data.frame, data.seconds);
    else {
      // The capture has not begun, as the module is still loading, or has ended: the frame is dropped.
      data.frame.close();
      tell({ of: data.of, looked: 1 });
    }
  } else if (live?.of === data.of) live.sound(data.sound, data.rate, data.seconds);
});
