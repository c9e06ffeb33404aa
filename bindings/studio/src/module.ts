// A WebAssembly module of the studio: its memory, calls and imports.

type Functions = Record<string, (...values: number[]) => number>;

/** Reason of a failure, as a sentence. */
export class StudioError extends Error {
  override name = 'StudioError';
}

/** Thrown where the other learning module is responsible. */
export class Elsewhere extends StudioError {}

const ELSEWHERE = 2;
const NO_MEMORY = 'there is not enough memory for this: give a shorter film, or a smaller picture';
const FAULT = 'Wisp stopped at a fault of its own; what was gathered before is kept. A report with this file would help to mend it';

/** Compiles a module from its bytes, unless it is compiled already. */
export const compiled = async (module: WebAssembly.Module | BufferSource): Promise<WebAssembly.Module> =>
  module instanceof WebAssembly.Module ? module : WebAssembly.compile(module);

/**
 * Converts an engine's error to a StudioError: traps and stack overflows are faults of Wisp, other range errors mean
 * that the browser refuses memory. Returns other errors unchanged.
 */
export function sentenceOf(error: unknown): unknown {
  const fault = error instanceof WebAssembly.RuntimeError || (error instanceof RangeError && /stack/i.test(error.message));
  return fault || error instanceof RangeError ? new StudioError(fault ? FAULT : NO_MEMORY, { cause: error }) : error;
}

/** Runs work that needs memory; converts its errors by sentenceOf(). After an error the module is unusable. */
export function told<T>(work: () => T): T {
  try {
    return work();
  } catch (error) {
    throw sentenceOf(error);
  }
}

export class Module {
  /** Receives progress; returns whether to continue. */
  onProgress: (stage: string, share: number) => boolean = () => true;
  protected readonly functions: Functions;
  private readonly memory: WebAssembly.Memory;

  protected constructor(module: WebAssembly.Module) {
    const { memory, ...functions } = told(() => new WebAssembly.Instance(module, this.imports(module)).exports);
    this.memory = memory as WebAssembly.Memory;
    this.functions = functions as unknown as Functions;
    this.functions._initialize?.();
  }

  /** Current size of the module's memory in bytes; it grows and never shrinks. */
  get memoryBytes(): number { return this.memory.buffer.byteLength; }

  /** Calls a function of the module; on failure throws the answer's text. */
  protected call(name: string, ...values: number[]): void {
    const asked = this.functions[name];
    if (asked === undefined) throw new Elsewhere('this module learns and does not capture; studio.wasm does');
    const ended = told(() => asked(...values));
    if (ended !== 0) throw new (ended === ELSEWHERE ? Elsewhere : StudioError)(this.text());
  }

  protected text(): string {
    return new TextDecoder().decode(this.bytes(this.functions.studio_text!(), this.functions.studio_text_size!()));
  }

  protected answerBytes(): Uint8Array {
    return told(() => this.bytes(this.functions.studio_bytes!(), this.functions.studio_bytes_size!()).slice());
  }

  protected numbers(): Float64Array {
    return told(() => new Float64Array(this.memory.buffer, this.functions.studio_numbers!(), this.functions.studio_numbers_size!()).slice());
  }

  protected bytes(at: number, size: number): Uint8Array { return new Uint8Array(this.memory.buffer, at, size); }

  protected take(size: number): number {
    const at = told(() => this.functions.malloc!(Math.max(1, size)));
    if (at === 0) outOfMemory();
    return at;
  }

  protected withBytes(bytes: Uint8Array, use: (at: number, size: number) => void): void {
    const at = this.take(bytes.length);
    this.bytes(at, bytes.length).set(bytes);
    try {
      use(at, bytes.length);
    } finally {
      this.functions.free!(at);
    }
  }

  protected withText(text: string, use: (at: number, size: number) => void): void {
    this.withBytes(new TextEncoder().encode(text), use);
  }

  /** Imports of the module: progress is reported, and calls to an operating system fail. */
  private imports(module: WebAssembly.Module): WebAssembly.Imports {
    const imports: WebAssembly.Imports = {};
    const progress = (at: number, size: number, share: number): number => Number(this.onProgress(new TextDecoder().decode(this.bytes(at, size)), share));
    for (const { module: from, name } of WebAssembly.Module.imports(module)) {
      imports[from] ??= {};
      imports[from]![name] = name === 'studio_progress' ? progress : name === 'studio_out_of_memory' ? outOfMemory : absent(name);
    }
    return imports;
  }
}

/** Ends a call that needs more memory than there is. The module's data are lost. */
function outOfMemory(): never { throw new StudioError(NO_MEMORY, { cause: 'memory' }); }

/** Stub for a system call: there are no files, no clock and no environment. */
function absent(name: string): () => number {
  if (name === 'emscripten_notify_memory_growth') return () => 0;
  const BAD_DESCRIPTOR = 8;
  if (/^(fd_|environ_|clock_)/.test(name)) return () => BAD_DESCRIPTOR;
  return () => { throw new StudioError(`the module wants ${name} of an operating system, and a page has none`); };
}
