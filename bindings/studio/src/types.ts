// Inputs and results of learning.

/** A rectangle of pixels. */
export type Region = Record<'x' | 'y' | 'width' | 'height', number>;

/** Settings of a film's capture. Omitted ones have the program's defaults. */
export interface PictureSettings {
  /** an outline in the wind, or an object falling before a plain wall; `either`: falls if usable; default: `flame` */
  looks_for?: 'flame' | 'falls' | 'either';
  /** for falls: height in metres of the wall in the picture; default 1 */
  height?: number;
  /** index of the flame by size, from 1; 0: any moving object */
  flame?: number;
  /** searched region; default: the whole picture */
  region?: Region;
  /** brightness channel; default: the one that separates best */
  channel?: 'luma' | 'red' | 'green' | 'blue';
  /** whether the object is dark on a light background */
  dark?: boolean;
  /** number of control points, 4 to 64; default 8 */
  points?: number;
}

/** Findings so far in a film or camera stream. */
export interface Seen {
  /** number of frames so far, including lost ones */
  frame: number;
  width: number;
  height: number;
  /** `waiting`: no object yet; `following`: an outline is found; `gone`: not in this frame */
  state: 'waiting' | 'following' | 'gone';
  /** for falls: region that moved since the last frame, pixels; null: none, or not searched */
  moving: Region | null;
  /** x and y of the outline's points, alternating, pixels from the top left; empty without an outline */
  outline: Float32Array;
  /** box of the object, pixels; null while waiting */
  box: Region | null;
  /** brightness threshold of the edge, 0 to 255, once decided */
  threshold: number | null;
  /** colour channel, once decided */
  channel: string | null;
  /** share of the object saturated in every channel, once decided */
  clipped: number | null;
  /** number of flames, once decided */
  flames: number | null;
  /** a small copy of the frame, for films and pictures, not for cameras; the receiver closes it */
  picture?: ImageBitmap;
}

/** Observer of work, which may stop it. */
export interface Watch {
  /** when aborted, work ends with an AbortError; earlier captures are kept */
  signal?: AbortSignal;
  /** stage in words, and its finished share: 0 to 1, negative for unknown length */
  progress?: (stage: string, share: number) => void;
  /** findings, at most ten times a second, except that short films give at least sixteen */
  seen?: (seen: Seen) => void;
}

/** A report as `wisp … --json` prints it. */
export interface Report {
  usable?: { verdict: boolean; reason: string; code?: string };
  warnings?: string[];
  [figure: string]: unknown;
}

/** A time series of a recording. Missing samples are NaN. */
export interface Series { name: string; unit: string; role: 'input' | 'output' | 'motion'; samples: Float64Array }

export interface Captured {
  /** as the program writes it, for learning, saving and sending */
  csv: Uint8Array;
  rate: number;
  /** source of the rate; empty where it was stated */
  why: string;
  rows: number;
  /** first rows of episodes; a model's history never crosses their boundaries */
  episodes: number[];
  series: Series[];
  report: Report;
  /** the report as text, as printed by the program */
  text: string;
}

/** Kind of model, and options; omitted ones have the program's defaults. */
export interface Recipe {
  kind: 'flame' | 'outline' | 'arx' | 'leaf' | 'chain';
  name?: string;
  /** names of the recordings in messages and in the model; default recording.csv */
  sources?: string[];
  seed?: number;
  /** for falls with noisy positions: odd number of rows over which velocities are taken; default 0 */
  smooth_rows?: number;
  /** lags of outputs and inputs of an ARX model; 0: default */
  order?: number;
  /** for outlines: order of one system per control point; 0: systems of shape components */
  paper?: number;
  /** lags of inputs and delay of an ARX model; names of its channels where the table lacks roles */
  nb?: number;
  nk?: number;
  inputs?: string[];
  outputs?: string[];
  /** share of the rows, 0 to 1, at the end, on which a model of the rest is judged; the returned model is learned from
   * all rows. Flames hold out their own share */
  kept_back?: number;
}

/** A curve for plotting. */
export interface Curve { id: string; label: string; x_label: string; y_label: string; x: number[]; y: number[] }

/** A model with its verdict. */
export interface Learned {
  /** a .wisp file */
  model: Uint8Array;
  report: Report;
  curves: Curve[];
  text: string;
  /** results on the rows kept back; absent if there were none or too few */
  judged?: Pick<Learned, 'report' | 'curves' | 'text'>;
}

/** Settings of an export; omitted ones have the program's defaults. */
export interface ExportSettings {
  /** glTF, Lottie, C for microcontrollers */
  format: 'glb' | 'json' | 'c';
  /** base name of the files, and prefix of all names in C */
  name: string;
  seconds?: number;
  /** seconds of a loop, in place of plain play */
  loop?: number;
  instances?: number;
  /** constant value of every input */
  wind?: number;
  seed?: number;
  /** height in pixels, for Lottie */
  height?: number;
}

export interface Exported { name: string; bytes: Uint8Array }

/** Columns of a table, and its rate in rows per second where the table lacks it. */
export interface TableSettings { rate?: number; inputs?: string[]; outputs?: string[] }
