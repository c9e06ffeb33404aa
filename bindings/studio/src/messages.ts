// Messages between a page and its worker.

import type { CaptureSettings } from './engine.js';
import type { Captured, Exported, ExportSettings, Learned, PictureSettings, Recipe, Seen, TableSettings } from './types.js';

export type Task =
  | { do: 'film'; file: File; settings: PictureSettings }
  | { do: 'pictures'; files: File[]; rate: number; settings: PictureSettings }
  | { do: 'table' | 'advise'; name: string; bytes: Uint8Array; settings: TableSettings }
  | { do: 'learn'; recordings: readonly Uint8Array[]; recipe: Recipe }
  | { do: 'validate'; model: Uint8Array; recordings: readonly Uint8Array[] }
  | { do: 'export'; model: Uint8Array; settings: ExportSettings }
  | { do: 'live'; settings: CaptureSettings }
  | { do: 'finish' };

/** A task, input of a live capture, or notice that a picture was drawn. `of`: number of the work that it concerns. */
export type ToWorker =
  | { of: number; task: Task }
  | { of: number; shown: true }
  | { of: number; frame: VideoFrame | ImageBitmap; seconds: number }
  | { of: number; sound: Float32Array; rate: number; seconds: number };

export type Outcome = Captured | Learned | Pick<Learned, 'report' | 'curves' | 'text'> | Exported[];

export type FromWorker =
  | { of: number; progress: { stage: string; share: number } }
  | { of: number; seen: Seen }
  | { of: number; looked: number }
  | { of: number; done: Outcome }
  | { of: number; failed: string; dead: boolean };
