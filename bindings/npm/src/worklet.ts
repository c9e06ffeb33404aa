// The wind estimator off the main thread: an AudioWorklet processor with its own instance of the WebAssembly module.
//
// One file that imports types only, as bundlers copy the file of AudioWorklet.addModule() unchanged. Its offsets equal
// those of layout.ts (a test compares results), which a compile-time check compares with the C ABI.

import type { WindCalibration, WindFrame } from './wind.js';

export interface WindProcessorOptions {
  /** The module, as from `Wisp.module`. */
  module: WebAssembly.Module;
  /** Frames of wind per second. */
  frameRate: number;
  /** Earlier calibration of this microphone and room. */
  calibration?: WindCalibration;
}

/** Messages: a frame of wind, the requested calibration, the end of a guided calibration, or an error. */
export type WindMessage =
  | (Omit<WindFrame, 'rmsClean'> & {
      type: 'wind';
      /** Rise of the room's level, dB. */
      roomRise: number;
      /** Audio time at the end of the block that completed the frame, seconds. */
      time: number;
    })
  | { type: 'calibration'; known: WindCalibration }
  /** `heard`: whether the requested sound was heard. */
  | { type: 'calibrated'; known: WindCalibration; heard: boolean }
  | { type: 'failed'; message: string };

export type WindCommand =
  /** `ask`: one of WISP_WIND_*. */
  | { type: 'calibrate'; seconds: number; ask: number }
  | { type: 'tell calibration' }
  | { type: 'reset' }
  | { type: 'stop' };

declare const sampleRate: number;
declare const currentTime: number;
declare class AudioWorkletProcessor {
  readonly port: MessagePort;
}
declare function registerProcessor(name: string, processor: new (options: AudioWorkletNodeOptions) => object): void;

type Functions = Record<string, (...values: number[]) => number>;

// Samples taken at once. Blocks have 128 today; engines may allow more.
const maxSamples = 4096;
const maxFrames = 16;
const frameBytes = 40;

class Ears {
  private readonly functions: Functions;
  private readonly memory: WebAssembly.Memory;
  private readonly wind: number;
  private readonly samples: number;
  private readonly frames: number;
  private readonly scratch: number;

  constructor(options: WindProcessorOptions) {
    const instance = new WebAssembly.Instance(options.module, {
      env: { emscripten_notify_memory_growth: () => {} },
      wasi_snapshot_preview1: { proc_exit: () => {} },
    });
    this.functions = instance.exports as unknown as Functions;
    this.memory = instance.exports.memory as WebAssembly.Memory;
    this.functions._initialize?.();
    this.samples = this.functions.malloc!(maxSamples * 4);
    this.frames = this.functions.malloc!(maxFrames * frameBytes);
    this.scratch = this.functions.malloc!(64);
    this.wind = this.create(options.frameRate);
    if (options.calibration) this.know(options.calibration);
  }

  /** Returns the value of one of the estimator's functions. */
  ask(name: string): number {
    return this.functions[name]!(this.wind);
  }

  /** Calls one of the estimator's functions; on failure throws its error message. */
  call(name: string, ...values: number[]): void {
    this.check(this.functions[name]!(this.wind, ...values));
  }

  /** Feeds a block of one channel. Calls `each` with the address of every frame that the block completes. */
  feed(block: Float32Array, each: (data: DataView, at: number) => void): void {
    if (block.length > maxSamples) this.feed(block.subarray(0, -maxSamples), each);
    block = block.subarray(-maxSamples);
    new Float32Array(this.memory.buffer, this.samples, block.length).set(block);
    for (let taken = 0; taken < block.length; ) {
      const left = block.length - taken;
      this.call('wisp_wind_feed', this.samples + 4 * taken, left, this.frames, maxFrames, this.scratch, this.scratch + 4);
      const data = new DataView(this.memory.buffer);
      taken += data.getUint32(this.scratch, true);
      const made = data.getUint32(this.scratch + 4, true);
      for (let k = 0; k < made; ++k) each(data, this.frames + k * frameBytes);
    }
  }

  calibration(): WindCalibration {
    const data = new DataView(this.memory.buffer);
    data.setUint32(this.scratch, 20, true);
    this.call('wisp_wind_get_calibration', this.scratch);
    const number = (field: number) => data.getFloat32(this.scratch + field, true);
    return { backgroundRms: number(4), backgroundLevel: number(8), floorDb: number(12), gustRms: number(16) };
  }

  private create(frameRate: number): number {
    // Memory layout: options first, then the pointer to the estimator; 64 bytes hold both.
    this.functions.wisp_wind_default_options!(this.scratch);
    const data = new DataView(this.memory.buffer);
    data.setFloat64(this.scratch + 8, sampleRate, true);
    data.setFloat64(this.scratch + 16, frameRate, true);
    this.check(this.functions.wisp_wind_create!(this.scratch, this.scratch + 56));
    return new DataView(this.memory.buffer).getUint32(this.scratch + 56, true);
  }

  private know(known: WindCalibration): void {
    const data = new DataView(this.memory.buffer);
    data.setUint32(this.scratch, 20, true);
    data.setFloat32(this.scratch + 4, known.backgroundRms, true);
    data.setFloat32(this.scratch + 8, known.backgroundLevel, true);
    data.setFloat32(this.scratch + 12, known.floorDb, true);
    data.setFloat32(this.scratch + 16, known.gustRms, true);
    this.call('wisp_wind_set_calibration', this.scratch);
  }

  private check(status: number): void {
    if (status === 0) return;
    // Worklets have no TextDecoder; the estimator's error messages are plain ASCII.
    const bytes = new Uint8Array(this.memory.buffer);
    const from = this.functions.wisp_last_error!();
    throw new Error(String.fromCharCode(...bytes.subarray(from, bytes.indexOf(0, from))));
  }
}

class WindProcessor extends AudioWorkletProcessor {
  private ears: Ears | null = null;
  private mixed = new Float32Array(128);
  private wasCalibrating = false;

  constructor(options: AudioWorkletNodeOptions) {
    super();
    this.guarded(() => {
      this.ears = new Ears(options.processorOptions as WindProcessorOptions);
    });
    this.port.onmessage = (event: MessageEvent<WindCommand>) => this.guarded(() => this.obey(event.data));
  }

  /** Called by the engine with each block; false releases the processor. */
  process(inputs: Float32Array[][]): boolean {
    const channels = inputs[0];
    if (this.ears && channels && channels.length > 0) this.guarded(() => this.listen(channels));
    return this.ears !== null;
  }

  private listen(channels: Float32Array[]): void {
    const ears = this.ears!;
    ears.feed(this.mix(channels), (data, at) => {
      const number = (field: number) => data.getFloat32(at + field, true);
      this.say({
        type: 'wind',
        index: Number(data.getBigInt64(at, true)),
        rms: number(8),
        level: number(16),
        speed: number(20),
        wind: number(24),
        confidence: number(28),
        background: number(32),
        clipped: number(36),
        roomRise: ears.ask('wisp_wind_room_rise'),
        time: currentTime + channels[0]!.length / sampleRate,
      });
    });
    const calibrating = ears.ask('wisp_wind_calibrating') === 1;
    if (this.wasCalibrating && !calibrating) {
      this.say({ type: 'calibrated', known: ears.calibration(), heard: ears.ask('wisp_wind_calibrated') === 1 });
    }
    this.wasCalibrating = calibrating;
  }

  // Averages the channels, as some browsers give more than the requested one.
  private mix(channels: Float32Array[]): Float32Array {
    if (channels.length === 1) return channels[0]!;
    const length = channels[0]!.length;
    if (this.mixed.length !== length) this.mixed = new Float32Array(length);
    this.mixed.fill(0);
    for (const channel of channels) {
      for (let k = 0; k < length; ++k) this.mixed[k]! += channel[k]! / channels.length;
    }
    return this.mixed;
  }

  private obey(command: WindCommand): void {
    if (command.type === 'stop') this.ears = null;
    if (command.type === 'calibrate') this.ears?.call('wisp_wind_calibrate', command.ask, command.seconds);
    if (command.type === 'reset') this.ears?.call('wisp_wind_reset');
    if (command.type === 'tell calibration' && this.ears) this.say({ type: 'calibration', known: this.ears.calibration() });
    this.wasCalibrating = this.ears?.ask('wisp_wind_calibrating') === 1;
  }

  private guarded(work: () => void): void {
    try {
      work();
    } catch (error) {
      this.ears = null;
      this.say({ type: 'failed', message: error instanceof Error ? error.message : String(error) });
    }
  }

  private say(message: WindMessage): void {
    this.port.postMessage(message);
  }
}

registerProcessor('wisp-wind', WindProcessor);
