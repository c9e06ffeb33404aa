// A model of a thing's behaviour, read from the bytes of a `.wisp` file.

import { Bank, type BankOptions } from './bank.js';
import * as at from './layout.js';
import { Native } from './native.js';

/** An input or an output. */
export type Channel = at.Values<typeof at.channel.fields>;

/** 'arx': autoregression with exogenous inputs. 'chain': recorded segments. 'switched': ARX modes in turn. */
export type Dynamics = 'arx' | 'chain' | 'switched';

/** Meaning of the outputs. 'outline': control points x, y. 'pose': position and quaternion w, x, y, z. */
export type View = 'plain' | 'outline' | 'pose' | 'position';

/** The rule of extinction by wind. */
export type BlowOut = at.Values<typeof at.blowOut.fields>;

export interface ModelFacts extends Omit<at.Values<typeof at.modelFacts.fields>, 'inputs' | 'outputs' | 'dynamics' | 'view'> {
  /** null: wind does not extinguish the model. */
  blowOut: BlowOut | null;
}

/** Orders of an ARX model: one row per output. */
export interface ArxFacts {
  /** Number of outputs of the equations: the model's outputs, or components of them. */
  outputs: number;
  na: number[][];
  nb: number[][];
  nk: number[][];
  /** Number of inputs of the dynamics. */
  regressors: number;
  /** Longest lag, in steps. */
  history: number;
  /** Whether noise is resampled from recorded residuals, larger in wind. */
  resamples: boolean;
  /** Standard deviation of each output's own noise. */
  noise: number[];
}

export interface ChainFacts {
  modes: number;
  segments: { mode: number; steps: number }[];
  /** Number of previous modes on which the next mode depends, 1 or 2. */
  history: number;
  /** Order of the response to wind; 0: no response. */
  gustOrder: number;
  headingFree: boolean;
  /** Initial probability of each mode, and transition probabilities: one row per previous mode. */
  initial: number[];
  transitions: number[][];
}

/** How the model was made. */
export interface Provenance {
  program: string;
  sources: string[];
  options: { name: string; value: string }[];
  figures: { name: string; value: number }[];
  usable: boolean;
  reason: string;
}

const dynamicsNames: Dynamics[] = ['arx', 'arx', 'chain', 'switched'];
const viewNames: View[] = ['plain', 'outline', 'pose', 'position'];

// The signature of a model's file.
const magic = [0x89, 0x57, 0x49, 0x53, 0x50, 0x0d, 0x0a, 0x1a];

const rows = (values: readonly number[], columns: number): number[][] =>
  Array.from({ length: columns ? values.length / columns : 0 }, (_, row) => values.slice(row * columns, (row + 1) * columns));

/** Made by `Wisp.model()`. Free it when it is no longer needed; its banks stay valid. */
export class Model {
  readonly name: string;
  readonly kind: Dynamics;
  readonly view: View;
  readonly facts: Readonly<ModelFacts>;
  readonly inputs: readonly Channel[];
  readonly outputs: readonly Channel[];
  private pointer: number;

  /** @internal */
  constructor(private readonly native: Native, bytes: Uint8Array | number) {
    this.pointer = typeof bytes === 'number' ? bytes : native.allocating(() => Model.read(native, bytes));
    this.name = native.text(native.functions.wisp_model_name!(this.pointer));
    const { inputs, outputs, dynamics, view, ...facts } = this.read(at.modelFacts, 'wisp_model_get_facts');
    const blowOut = this.read(at.blowOut, 'wisp_model_get_facts');
    this.facts = { ...facts, blowOut: blowOut.level > 0 ? blowOut : null };
    this.kind = dynamicsNames[dynamics]!;
    this.view = viewNames[view]!;
    this.inputs = Array.from({ length: inputs }, (_, k) => this.read(at.channel, 'wisp_model_get_input', k));
    this.outputs = Array.from({ length: outputs }, (_, k) => this.read(at.channel, 'wisp_model_get_output', k));
  }

  /** Creates an empty bank of instances. */
  bank(options: BankOptions = {}): Bank {
    return new Bank(this.native, this.pointer, options, this.kind === 'chain');
  }

  /**
   * The same flame as a body of revolution: its wind is two inputs, x to the right of the camera that filmed it and z
   * towards that camera. Throws unless it is a flame of symmetric and antisymmetric components.
   */
  inTheRound(): Model {
    const { native } = this;
    return new Model(native, native.allocating(() => native.made((made) => native.functions.wisp_model_in_the_round!(this.pointer, made))));
  }

  /** Origin and quality of the model. */
  get provenance(): Provenance {
    const { native, pointer } = this;
    const made = this.read(at.provenance, 'wisp_model_get_provenance');
    return {
      ...made,
      sources: Array.from({ length: made.sources }, (_, k) => native.text(native.made((p) => native.functions.wisp_model_get_source!(pointer, k, p)))),
      options: Array.from({ length: made.options }, (_, k) => this.read(at.note, 'wisp_model_get_option', k)),
      figures: Array.from({ length: made.figures }, (_, k) => this.read(at.figure, 'wisp_model_get_figure', k)),
    };
  }

  /** Orders and noise; null for other dynamics than 'arx'. */
  get arx(): ArxFacts | null {
    if (this.kind !== 'arx') return null;
    const facts = this.read(at.arxFacts, 'wisp_model_get_arx');
    const { outputs } = facts;
    const orders = (name: string, columns: number) => rows(this.numbers(name, outputs * columns, Int32Array), columns);
    return {
      ...facts,
      na: orders('wisp_model_arx_na', outputs),
      nb: orders('wisp_model_arx_nb', facts.regressors),
      nk: orders('wisp_model_arx_nk', facts.regressors),
      noise: this.numbers('wisp_model_arx_noise', outputs, Float64Array),
    };
  }

  /** Modes, segments and probabilities; null for other dynamics. */
  get chain(): ChainFacts | null {
    if (this.kind !== 'chain') return null;
    const facts = this.read(at.chainFacts, 'wisp_model_get_chain');
    return {
      ...facts,
      segments: this.segments(facts.segments),
      initial: this.numbers('wisp_model_chain_initial', facts.modes, Float64Array),
      transitions: rows(this.numbers('wisp_model_chain_transitions', facts.modes * facts.modes, Float64Array), facts.modes),
    };
  }

  /** Frees the model's memory. Facts already read stay; may be called twice. */
  free(): void {
    this.native.functions.wisp_model_free!(this.pointer);
    this.pointer = 0;
  }

  private static read(native: Native, bytes: Uint8Array): number {
    // Of a file without a model's signature only 64 bytes are copied, as memory that grew for a film never shrinks.
    const promising = bytes.length >= 32 && magic.every((byte, k) => bytes[k] === byte);
    const given = promising ? bytes : bytes.subarray(0, 64);
    return native.withRoom(given.length, (copied) => {
      native.bytes.set(given, copied);
      return native.made((made) => native.functions.wisp_model_load!(copied, given.length, made));
    });
  }

  // Returns the values of a struct that an ABI call fills.
  private read<F extends at.Fields>(struct: at.Struct<F>, name: string, ...index: number[]): at.Values<F> {
    const { native } = this;
    return native.withRoom(struct.size, (p) => {
      native.data.setUint32(p, struct.size, true);
      native.check(native.functions[name]!(this.pointer, ...index, p));
      return at.valuesAt(native, p, struct);
    });
  }

  // Returns the numbers that an ABI call writes into an array.
  private numbers(name: string, count: number, Kind: typeof Int32Array | typeof Float64Array): number[] {
    const { native } = this;
    return native.withRoom(count * Kind.BYTES_PER_ELEMENT, (p) => {
      native.check(native.functions[name]!(this.pointer, p, count));
      return Array.from(new Kind(native.bytes.buffer, p, count));
    });
  }

  private segments(count: number): { mode: number; steps: number }[] {
    const { native } = this;
    return native.withRoom(count * 8, (p) => {
      native.check(native.functions.wisp_model_chain_segments!(this.pointer, p, p + 4 * count, count));
      const words = new Uint32Array(native.data.buffer, p, 2 * count);
      return Array.from({ length: count }, (_, k) => ({ mode: words[k]!, steps: words[count + k]! }));
    });
  }
}
