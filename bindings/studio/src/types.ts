// What goes into learning and what comes out of it.

/** A rectangle of pixels. */
export interface Region {
  x: number;
  y: number;
  width: number;
  height: number;
}

/** How a film is captured. What is not said is the program's default. */
export interface PictureSettings {
  /** an outline that wind bends, or something light that falls before a plain wall; `either`: falls where the film has usable ones; `flame` */
  looks_for?: 'flame' | 'falls' | 'either';
  /** of falls: how many metres of wall the picture shows from top to bottom; 1 */
  height?: number;
  /** which of several flames, 1 the largest; 0: whatever moves, flame or not */
  flame?: number;
  /** where to look; the whole picture */
  region?: Region;
  /** which brightness; the one that separates best */
  channel?: 'luma' | 'red' | 'green' | 'blue';
  /** the thing is dark on a light ground */
  dark?: boolean;
  /** control points, 4 to 64; 8 */
  points?: number;
}

/** What has been seen by now of a film or a camera. */
export interface Seen {
  /** frames so far, lost ones included */
  frame: number;
  width: number;
  height: number;
  /** `waiting`: nothing that stands out yet; `following`: there is an outline; `gone`: not in this frame */
  state: 'waiting' | 'following' | 'gone';
  /** of falls: what moved since the frame before, pixels; null: nothing, or they are not looked for */
  moving: Region | null;
  /** x and y of the outline's points by turns, pixels from the top left; empty where there is none */
  outline: Float32Array;
  /** x, y, width, height of what was found, pixels; null while waiting */
  box: Region | null;
  /** brightness at the edge, 0 to 255, once decided */
  threshold: number | null;
  /** colour channel, once decided */
  channel: string | null;
  /** share of the thing as bright in every channel as it gets, once decided */
  clipped: number | null;
  /** how many flames there are, once decided */
  flames: number | null;
  /** the frame, small, for whoever shows it; the taker closes it. A film's only */
  picture?: ImageBitmap;
}

/** Who watches, and may stop. */
export interface Watch {
  /** aborted: the work ends with an AbortError, what was captured before is kept */
  signal?: AbortSignal;
  /** the stage in words, and the share of it that is done: 0 to 1, negative where its length is unknown */
  progress?: (stage: string, share: number) => void;
  /** what is seen, some fifteen times a second of work */
  seen?: (seen: Seen) => void;
}

/** A report as `wisp … --json` prints it. */
export interface Report {
  usable?: { verdict: boolean; reason: string; code?: string };
  warnings?: string[];
  [figure: string]: unknown;
}

/** One time series of a recording. Missing samples are NaN. */
export interface Series {
  name: string;
  unit: string;
  role: 'input' | 'output' | 'motion';
  samples: Float64Array;
}

/** A recording. */
export interface Captured {
  /** as the program writes it: what is learned from, saved and sent */
  csv: Uint8Array;
  rate: number;
  /** where the rate is from; empty where it was said */
  why: string;
  rows: number;
  /** rows at which episodes begin: stretches that history does not cross */
  episodes: number[];
  series: Series[];
  report: Report;
  /** the report in words, as the program prints it */
  text: string;
}

/** What is learned, and how; what is not said is the program's default. */
export interface Recipe {
  kind: 'flame' | 'outline' | 'arx' | 'leaf' | 'chain';
  name?: string;
  /** what the recordings are called in what is said of them, and in the model; recording.csv */
  sources?: string[];
  seed?: number;
  /** of falls: odd, rows that velocities are taken over, where positions are noisy; 0 */
  smooth?: number;
  /** lags of outputs and inputs of an ARX model; 0: the default */
  order?: number;
  /** an outline as in the paper: order of the systems, one a control point; 0: components of the shape */
  paper?: number;
  /** lags of inputs and delay of an ARX model; names of its channels where the table does not say */
  nb?: number;
  nk?: number;
  inputs?: string[];
  outputs?: string[];
  /** the last share of the rows, 0 to 1, that a model of the rest is judged on; the model that is given is then learned
   * from all of them. A flame keeps back its own */
  kept_back?: number;
}

/** A curve to plot. */
export interface Curve {
  id: string;
  label: string;
  x_label: string;
  y_label: string;
  x: number[];
  y: number[];
}

/** A model and what to think of it. */
export interface Learned {
  /** a .wisp file */
  model: Uint8Array;
  report: Report;
  curves: Curve[];
  text: string;
  /** what the rows that were kept back say; absent where nothing was, or too little */
  judged?: Pick<Learned, 'report' | 'curves' | 'text'>;
}

/** What is made of a model for other tools; what is not said is the program's default. */
export interface ExportSettings {
  /** glTF, Lottie, C for microcontrollers */
  format: 'glb' | 'json' | 'c';
  /** of the files, without what they end in; of all names in C */
  name: string;
  seconds?: number;
  /** seconds of a loop, instead of plain play */
  loop?: number;
  instances?: number;
  /** a constant value of every input */
  wind?: number;
  seed?: number;
  /** pixels, of Lottie */
  height?: number;
}

/** A file. */
export interface Exported {
  name: string;
  bytes: Uint8Array;
}

/** Columns of a table, and its rows a second, where it does not say itself. */
export interface TableSettings {
  rate?: number;
  inputs?: string[];
  outputs?: string[];
}
