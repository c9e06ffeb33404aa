// The WebAssembly module as it is: its functions, its memory, and how it is fetched and started.

/** The module's functions: `include/wisp/wisp.h`, with pointers and sizes as numbers and 64-bit numbers as bigint. */
export type Functions = Record<string, (...values: (number | bigint)[]) => number> & {
  malloc(bytes: number): number;
  free(pointer: number): void;
};

/** What a function of the C ABI answers. */
export const Status = {
  ok: 0,
  badArgument: 1,
  badData: 2,
  noInstanceLeft: 3,
  notAlive: 4,
  noMemory: 5,
} as const;

/** What went wrong, in one sentence, and which kind of wrong it is (`Status`). */
export class WispError extends Error {
  constructor(
    readonly status: number,
    message: string,
    options?: ErrorOptions,
  ) {
    super(message, options);
    this.name = 'WispError';
  }
}

/** Where the module's bytes come from, and whether it may use SIMD. */
export interface LoadOptions {
  /** 'auto' (default): SIMD where the engine has it. The bits are the same either way. */
  simd?: 'auto' | 'on' | 'off';
  /** The module, instead of the one beside this script. Its `simd` is then what you say it is. */
  wasm?: URL | string | Response | BufferSource | WebAssembly.Module;
}

// A module of one function that returns an i8x16.splat's lane.
const simdProbe = new Uint8Array([
  0, 97, 115, 109, 1, 0, 0, 0, 1, 5, 1, 96, 0, 1, 123, 3, 2, 1, 0, 10, 10, 1, 8, 0, 65, 0, 253, 15, 253, 98, 11,
]);

/** Whether this engine runs WebAssembly's 128-bit SIMD. */
export function hasSimd(): boolean {
  return WebAssembly.validate(simdProbe);
}

async function bytesOfFile(url: URL): Promise<BufferSource> {
  // By a name that bundlers do not follow: browsers never come here.
  const name = 'node:fs/promises';
  const files = (await import(/* @vite-ignore */ name)) as { readFile(path: URL): Promise<Uint8Array<ArrayBuffer>> };
  return files.readFile(url);
}

async function compileResponse(response: Response): Promise<WebAssembly.Module> {
  if (!response.ok) {
    throw new WispError(Status.badData, `${response.url} could not be fetched: ${response.status} ${response.statusText}`);
  }
  // Streaming needs the right type; a server that does not know WebAssembly still serves its bytes.
  if (response.headers.get('content-type')?.startsWith('application/wasm')) {
    return WebAssembly.compileStreaming(response);
  }
  return WebAssembly.compile(await response.arrayBuffer());
}

async function compile(source: NonNullable<LoadOptions['wasm']>): Promise<WebAssembly.Module> {
  if (source instanceof WebAssembly.Module) return source;
  if (typeof Response !== 'undefined' && source instanceof Response) return compileResponse(source);
  if (typeof source === 'string' || source instanceof URL) {
    const url = new URL(source, import.meta.url);
    return url.protocol === 'file:' ? WebAssembly.compile(await bytesOfFile(url)) : compileResponse(await fetch(url));
  }
  return WebAssembly.compile(source as BufferSource);
}

/** One running copy of the module, with memory of its own. */
export class Native {
  readonly functions: Functions;
  private readonly memory: WebAssembly.Memory;
  private readonly decoder = new TextDecoder();
  private buffer: ArrayBuffer;
  private bytesView: Uint8Array<ArrayBuffer>;
  private dataView: DataView<ArrayBuffer>;

  private constructor(
    readonly module: WebAssembly.Module,
    readonly simd: boolean,
    instance: WebAssembly.Instance,
  ) {
    const { memory, ...functions } = instance.exports;
    this.functions = functions as unknown as Functions;
    this.memory = memory as WebAssembly.Memory;
    this.buffer = this.memory.buffer as ArrayBuffer;
    this.bytesView = new Uint8Array(this.buffer);
    this.dataView = new DataView(this.buffer);
    this.functions._initialize?.();
  }

  static async load(options: LoadOptions): Promise<Native> {
    const simd = options.simd === 'on' || (options.simd !== 'off' && hasSimd());
    // Written out, so that bundlers see both files.
    const beside = simd ? new URL('./wisp-simd.wasm', import.meta.url) : new URL('./wisp.wasm', import.meta.url);
    const module = await compile(options.wasm ?? beside);
    return new Native(module, simd, await WebAssembly.instantiate(module, Native.imports()));
  }

  /** What the module asks of its host: next to nothing. */
  static imports(): WebAssembly.Imports {
    return {
      env: { emscripten_notify_memory_growth: () => {} },
      wasi_snapshot_preview1: {
        proc_exit: () => {
          throw new WispError(Status.noMemory, 'the WebAssembly module ended itself; load it again');
        },
      },
    };
  }

  /** All of the memory. Views die when it grows, so they are asked for anew each time. */
  get bytes(): Uint8Array<ArrayBuffer> {
    this.follow();
    return this.bytesView;
  }

  get data(): DataView<ArrayBuffer> {
    this.follow();
    return this.dataView;
  }

  floats(pointer: number, count: number): Float32Array<ArrayBuffer> {
    return new Float32Array(this.memory.buffer as ArrayBuffer, pointer, count);
  }

  doubles(pointer: number, count: number): Float64Array<ArrayBuffer> {
    return new Float64Array(this.memory.buffer as ArrayBuffer, pointer, count);
  }

  /** Whether a view that was made earlier still shows the memory. */
  isCurrent(view: ArrayBufferView): boolean {
    return view.buffer === this.memory.buffer;
  }

  private follow(): void {
    if (this.buffer === this.memory.buffer) return;
    this.buffer = this.memory.buffer as ArrayBuffer;
    this.bytesView = new Uint8Array(this.buffer);
    this.dataView = new DataView(this.buffer);
  }

  /** Room in the module's memory. Throws when there is none. */
  allocate(bytes: number): number {
    const pointer = this.functions.malloc(Math.max(bytes, 8));
    if (pointer === 0) throw new WispError(Status.noMemory, `there is no memory for ${bytes} bytes`);
    return pointer >>> 0;
  }

  free(pointer: number): void {
    this.functions.free(pointer);
  }

  /** Lends room for the time of a call. */
  withRoom<T>(bytes: number, use: (pointer: number) => T): T {
    const pointer = this.allocate(bytes);
    try {
      return use(pointer);
    } finally {
      this.free(pointer);
    }
  }

  /** Text that ends in a zero byte. */
  text(pointer: number): string {
    const bytes = this.bytes;
    return this.decoder.decode(bytes.subarray(pointer, bytes.indexOf(0, pointer)));
  }

  /** Throws what a function of the C ABI says is wrong. */
  check(status: number): void {
    if (status !== Status.ok) throw new WispError(status, this.text(this.functions.wisp_last_error!()));
  }

  /** Calls what may allocate; a module that found no memory has stopped for good. */
  allocating<T>(work: () => T): T {
    try {
      return work();
    } catch (error) {
      if (!(error instanceof WebAssembly.RuntimeError)) throw error;
      const message = 'the WebAssembly module found no memory and stopped; load it again';
      throw new WispError(Status.noMemory, message, { cause: error });
    }
  }
}
