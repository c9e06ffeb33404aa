// The page's side of the worker.

import { StudioError } from './module.js';
import type { FromWorker, Outcome, Task, ToWorker } from './messages.js';
import type { Captured, Exported, ExportSettings, Learned, PictureSettings, Recipe, TableSettings, Watch } from './types.js';

/** A live capture from a camera and a microphone. */
export interface LiveCapture {
  /** Takes a frame (and closes it) with its time in seconds, on any clock common to frames and sound. */
  frame(frame: VideoFrame | ImageBitmap, seconds: number): void;
  /** Takes a block of mono sound; `seconds`: time of its first sample, on the clock of the frames. */
  sound(samples: Float32Array, rate: number, seconds: number): void;
  /** number of frames waiting for analysis; if it grows, feed fewer */
  readonly waiting: number;
  /** false once it has ended, was cancelled or lost its worker; a failed analysis of frames only `finish` reports */
  readonly alive: boolean;
  /** Ends the capture. Rejects with a sentence if there is no usable recording. */
  finish(): Promise<Captured>;
  /** Abandons the capture. */
  cancel(): void;
}

/** Work not yet answered by the worker. */
interface Pending {
  watch: Watch;
  resolve: (outcome: Outcome) => void;
  reject: (why: unknown) => void;
  looked?: () => void;
}

const stopped = (): DOMException => new DOMException('stopped', 'AbortError');

/** Calls `act` after the page has drawn its current state; immediately if the page is hidden. */
function afterNextPicture(act: () => void): void {
  if (document.hidden) act();
  else requestAnimationFrame(() => requestAnimationFrame(act));
}

export class Studio {
  private worker: Worker | null = null;
  private readonly pending = new Map<number, Pending>();
  private count = 0;

  private constructor() {}

  /** Starts the worker, which loads the module. Rejects with a sentence where this browser cannot run it. */
  static async open(): Promise<Studio> {
    if (typeof Worker === 'undefined' || typeof WebAssembly === 'undefined') {
      throw new StudioError('this browser has no WebAssembly in workers, which learning needs: a current Firefox, Chrome, Edge or Safari does');
    }
    const studio = new Studio();
    studio.employ();
    return studio;
  }

  /** Captures a film file with sound and picture, decoded in the worker. */
  film(file: File, settings: PictureSettings, watch: Watch = {}): Promise<Captured> {
    if (typeof VideoDecoder === 'undefined') {
      return Promise.reject(new StudioError('this browser cannot take films apart (it has no WebCodecs): a current Chrome, Edge, Safari or Firefox can'));
    }
    return this.ask({ do: 'film', file, settings }, watch);
  }

  /** Captures numbered pictures. */
  pictures(files: File[], rate: number, settings: PictureSettings, watch: Watch = {}): Promise<Captured> {
    return this.ask({ do: 'pictures', files, rate, settings }, watch);
  }

  /** Captures live. `rate`: frames a second stated by the camera. */
  live(name: string, rate: number, settings: PictureSettings, watch: Watch = {}): LiveCapture {
    const of = ++this.count;
    const { pending } = this;
    let waiting = 0;
    const ended = new Promise<Outcome>((resolve, reject) => void this.pending.set(of, { watch, resolve, reject, looked: () => (waiting -= 1) }));
    // finish() reports failures.
    ended.catch(() => undefined);
    this.send({ of, task: { do: 'live', settings: { ...settings, name, rate } } });
    return {
      frame: (frame, seconds) => {
        if (!this.pending.has(of)) return frame.close();
        waiting += 1;
        this.send({ of, frame, seconds }, [frame]);
      },
      sound: (sound, heard, seconds) => {
        if (this.pending.has(of)) this.send({ of, sound, rate: heard, seconds }, [sound.buffer]);
      },
      get waiting() { return waiting; },
      get alive() { return pending.has(of); },
      finish: () => {
        if (this.pending.has(of)) this.send({ of, task: { do: 'finish' } });
        return ended as Promise<Captured>;
      },
      cancel: () => {
        this.pending.get(of)?.reject(stopped());
        this.pending.delete(of);
      },
    };
  }

  /** Reads a recording or table: CSV. Its report, with `advise`, lists defects that harm a model, with remedies. */
  table(name: string, bytes: Uint8Array, settings: TableSettings = {}, how: 'table' | 'advise' = 'table'): Promise<Captured> {
    return this.ask({ do: how, name, bytes, settings });
  }

  /** Learns from recordings, each as `Captured.csv`. */
  learn(recordings: readonly Uint8Array[], recipe: Recipe, watch: Watch = {}): Promise<Learned> {
    return this.ask({ do: 'learn', recordings, recipe }, watch);
  }

  validate(model: Uint8Array, recordings: readonly Uint8Array[], watch: Watch = {}): Promise<Pick<Learned, 'report' | 'curves' | 'text'>> {
    return this.ask({ do: 'validate', model, recordings }, watch);
  }

  /** Converts a model to files for other tools. The module for that is loaded at first use. */
  export(model: Uint8Array, settings: ExportSettings, watch: Watch = {}): Promise<Exported[]> {
    return this.ask({ do: 'export', model, settings }, watch);
  }

  /** Ends the worker and discards all data. */
  close(): void { this.dismiss(stopped()); }

  private employ(): Worker {
    const worker = new Worker(new URL('./worker.js', import.meta.url), { type: 'module' });
    worker.addEventListener('message', ({ data }: MessageEvent<FromWorker>) => this.take(data));
    worker.addEventListener('error', (event) => {
      event.preventDefault();
      this.dismiss(new StudioError(`the worker that learns stopped${event.message ? ` (${event.message})` : ''}: what was gathered is kept, try once more`));
    });
    this.worker = worker;
    return worker;
  }

  /** Fails all running work; later work uses a new worker. */
  private dismiss(why: unknown): void {
    this.worker?.terminate();
    this.worker = null;
    for (const { reject } of this.pending.values()) reject(why);
    this.pending.clear();
  }

  private send(message: ToWorker, carried: Transferable[] = []): void {
    (this.worker ?? this.employ()).postMessage(message, carried);
  }

  private ask<T extends Outcome>(task: Task, watch: Watch = {}): Promise<T> {
    const { signal } = watch;
    if (signal?.aborted === true) return Promise.reject(stopped());
    const of = ++this.count;
    return new Promise<T>((resolve, reject) => {
      // The module cannot receive messages while computing, so its worker is ended and a new one starts when needed.
      const stop = (): void => this.dismiss(stopped());
      const over = <V>(then: (value: V) => void) => (value: V): void => {
        signal?.removeEventListener('abort', stop);
        then(value);
      };
      signal?.addEventListener('abort', stop, { once: true });
      this.pending.set(of, { watch, resolve: over(resolve as (outcome: Outcome) => void), reject: over(reject) });
      this.send({ of, task });
    });
  }

  private take(message: FromWorker): void {
    const work = this.pending.get(message.of);
    if (work === undefined) {
      if ('seen' in message) message.seen.picture?.close();
    } else if ('progress' in message) work.watch.progress?.(message.progress.stage, message.progress.share);
    else if ('looked' in message) work.looked?.();
    else if ('seen' in message) {
      if (work.watch.seen === undefined) message.seen.picture?.close();
      else work.watch.seen(message.seen);
      afterNextPicture(() => this.worker?.postMessage({ of: message.of, shown: true } satisfies ToWorker));
    } else {
      this.pending.delete(message.of);
      if ('done' in message) work.resolve(message.done);
      else {
        work.reject(new StudioError(message.failed));
        // The module is unusable after a fault or without memory: later work starts a new worker.
        if (message.dead) this.dismiss(new StudioError(message.failed));
      }
    }
  }
}
