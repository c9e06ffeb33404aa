// A bank: living instances of one model, stepped together.

import * as at from './layout.js';
import { Native } from './native.js';

export interface BankOptions {
  /** Maximum number of living instances, 1 to 1048576; default 1. */
  capacity?: number;
  /** Points of an outline's polyline, 2 to 4096; default 32. */
  polylinePoints?: number;
  /** Maximum milliseconds advanced by one `advance()`, 1 to 10000; default 10000. */
  longest?: number;
  /** Seed of all random streams; default 1. The same seed and inputs give the same play. */
  seed?: bigint | number;
}

/** Value that names an instance; ids of ended instances are never reused. */
export type Instance = bigint;

export const noInstance: Instance = 0n;

/** State of a flame. Times are nanoseconds of shown time; Infinity for events that never happened. */
export interface FlameState extends Omit<at.Values<typeof at.flameState.fields>, 'events'> {
  /** Whether the flame went out in the last `step()` or `advance()` or by a call since; `relit`: was lit. */
  wentOut: boolean;
  relit: boolean;
}

/** Position of an instance in its chain. */
export type ChainPlace = at.Values<typeof at.chainPlace.fields>;

/** Settings of a chain. `ground`: height of level ground; null: none. */
export interface ChainSettings { ground: number | null }

type Three = readonly [number, number, number];

/** State of a body in world axes: metres, seconds, radians, z up. Omitted fields are zero or level. */
export interface Body {
  position: Three;
  /** Body to world, w first; normalised internally. */
  orientation?: readonly [number, number, number, number];
  velocity?: Three;
  /** Angular velocity, world axes. */
  spin?: Three;
}

// An array in the module's memory; its view is renewed when the memory has grown.
class Room {
  private pointerIfAny = 0;
  private view = new Float32Array(0);

  constructor(private readonly native: Native, private readonly most: number) {}

  get pointer(): number {
    if (this.pointerIfAny === 0) this.pointerIfAny = this.native.allocate(this.most * 4);
    return this.pointerIfAny;
  }

  first(count: number): Float32Array<ArrayBuffer> {
    const pointer = this.pointer;
    if (this.view.length !== count || !this.native.isCurrent(this.view)) this.view = this.native.floats(pointer, count);
    return this.view as Float32Array<ArrayBuffer>;
  }

  free(): void {
    if (this.pointerIfAny !== 0) this.native.free(this.pointerIfAny);
    this.pointerIfAny = 0;
  }
}

/**
 * Made by `Model.bank()`. Bulk arrays have one row per slot; rows of empty slots are ignored on input and zero on
 * output. Views are the module's own memory, valid until the next call.
 */
export class Bank {
  readonly capacity: number;
  readonly inputs: number;
  readonly outputs: number;
  /** Points of an outline's polyline; 0 for a model whose outputs are no outline. */
  readonly polylinePoints: number;
  private pointer: number;
  private readonly scratch: number;
  private readonly rooms: Record<'inputs' | 'outputs' | 'polylines' | 'sizes' | 'rings', Room>;

  /** @internal */
  constructor(private readonly native: Native, model: number, options: BankOptions, private readonly isChain: boolean) {
    this.pointer = at.madeFrom(native, 'bank', at.bankOptions, options, model);
    this.scratch = native.allocate(64);
    ({ capacity: this.capacity, inputs: this.inputs, outputs: this.outputs, polylinePoints: this.polylinePoints } = this.facts);
    this.rooms = {
      inputs: new Room(native, this.capacity * this.inputs),
      outputs: new Room(native, this.capacity * this.outputs),
      polylines: new Room(native, this.capacity * this.polylinePoints * 2),
      sizes: new Room(native, this.capacity),
      rings: new Room(native, 6 * this.ringCount),
    };
  }

  /** Number of living instances. */
  get size(): number {
    return this.facts.alive;
  }

  /** Number of rows of bulk arrays: one more than the highest slot in use. */
  get slots(): number {
    return this.facts.slots;
  }

  /** Starts an instance. Its random stream is the count of spawns so far, or `stream`. Throws when the bank is full. */
  spawn(stream?: bigint | number): Instance {
    if (stream === undefined) this.call('wisp_bank_spawn', this.scratch);
    else this.call('wisp_bank_spawn_stream', BigInt.asUintN(64, BigInt(stream)), this.scratch);
    return this.native.data.getBigUint64(this.scratch, true);
  }

  end(instance: Instance): void {
    this.call('wisp_bank_end', instance);
  }

  alive(instance: Instance): boolean {
    return this.native.functions.wisp_bank_alive!(this.pointer, instance) === 1;
  }

  /** The instance in a slot; `noInstance` when it is empty. */
  at(slot: number): Instance {
    return BigInt.asUintN(64, BigInt(this.native.functions.wisp_bank_at!(this.pointer, slot)));
  }

  /** Buffer of slots × inputs, to be filled and passed to `setInputs()`. */
  inputsView(): Float32Array<ArrayBuffer> {
    return this.rooms.inputs.first(this.slots * this.inputs);
  }

  /** Sets all inputs from the next step on: slots × inputs. */
  setInputs(values: ArrayLike<number>): void {
    this.give('wisp_bank_set_inputs', values);
  }

  setCommonInputs(values: ArrayLike<number>): void {
    this.give('wisp_bank_set_common_inputs', values);
  }

  setInstanceInputs(instance: Instance, values: ArrayLike<number>): void {
    this.give('wisp_bank_set_instance_inputs', values, instance);
  }

  /**
   * Scale of the residual noise: 1 as learned, 0 none; clamped to 0 … 10. In a chain 0 makes the walk deterministic
   * (the likeliest mode, with the best-joining segment); other scales have no effect.
   */
  setNoise(scale: number): void {
    this.call('wisp_bank_set_noise', scale);
  }

  get noise(): number {
    this.call('wisp_bank_get_noise', this.scratch);
    return this.native.data.getFloat32(this.scratch, true);
  }

  /** Makes one step of the model, regardless of time. */
  step(): void {
    this.call('wisp_bank_step');
  }

  /** Advances by nanoseconds; outputs interpolate between the last two steps. Returns the number of steps made. */
  advance(nanoseconds: number): number {
    const time = Number.isFinite(nanoseconds) ? Math.max(-1e18, Math.min(1e18, nanoseconds)) : 0;
    this.call('wisp_bank_advance', BigInt(Math.round(time)), this.scratch);
    return this.native.data.getInt32(this.scratch, true);
  }

  /** Outputs of all instances: slots × outputs. A view, valid until the next call. */
  outputsView(): Float32Array<ArrayBuffer> {
    return this.take('wisp_bank_outputs', this.rooms.outputs, this.slots * this.outputs);
  }

  /** Outputs of one instance, as a copy. */
  instanceOutputs(instance: Instance): Float32Array<ArrayBuffer> {
    return this.take('wisp_bank_instance_outputs', this.rooms.outputs, this.outputs, instance).slice();
  }

  /** Outlines of all instances, x and y alternating from the base's left over the tip: slots × points × 2. A view. */
  polylinesView(): Float32Array<ArrayBuffer> {
    return this.take('wisp_bank_polylines', this.rooms.polylines, this.slots * this.polylinePoints * 2);
  }

  /** Outline of one instance: points × 2. A view, valid until the next call. */
  polyline(instance: Instance): Float32Array<ArrayBuffer> {
    return this.take('wisp_bank_polyline', this.rooms.polylines, this.polylinePoints * 2, instance);
  }

  /** Body of revolution: sets the level camera of outputs and outlines by its right direction, a unit vector (x, z). */
  look(rightX: number, rightZ: number): void {
    this.call('wisp_bank_look', rightX, rightZ);
  }

  /**
   * Body of revolution: rings of one instance from the base to the tip, half as many as points. Six numbers each: x, y,
   * z of the centre, the radius, and the rise of the rim towards +x and +z. A view.
   */
  rings(instance: Instance): Float32Array<ArrayBuffer> {
    return this.take('wisp_bank_rings', this.rooms.rings, 6 * this.ringCount, instance);
  }

  /** Body of revolution: surface of one instance, rings × segments vertices with position and normal, as a copy. */
  mesh(instance: Instance, segments: number): Float32Array<ArrayBuffer> {
    const { native, ringCount } = this;
    this.rings(instance);
    const count = Math.max(0, 6 * ringCount * segments);
    return native.withRoom(4 * count, (p) => {
      native.check(native.functions.wisp_ring_mesh!(this.rooms.rings.pointer, ringCount, segments, p, count, 6));
      return native.floats(p, count).slice();
    });
  }

  /** Three indices for each of the 2 × rings × segments − 4 triangles of `mesh()`, anticlockwise seen from outside. */
  triangles(segments: number): Uint32Array {
    const { native, ringCount } = this;
    this.living();
    const count = Math.max(0, 6 * ringCount * segments - 12);
    return native.withRoom(4 * count, (p) => {
      native.check(native.functions.wisp_ring_triangles!(ringCount, segments, p, count));
      return new Uint32Array(native.data.buffer, p, count).slice();
    });
  }

  flameState(instance: Instance): FlameState {
    const { events, ...state } = this.struct(at.flameState, 'wisp_bank_get_flame_state', instance);
    return { ...state, wentOut: (events & 1) !== 0, relit: (events & 2) !== 0 };
  }

  /** Flame sizes of all instances: slots. A view, valid until the next call. */
  flameSizes(): Float32Array<ArrayBuffer> {
    return this.take('wisp_bank_flame_sizes', this.rooms.sizes, this.slots);
  }

  /** Lights an extinguished flame. Throws for a model whose `facts.blowOut` is null. */
  relight(instance: Instance): void {
    this.call('wisp_bank_relight', instance);
  }

  /** Extinguishes a flame, whatever the wind. Throws for a model whose `facts.blowOut` is null. */
  extinguish(instance: Instance): void {
    this.call('wisp_bank_extinguish', instance);
  }

  /** Continues a chain from the state of a body, as after a throw or a kick. Too slow for every frame. */
  place(instance: Instance, body: Body): void {
    const { native, scratch } = this;
    this.living();
    native.data.setUint32(scratch, at.body.size, true);
    const { position, orientation = [1, 0, 0, 0], velocity = [0, 0, 0], spin = [0, 0, 0] } = body;
    at.putAt(native, scratch, at.body, { position, orientation, velocity, spin });
    this.call('wisp_bank_place', instance, scratch);
  }

  /** Sets level ground at a height, on which instances of a chain come to rest; null: none. */
  setGround(height: number | null): void {
    if (height === null) this.call('wisp_bank_clear_ground');
    else this.call('wisp_bank_set_ground', height);
  }

  /** The settings made by `setGround`. */
  get chainSettings(): ChainSettings {
    const { hasGround, ground } = this.struct(at.chainSettings, 'wisp_bank_get_chain_settings');
    return { ground: hasGround ? ground : null };
  }

  /** Position of an instance in its chain; null for other dynamics. */
  chainPlace(instance: Instance): ChainPlace | null {
    return this.isChain ? this.struct(at.chainPlace, 'wisp_bank_get_chain_place', instance) : null;
  }

  /** Resets to the state at spawning, lit: one instance, or all and the bank's time. */
  reset(instance?: Instance): void {
    if (instance === undefined) this.call('wisp_bank_reset');
    else this.call('wisp_bank_reset_instance', instance);
  }

  /** The complete state; a bank of the same model and capacity restored from it continues with the same bits. */
  save(): Uint8Array<ArrayBuffer> {
    const { native } = this;
    this.call('wisp_bank_save_bytes', this.scratch);
    const size = native.data.getUint32(this.scratch, true);
    return native.withRoom(size, (p) => {
      this.call('wisp_bank_save', p, size);
      return native.bytes.slice(p, p + size);
    });
  }

  /** Throws, without any change, when the bytes are damaged or of another model, capacity or version. */
  restore(bytes: ArrayBuffer | Uint8Array): void {
    const { native } = this;
    const given = bytes instanceof Uint8Array ? bytes : new Uint8Array(bytes);
    native.withRoom(given.length, (p) => {
      native.bytes.set(given, p);
      this.call('wisp_bank_restore', p, given.length);
    });
  }

  /** Number of instance-steps in which an output was clamped to its range, and of all instance-steps. */
  clamped(): { clamped: number; steps: number } {
    const { clamped, steps } = this.facts;
    return { clamped, steps };
  }

  /** Frees the bank's memory; may be called twice. */
  free(): void {
    if (this.pointer === 0) return;
    this.native.functions.wisp_bank_free!(this.pointer);
    this.pointer = 0;
    this.native.free(this.scratch);
    for (const room of Object.values(this.rooms)) room.free();
  }

  private call(name: string, ...values: (number | bigint)[]): void {
    this.living();
    this.native.check(this.native.functions[name]!(this.pointer, ...values));
  }

  // Throws the library's error if the bank is freed, before its freed scratch memory is used.
  private living(): void {
    if (this.pointer === 0) this.native.check(this.native.functions.wisp_bank_step!(0));
  }

  private get ringCount(): number {
    return (this.polylinePoints + 1) >> 1;
  }

  private get facts() {
    return this.struct(at.bankFacts, 'wisp_bank_get_facts');
  }

  private give(name: string, values: ArrayLike<number>, ...instance: bigint[]): void {
    this.living();
    const room = this.rooms.inputs;
    const most = this.capacity * this.inputs;
    // The count is passed unchanged, so that the ABI reports a wrong count.
    const target = room.first(most);
    if (!(values instanceof Float32Array && values.byteOffset === target.byteOffset && values.buffer === target.buffer)) {
      for (let k = 0; k < Math.min(values.length, most); ++k) target[k] = values[k]!;
    }
    this.call(name, ...instance, room.pointer, values.length);
  }

  private take(name: string, room: Room, count: number, ...instance: bigint[]): Float32Array<ArrayBuffer> {
    this.living();
    this.call(name, ...instance, room.pointer, count);
    return room.first(count);
  }

  private struct<F extends at.Fields>(layout: at.Struct<F>, name: string, ...instance: bigint[]): at.Values<F> {
    this.living();
    this.native.data.setUint32(this.scratch, layout.size, true);
    this.call(name, ...instance, this.scratch);
    return at.valuesAt(this.native, this.scratch, layout);
  }
}
