// The raw WebAssembly module: its functions, memory, loading and start.

/** The module's functions: `include/wisp/wisp.h`, with pointers and sizes as numbers and 64-bit numbers as bigint. */
export type Functions = Record<string, (...values: (number | bigint)[]) => number> & {
  malloc(bytes: number): number;
  free(pointer: number): void;
};

/** Return values of C ABI functions. */
export const Status = {
  ok: 0,
  badArgument: 1,
  badData: 2,
  noInstanceLeft: 3,
  notAlive: 4,
  noMemory: 5,
} as const;

/** An error as one sentence, with its kind (`Status`). */
export class WispError extends Error {
  constructor(readonly status: number, message: string, options?: ErrorOptions) {
    super(message, options);
    this.name = 'WispError';
  }
}

/** Source of the module's bytes, and whether SIMD may be used. */
export interface LoadOptions {
  /** 'auto' (default): SIMD where the engine supports it. Results are the same bits either way. */
  simd?: 'auto' | 'on' | 'off';
  /** The module, instead of the file beside this script. `simd` must then describe it. */
  wasm?: URL | string | Response | BufferSource | WebAssembly.Module;
}

// A module whose only function returns i8x16.popcnt of i8x16.splat(0).
const simdProbe = new Uint8Array([
  0, 97, 115, 109, 1, 0, 0, 0, 1, 5, 1, 96, 0, 1, 123, 3, 2, 1, 0, 10, 10, 1, 8, 0, 65, 0, 253, 15, 253, 98, 11,
]);

/** Whether this engine supports WebAssembly's 128-bit SIMD. */
export function hasSimd(): boolean {
  return WebAssembly.validate(simdProbe);
}

async function bytesOfFile(url: URL): Promise<BufferSource> {
  // A dynamic name that bundlers do not resolve: browsers never reach this line.
  const name = 'node:fs/promises';
  const files = (await import(/* @vite-ignore */ name)) as { readFile(path: URL): Promise<Uint8Array<ArrayBuffer>> };
  return files.readFile(url);
}

async function compileResponse(response: Response): Promise<WebAssembly.Module> {
  if (!response.ok) {
    throw new WispError(Status.badData, `${response.url} could not be fetched: ${response.status} ${response.statusText}`);
  }
  // Streaming requires this content type, without parameters; other servers' bytes are compiled after download.
  if (response.headers.get('content-type') === 'application/wasm') return WebAssembly.compileStreaming(response);
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

/** One running instance of the module, with its own memory. */
export class Native {
  readonly functions: Functions;
  private readonly memory: WebAssembly.Memory;
  private readonly decoder = new TextDecoder();
  private view: DataView<ArrayBuffer>;

  private constructor(readonly module: WebAssembly.Module, readonly simd: boolean, instance: WebAssembly.Instance) {
    const { memory, ...functions } = instance.exports;
    this.functions = functions as unknown as Functions;
    this.memory = memory as WebAssembly.Memory;
    this.view = new DataView(this.memory.buffer as ArrayBuffer);
    this.functions._initialize?.();
  }

  static async load(options: LoadOptions): Promise<Native> {
    const simd = options.simd === 'on' || (options.simd !== 'off' && hasSimd());
    // Both names are literal, so that bundlers find both files.
    const beside = simd ? new URL('./wisp-simd.wasm', import.meta.url) : new URL('./wisp.wasm', import.meta.url);
    const module = await compile(options.wasm ?? beside);
    return new Native(module, simd, await WebAssembly.instantiate(module, Native.imports()));
  }

  /** Imports of the module: a notice of memory growth, which is ignored, and its exit, which throws. */
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

  /** All of the memory. Views become invalid when it grows, so ask for them anew after each call. */
  get bytes(): Uint8Array<ArrayBuffer> {
    return new Uint8Array(this.data.buffer);
  }

  get data(): DataView<ArrayBuffer> {
    if (!this.isCurrent(this.view)) this.view = new DataView(this.memory.buffer as ArrayBuffer);
    return this.view;
  }

  floats(pointer: number, count: number): Float32Array<ArrayBuffer> {
    return new Float32Array(this.data.buffer, pointer, count);
  }

  /** Whether a view made earlier is still valid. */
  isCurrent(view: ArrayBufferView): boolean {
    return view.buffer === this.memory.buffer;
  }

  /** Allocates memory in the module. Throws when there is none. */
  allocate(bytes: number): number {
    // Sizes of 4 GB and more would wrap around.
    const pointer = bytes < 2 ** 32 ? this.functions.malloc(Math.max(bytes, 8)) : 0;
    if (pointer === 0) throw new WispError(Status.noMemory, `there is no memory for ${bytes} bytes`);
    return pointer >>> 0;
  }

  free(pointer: number): void {
    this.functions.free(pointer);
  }

  /** Allocates memory for the duration of a call. */
  withRoom<T>(bytes: number, use: (pointer: number) => T): T {
    const pointer = this.allocate(bytes);
    try {
      return use(pointer);
    } finally {
      this.free(pointer);
    }
  }

  /** Returns the pointer that a call stores in the four bytes passed to it. */
  made(call: (room: number) => number): number {
    return this.withRoom(4, (room) => {
      this.check(call(room));
      return this.data.getUint32(room, true);
    });
  }

  /** Reads zero-terminated text. */
  text(pointer: number): string {
    const bytes = this.bytes;
    return this.decoder.decode(bytes.subarray(pointer, bytes.indexOf(0, pointer)));
  }

  /** Throws the library's last error, unless a C ABI function's status is ok. */
  check(status: number): void {
    if (status !== Status.ok) throw new WispError(status, this.text(this.functions.wisp_last_error!()));
  }

  /** Runs work that may allocate. Throws noMemory if the module trapped; the module is then unusable. */
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
