// A bank: living instances of one model, stepped together.

import * as at from './layout.js';
import { Native } from './native.js';

export interface BankOptions {
  /** Most instances alive at once, 1 to 1048576; default 1. */
  capacity?: number;
  /** Points of an outline's polyline, 2 to 4096; default 32. */
  polylinePoints?: number;
  /** Milliseconds that `advance()` lets pass at most, 1 to 10000; default 10000. */
  longest?: number;
  /** Of all random streams of the bank; default 1. The same seed and inputs give the same life. */
  seed?: bigint | number;
}

/** Names an instance by value; an ended one is never named again. */
export type Instance = bigint;

/** No instance. */
export const noInstance: Instance = 0n;

/** Whether an instance burns. Times are nanoseconds of what is shown; Infinity for what never happened. */
export interface FlameState {
  lit: boolean;
  /** 0 to 1: what outputs are already multiplied by. */
  flameSize: number;
  sinceLit: number;
  sinceOut: number;
  /** In the last call of `step()` or `advance()`, or by hand since. */
  wentOut: boolean;
  relit: boolean;
  /** As a light: the middle of its outline (z in the round), its area against rest, its colour temperature. */
  light: [number, number, number];
  intensity: number;
  kelvin: number;
}

/** Where in its chain an instance is. */
export interface ChainPlace {
  segment: number;
  step: number;
  mode: number;
  /** Over the last step: metres and radians a second, z up. */
  velocity: [number, number, number];
  spin: [number, number, number];
  /** At rest on the ground; touched it in the last call of `step()` or `advance()`. */
  lies: boolean;
  landed: boolean;
}

/** What was set of a chain; null: as at first. */
export interface ChainSettings {
  ground: number | null;
}

function three(data: DataView, p: number): [number, number, number] {
  return [data.getFloat32(p, true), data.getFloat32(p + 4, true), data.getFloat32(p + 8, true)];
}

type Three = readonly [number, number, number];

/** A body at one moment, in the world: metres, seconds, radians, z up. What is left out is at rest and level. */
export interface Body {
  position: Three;
  /** Body to world, w first; its length does not matter. */
  orientation?: readonly [number, number, number, number];
  velocity?: Three;
  /** Angular velocity, world axes. */
  spin?: Three;
}

const never = 0x7fffffffffffffffn;
const nanoseconds = (value: bigint) => (value === never ? Infinity : Number(value));

// An array in the module's memory, seen anew when the memory has grown.
class Room {
  private pointerIfAny = 0;
  private view = new Float32Array(0);

  constructor(
    private readonly native: Native,
    private readonly most: number,
  ) {}

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
 * Made by `Model.bank()`. Bulk arrays have one row per slot; rows of empty slots are ignored on the way in and are
 * zeros on the way out. The views that `…View()` gives are the module's own memory: read them before the next call.
 */
export class Bank {
  readonly capacity: number;
  readonly inputs: number;
  readonly outputs: number;
  /** 0 where the outputs are not an outline. */
  readonly polylinePoints: number;
  private pointer: number;
  private readonly scratch: number;
  private readonly inputsRoom: Room;
  private readonly outputsRoom: Room;
  private readonly polylinesRoom: Room;
  private readonly sizesRoom: Room;
  private readonly ringsRoom: Room;

  /** @internal */
  constructor(
    private readonly native: Native,
    model: number,
    options: BankOptions,
    private readonly isChain: boolean,
  ) {
    this.pointer = native.allocating(() => Bank.create(native, model, options));
    this.scratch = native.allocate(64);
    this.capacity = this.fact(at.bankFacts.capacity);
    this.inputs = this.fact(at.bankFacts.inputs);
    this.outputs = this.fact(at.bankFacts.outputs);
    this.polylinePoints = this.fact(at.bankFacts.polylinePoints);
    this.inputsRoom = new Room(native, this.capacity * this.inputs);
    this.outputsRoom = new Room(native, this.capacity * this.outputs);
    this.polylinesRoom = new Room(native, this.capacity * this.polylinePoints * 2);
    this.sizesRoom = new Room(native, this.capacity);
    this.ringsRoom = new Room(native, 6 * this.ringCount);
  }

  private static create(native: Native, model: number, options: BankOptions): number {
    return native.withRoom(at.bankOptions.size + 4, (p) => {
      native.functions.wisp_bank_default_options!(p);
      const data = native.data;
      if (options.capacity !== undefined) data.setUint32(p + at.bankOptions.capacity, options.capacity, true);
      if (options.polylinePoints !== undefined) {
        data.setUint32(p + at.bankOptions.polylinePoints, options.polylinePoints, true);
      }
      if (options.longest !== undefined) data.setUint32(p + at.bankOptions.longest, options.longest, true);
      if (options.seed !== undefined) data.setBigUint64(p + at.bankOptions.seed, BigInt(options.seed), true);
      const made = p + at.bankOptions.size;
      native.check(native.functions.wisp_bank_create!(model, p, made));
      return native.data.getUint32(made, true);
    });
  }

  /** Instances alive. */
  get size(): number {
    return this.fact(at.bankFacts.alive);
  }

  /** Rows of every bulk array: one more than the highest slot in use. */
  get slots(): number {
    return this.fact(at.bankFacts.slots);
  }

  /** Starts an instance. Its random stream is the count of spawns so far, or `stream`. Throws when the bank is full. */
  spawn(stream?: bigint | number): Instance {
    const { native, scratch } = this;
    native.check(
      stream === undefined
        ? native.functions.wisp_bank_spawn!(this.pointer, scratch)
        : native.functions.wisp_bank_spawn_stream!(this.pointer, BigInt.asUintN(64, BigInt(stream)), scratch),
    );
    return native.data.getBigUint64(scratch, true);
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

  /** Room for what acts on all, slots × inputs, to be written into and given to `setInputs()`. */
  inputsView(): Float32Array<ArrayBuffer> {
    return this.inputsRoom.first(this.slots * this.inputs);
  }

  /** What acts on all from the next step on: slots × inputs. */
  setInputs(values: ArrayLike<number>): void {
    this.give('wisp_bank_set_inputs', values, this.inputsRoom, this.capacity * this.inputs);
  }

  /** The same for all: inputs. */
  setCommonInputs(values: ArrayLike<number>): void {
    this.give('wisp_bank_set_common_inputs', values, this.inputsRoom, this.capacity * this.inputs);
  }

  /** For one: inputs. */
  setInstanceInputs(instance: Instance, values: ArrayLike<number>): void {
    this.give('wisp_bank_set_instance_inputs', values, this.inputsRoom, this.capacity * this.inputs, instance);
  }

  /**
   * Scale of the residual noise: 1 as learned, 0 none; clamped to 0 … 10. A chain has its chance in its walk: at 0 the
   * likeliest mode follows as the segment that joins best, any other scale leaves it as it is.
   */
  setNoise(scale: number): void {
    this.call('wisp_bank_set_noise', scale);
  }

  get noise(): number {
    this.call('wisp_bank_get_noise', this.scratch);
    return this.native.data.getFloat32(this.scratch, true);
  }

  /** One step of the model, whatever the time. */
  step(): void {
    this.call('wisp_bank_step');
  }

  /** Lets time pass, in nanoseconds, and shows what lies between the last two steps. Returns the steps made. */
  advance(nanoseconds: number): number {
    const time = Number.isFinite(nanoseconds) ? BigInt(Math.round(nanoseconds)) : 0n;
    this.call('wisp_bank_advance', BigInt.asIntN(64, time), this.scratch);
    return this.native.data.getInt32(this.scratch, true);
  }

  /** Outputs of all: slots × outputs. A view that the next call may change. */
  outputsView(): Float32Array<ArrayBuffer> {
    return this.take('wisp_bank_outputs', this.outputsRoom, this.slots * this.outputs);
  }

  /** Outputs of one: a copy. */
  instanceOutputs(instance: Instance): Float32Array<ArrayBuffer> {
    return this.take('wisp_bank_instance_outputs', this.outputsRoom, this.outputs, instance).slice();
  }

  /** Outlines of all, x and y in turn from the base's left over the tip: slots × points × 2. A view, as above. */
  polylinesView(): Float32Array<ArrayBuffer> {
    return this.take('wisp_bank_polylines', this.polylinesRoom, this.slots * this.polylinePoints * 2);
  }

  /** The outline of one: points × 2. A view, as above. */
  polyline(instance: Instance): Float32Array<ArrayBuffer> {
    return this.take('wisp_bank_polyline', this.polylinesRoom, this.polylinePoints * 2, instance);
  }

  /** In the round: outputs and outlines as a level camera sees them whose right is (x, z), of length 1. */
  look(rightX: number, rightZ: number): void {
    this.call('wisp_bank_look', rightX, rightZ);
  }

  /**
   * In the round: rings of one from the base to the tip, half as many as points. Six numbers each: the middle's x, y, z,
   * the radius, and by how much it rises to its rim towards +x and +z. A view, as above.
   */
  rings(instance: Instance): Float32Array<ArrayBuffer> {
    return this.take('wisp_bank_rings', this.ringsRoom, 6 * this.ringCount, instance);
  }

  /** In the round: the surface of one, rings × segments vertices of place and normal: a copy. */
  mesh(instance: Instance, segments: number): Float32Array<ArrayBuffer> {
    this.rings(instance);
    return this.filled(6 * this.ringCount * segments, (room, count) => {
      const { wisp_ring_mesh } = this.native.functions;
      this.native.check(wisp_ring_mesh!(this.ringsRoom.pointer, this.ringCount, segments, room.pointer, count, 6));
      return room.first(count).slice();
    });
  }

  /** Three indices for each of the 2 × rings × segments − 4 triangles of `mesh()`, anticlockwise from outside. */
  triangles(segments: number): Uint32Array {
    return this.filled(6 * this.ringCount * segments - 12, (room, count) => {
      this.native.check(this.native.functions.wisp_ring_triangles!(this.ringCount, segments, room.pointer, count));
      const words = room.first(count);
      return new Uint32Array(words.buffer, words.byteOffset, count).slice();
    });
  }

  /** Whether an instance burns. */
  flameState(instance: Instance): FlameState {
    return this.struct(at.flameState.size, 'wisp_bank_get_flame_state', instance, (data, p) => ({
      lit: data.getUint32(p + at.flameState.lit, true) === 1,
      flameSize: data.getFloat32(p + at.flameState.flameSize, true),
      sinceLit: nanoseconds(data.getBigInt64(p + at.flameState.sinceLit, true)),
      sinceOut: nanoseconds(data.getBigInt64(p + at.flameState.sinceOut, true)),
      wentOut: (data.getUint32(p + at.flameState.events, true) & 1) !== 0,
      relit: (data.getUint32(p + at.flameState.events, true) & 2) !== 0,
      light: three(data, p + at.flameState.light),
      intensity: data.getFloat32(p + at.flameState.intensity, true),
      kelvin: data.getFloat32(p + at.flameState.kelvin, true),
    }));
  }

  /** The flame sizes of all: slots. A view, as above. */
  flameSizes(): Float32Array<ArrayBuffer> {
    return this.take('wisp_bank_flame_sizes', this.sizesRoom, this.slots);
  }

  /** Lights one that is out. A model whose `facts.blowOut` is null has nothing to light: that throws. */
  relight(instance: Instance): void {
    this.call('wisp_bank_relight', instance);
  }

  /** Puts one out, whatever the wind. A model whose `facts.blowOut` is null never goes out: that throws. */
  extinguish(instance: Instance): void {
    this.call('wisp_bank_extinguish', instance);
  }

  /** Sets an instance of a chain where a body is, as after a throw or a kick. Not for every frame. */
  place(instance: Instance, body: Body): void {
    const { native, scratch } = this;
    this.living();
    const put = (field: number, values: readonly number[]) =>
      values.forEach((value, k) => native.data.setFloat32(scratch + field + 4 * k, value, true));
    native.data.setUint32(scratch, at.body.size, true);
    put(at.body.position, body.position);
    put(at.body.orientation, body.orientation ?? [1, 0, 0, 0]);
    put(at.body.velocity, body.velocity ?? [0, 0, 0]);
    put(at.body.spin, body.spin ?? [0, 0, 0]);
    this.call('wisp_bank_place', instance, scratch);
  }

  /** Level ground at that height, on which instances of a chain come to rest; null: they fall for ever. */
  setGround(height: number | null): void {
    if (height === null) this.call('wisp_bank_clear_ground');
    else this.call('wisp_bank_set_ground', height);
  }

  /** What `setGround` has set. */
  get chainSettings(): ChainSettings {
    const { native, scratch } = this;
    this.living();
    native.data.setUint32(scratch, at.chainSettings.size, true);
    this.call('wisp_bank_get_chain_settings', scratch);
    const { data } = native;
    const has = data.getUint32(scratch + at.chainSettings.hasGround, true) === 1;
    return { ground: has ? data.getFloat32(scratch + at.chainSettings.ground, true) : null };
  }

  /** Where in its chain an instance is; null where the dynamics are not a chain. */
  chainPlace(instance: Instance): ChainPlace | null {
    if (!this.isChain) return null;
    return this.struct(at.chainPlace.size, 'wisp_bank_get_chain_place', instance, (data, p) => ({
      segment: data.getUint32(p + at.chainPlace.segment, true),
      step: data.getUint32(p + at.chainPlace.step, true),
      mode: data.getUint32(p + at.chainPlace.mode, true),
      velocity: three(data, p + at.chainPlace.velocity),
      spin: three(data, p + at.chainPlace.spin),
      lies: data.getUint32(p + at.chainPlace.lies, true) === 1,
      landed: data.getUint32(p + at.chainPlace.landed, true) === 1,
    }));
  }

  /** Back to where they were when spawned, lit: one, or all and the bank's time. */
  reset(instance?: Instance): void {
    if (instance === undefined) this.call('wisp_bank_reset');
    else this.call('wisp_bank_reset_instance', instance);
  }

  /** The whole state; a bank of the same model and capacity restored from it goes on with the same bits. */
  save(): Uint8Array<ArrayBuffer> {
    const { native } = this;
    this.call('wisp_bank_save_bytes', this.scratch);
    const size = native.data.getUint32(this.scratch, true);
    return native.withRoom(size, (p) => {
      this.call('wisp_bank_save', p, size);
      return native.bytes.slice(p, p + size);
    });
  }

  /** Throws, and changes nothing, when the bytes are damaged or of another model, capacity or version. */
  restore(bytes: ArrayBuffer | Uint8Array): void {
    const { native } = this;
    const given = bytes instanceof Uint8Array ? bytes : new Uint8Array(bytes);
    native.withRoom(given.length, (p) => {
      native.bytes.set(given, p);
      this.call('wisp_bank_restore', p, given.length);
    });
  }

  /** Steps of instances in which an output was clamped to its range, of how many. */
  clamped(): { clamped: number; steps: number } {
    return { clamped: this.longFact(at.bankFacts.clamped), steps: this.longFact(at.bankFacts.steps) };
  }

  /** Gives the bank's memory back; twice is fine. */
  free(): void {
    if (this.pointer === 0) return;
    this.native.functions.wisp_bank_free!(this.pointer);
    this.pointer = 0;
    this.native.free(this.scratch);
    for (const room of [this.inputsRoom, this.outputsRoom, this.polylinesRoom, this.sizesRoom, this.ringsRoom]) room.free();
  }

  private call(name: string, ...values: (number | bigint)[]): void {
    this.living();
    this.native.check(this.native.functions[name]!(this.pointer, ...values));
  }

  // A freed bank has no scratch either.
  private living(): void {
    if (this.pointer === 0) this.native.check(this.native.functions.wisp_bank_step!(0));
  }

  // What is made in room for so many numbers.
  private filled<T>(count: number, make: (room: Room, count: number) => T): T {
    this.living();
    const room = new Room(this.native, Math.max(count, 0));
    try {
      return make(room, Math.max(count, 0));
    } finally {
      room.free();
    }
  }

  private get ringCount(): number {
    return (this.polylinePoints + 1) >> 1;
  }

  private readFacts(): number {
    this.living();
    this.native.data.setUint32(this.scratch, at.bankFacts.size, true);
    this.call('wisp_bank_get_facts', this.scratch);
    return this.scratch;
  }

  private fact(field: number): number {
    const p = this.readFacts();
    return this.native.data.getUint32(p + field, true);
  }

  private longFact(field: number): number {
    const p = this.readFacts();
    return Number(this.native.data.getBigUint64(p + field, true));
  }

  private give(name: string, values: ArrayLike<number>, room: Room, most: number, ...instance: bigint[]): void {
    this.living();
    // The count goes over as it is, so that the wrong one is told in the ABI's own words.
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

  private struct<T>(size: number, name: string, instance: bigint, read: (data: DataView, p: number) => T): T {
    this.living();
    this.native.data.setUint32(this.scratch, size, true);
    this.call(name, instance, this.scratch);
    return read(this.native.data, this.scratch);
  }
}
