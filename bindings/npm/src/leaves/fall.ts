// Endlessly falling leaves: instances of one chain, each with its fall, its rest on the ground, and its return to the
// top. The bank moves them; this module sets where they start, their wind, and which are in view.

import type { Bank, Instance } from '../index.js';
import type { LeafCamera } from './camera.js';
import { MAX_LEAVES } from './limits.js';

/** Range of depths of leaves, and height near which they start, metres. */
const NEAREST = -1.35;
const FARTHEST = 3.4;
const TOP = 2.75;
/** Height below which a leaf lies on the ground. */
const LYING = 0.035;
/** Heaps: side of a ground cell, metres; half the number of columns; height of a leaf, metres; most leaves per cell. */
const CELL = 0.16;
const HALF_COLUMNS = 40;
const LAYER = 0.0045;
const MAX_LAYERS = 30;
/** Additional rest in the middle of a heap, as a multiple of a leaf's usual rest. */
const LONGER = 6;
/** Maximum number of leaves placed anew per frame, as each placing searches all segments. */
const PLACINGS = 6;
/** Milliseconds per frame for starting missing leaves beyond PLACINGS. */
const FILLING = 1.5;
const FADES = 0.7;
/** Minimum wind that can lift a leaf off the ground, metres a second, and mean duration of the lift. */
const LIFTING = 0.9;
const LIFT_SECONDS = 0.45;
/** Squared reach of the pointer's gust, metres². */
const REACH2 = 1.4;
/** Orientation of leaves whose model outputs only positions. */
const LEVEL = [1, 0, 0, 0] as const;
/** Numbers per instance on the graphics card: x, y, z, opacity; quaternion w, x, y, z. */
export const LEAF_NUMBERS = 8;

/** A gust in the scene: local air that moves at a position (x, z) in all depths, wind everywhere, and a kick. */
export interface Gust {
  /** position and velocity of the local air, metres and metres a second */
  x: number;
  z: number;
  speedX: number;
  speedZ: number;
  /** wind along x in the whole scene */
  everywhere: number;
  /** upward impulse at the ground around a place; 0: none */
  kick: number;
  kickX: number;
  kickY: number;
  /** reach of the impulse, metres */
  kickReach: number;
}

export class LeafFall {
  readonly shown = new Float32Array(LEAF_NUMBERS * MAX_LEAVES);
  count = 0;
  wanted = 0;
  /** number of leaves on the ground */
  lying = 0;
  private readonly ids: Instance[] = [];
  private readonly offsetX = new Float32Array(MAX_LEAVES);
  private readonly offsetY = new Float32Array(MAX_LEAVES);
  private readonly rested = new Float32Array(MAX_LEAVES);
  private readonly rests = new Float32Array(MAX_LEAVES);
  private readonly lift = new Float32Array(MAX_LEAVES);
  private readonly seen = new Float32Array(MAX_LEAVES);
  /** number of leaves in each ground cell; cell and layer of each lying leaf, −1 and 0 for others */
  private readonly heights = new Uint8Array(2 * HALF_COLUMNS * Math.ceil((FARTHEST - NEAREST) / CELL));
  private readonly cells = new Int32Array(MAX_LEAVES).fill(-1);
  private readonly layers = new Float32Array(MAX_LEAVES);
  private readonly wide: boolean;
  private random: number;
  private clock = 0;
  /** speed of the gust's local air */
  private stroke = 0;

  /** `bank`: empty, with room for MAX_LEAVES. */
  constructor(private readonly bank: Bank, private readonly camera: LeafCamera, seed: number) {
    this.wide = bank.outputs >= 7;
    this.random = (seed * 2654435761) >>> 0 || 1;
    bank.setGround(0);
  }

  /** Sets the wanted number of leaves: ends surplus leaves at once, and starts missing ones in the next updates. */
  want(count: number): void {
    this.wanted = Math.min(count, MAX_LEAVES);
    while (this.ids.length > this.wanted) {
      this.bank.end(this.ids.pop() as Instance);
      if ((this.cells[this.ids.length] as number) >= 0) this.leaveHeap(this.ids.length);
    }
    this.count = Math.min(this.count, this.ids.length);
  }

  /** Starts missing leaves, sets the winds, and advances the bank by `seconds`. */
  update(seconds: number, gust: Gust): void {
    this.clock += seconds;
    let placings = PLACINGS;
    const began = performance.now();
    while (this.ids.length < this.wanted && (placings > 0 || performance.now() - began < FILLING)) {
      const slot = this.ids.push(this.bank.spawn(this.ids.length)) - 1;
      this.start(slot, TOP * (0.12 + 0.95 * this.chance()));
      this.count = this.ids.length;
      placings = Math.max(0, placings - 1);
    }
    this.blow(gust);
    this.bank.advance(seconds * 1e9);
    this.gather(seconds, gust, placings);
  }

  private chance(): number {
    // xorshift: fast, and reproducible for a seed.
    let word = this.random;
    word ^= word << 13;
    word ^= word >>> 17;
    word ^= word << 5;
    this.random = word >>> 0;
    return this.random / 4294967296;
  }

  /** Starts a leaf at a height, at a random place. */
  private start(slot: number, height: number): void {
    // Denser near the eye, where the view is narrow, than a uniform distribution over the ground.
    const y = NEAREST + (FARTHEST - NEAREST) * Math.pow(this.chance(), 0.72);
    const half = this.camera.halfWidth(y) + 0.3;
    this.offsetX[slot] = (2 * this.chance() - 1) * half;
    this.offsetY[slot] = y;
    this.rested[slot] = 0;
    this.rests[slot] = 3 + 9 * this.chance();
    this.lift[slot] = 0;
    this.seen[slot] = 0;
    const turn = this.chance() * Math.PI;
    const tilt = 0.5 * (this.chance() - 0.5);
    this.bank.place(this.ids[slot] as Instance, {
      position: [0, 0, height],
      orientation: [Math.cos(turn), tilt * Math.cos(3 * turn), tilt * Math.sin(3 * turn), Math.sin(turn)],
      velocity: [0.3 * (this.chance() - 0.5), 0.3 * (this.chance() - 0.5), -0.6],
    });
  }

  /** Sets the wind of every leaf. */
  private blow(gust: Gust): void {
    const { bank, shown, lift, clock } = this;
    if (bank.inputs !== 3 || this.ids.length === 0) return;
    const winds = bank.inputsView();
    const aside = 0.25 * Math.sin(3 * clock);
    const still = Math.abs(gust.speedX) + Math.abs(gust.speedZ) < 0.05 && gust.everywhere === 0;
    for (let slot = 0; slot < this.count; ++slot) {
      const k = LEAF_NUMBERS * slot;
      let windX = 0;
      let windZ = (lift[slot] as number) > 0 ? 2.2 : 0;
      if (!still) {
        const x = shown[k] as number;
        const z = shown[k + 2] as number;
        const dx = x - gust.x;
        const dz = z - gust.z;
        const far2 = dx * dx + dz * dz;
        if (far2 < REACH2) {
          const near = nearness(far2);
          windX += gust.speedX * near;
          windZ += gust.speedZ * near;
        }
        if (gust.everywhere !== 0) {
          const waves = 0.75 + 0.25 * Math.sin(2.1 * x - 5 * clock + 1.7 * (shown[k + 1] as number));
          windX += gust.everywhere * waves;
          windZ += 0.3 * Math.abs(gust.everywhere) * (waves - 0.6);
        }
      }
      winds[3 * slot] = windX;
      winds[3 * slot + 1] = slot % 2 === 0 ? aside * windX : -aside * windX;
      winds[3 * slot + 2] = windZ;
    }
    bank.setInputs(winds);
  }

  /** Reads positions, restarts leaves that have lain long enough, and lifts leaves that a gust or kick reaches. */
  private gather(seconds: number, gust: Gust, placings: number): void {
    const outputs = this.bank.outputsView();
    const { shown, seen } = this;
    const stride = this.bank.outputs;
    const again: number[] = [];
    const kicked: number[] = [];
    this.lying = 0;
    this.stroke = Math.hypot(gust.speedX, gust.speedZ);
    for (let slot = 0; slot < this.count; ++slot) {
      const from = stride * slot;
      const to = LEAF_NUMBERS * slot;
      const y = wrapped((outputs[from + 1] as number) + (this.offsetY[slot] as number), NEAREST, FARTHEST);
      const half = this.camera.halfWidth(y) + 0.3;
      const x = wrapped((outputs[from] as number) + (this.offsetX[slot] as number), -half, half);
      const z = outputs[from + 2] as number;
      shown[to] = x;
      shown[to + 1] = y;
      shown[to + 2] = z;
      for (let k = 0; k < 4; ++k) shown[to + 4 + k] = this.wide ? (outputs[from + 3 + k] as number) : LEVEL[k]!;
      this.lift[slot] = Math.max(0, (this.lift[slot] as number) - seconds);
      const tired = this.rest(slot, x, y, z, seconds);
      shown[to + 2] = z + LAYER * (this.layers[slot] as number);
      if (tired && placings > again.length && seen[slot] === 0) again.push(slot);
      if (z < LYING && again.length + kicked.length < placings && this.lifts(x, y, gust)) kicked.push(slot);
      seen[slot] = Math.max(0, Math.min(1, (seen[slot] as number) + (tired ? -seconds : seconds) / FADES));
      shown[to + 3] = seen[slot] as number;
    }
    for (const slot of again) this.start(slot, TOP * (0.8 + 0.3 * this.chance()));
    for (const slot of kicked) this.kick(slot, gust);
  }

  /** Advances a leaf's rest. Returns whether it has lain long enough, which takes longer in heaps so that they grow. */
  private rest(slot: number, x: number, y: number, z: number, seconds: number): boolean {
    if (z >= LYING) {
      this.rested[slot] = 0;
      if ((this.cells[slot] as number) >= 0) this.leaveHeap(slot);
      return false;
    }
    this.lying += 1;
    if ((this.cells[slot] as number) < 0) this.joinHeap(slot, x, y);
    this.rested[slot] = (this.rested[slot] as number) + seconds;
    const overdue = (this.rested[slot] as number) / (this.rests[slot] as number);
    return overdue > 1 && overdue > 1 + LONGER * heap(x, y);
  }

  private joinHeap(slot: number, x: number, y: number): void {
    const column = Math.floor(x / CELL) + HALF_COLUMNS;
    const row = Math.floor((y - NEAREST) / CELL);
    const cell = Math.max(0, Math.min(this.heights.length - 1, row * 2 * HALF_COLUMNS + column));
    this.cells[slot] = cell;
    this.layers[slot] = this.heights[cell] as number;
    this.heights[cell] = Math.min(MAX_LAYERS, (this.heights[cell] as number) + 1);
  }

  private leaveHeap(slot: number): void {
    const cell = this.cells[slot] as number;
    this.heights[cell] = Math.max(0, (this.heights[cell] as number) - 1);
    this.cells[slot] = -1;
    this.layers[slot] = 0;
  }

  private lifts(x: number, y: number, gust: Gust): boolean {
    if (gust.kick > 0) {
      const dx = x - gust.kickX;
      const dy = y - gust.kickY;
      if (Math.exp(-(dx * dx + dy * dy) / gust.kickReach ** 2) * gust.kick > 0.15 + 0.6 * this.chance()) return true;
    }
    const dx = x - gust.x;
    const dz = 0.1 - gust.z;
    const wind = this.stroke * nearness(dx * dx + dz * dz) + Math.abs(gust.everywhere);
    return wind > LIFTING && wind > LIFTING * (1 + 2 * this.chance());
  }

  private kick(slot: number, gust: Gust): void {
    const outputs = this.bank.instanceOutputs(this.ids[slot] as Instance);
    const spread = (): number => this.chance() - 0.5;
    this.bank.place(this.ids[slot] as Instance, {
      position: [outputs[0] as number, outputs[1] as number, LYING + 0.02],
      orientation: this.wide ? ([...outputs.subarray(3, 7)] as [number, number, number, number]) : LEVEL,
      velocity: [0.5 * gust.everywhere + 0.3 * gust.speedX + spread(), spread(), 1.6 + 1.4 * this.chance()],
      spin: [8 * spread(), 8 * spread(), 6 * spread()],
    });
    this.lift[slot] = LIFT_SECONDS * (0.6 + 0.8 * this.chance());
    this.rested[slot] = 0;
    this.seen[slot] = Math.max(0.5, this.seen[slot] as number);
  }
}

/** Density of the two heaps at a place, where wind has swept leaves together. */
function heap(x: number, y: number): number {
  const left = ((x + 0.75) / 0.55) ** 2 + ((y - 0.9) / 0.45) ** 2;
  const right = ((x - 1.15) / 0.7) ** 2 + ((y - 1.6) / 0.5) ** 2;
  return Math.exp(-left) + Math.exp(-right);
}

/** Share of a gust at a squared distance: a bell curve with finite support. */
function nearness(far2: number): number {
  const share = Math.max(0, 1 - far2 / REACH2);
  return share * share * share;
}

function wrapped(value: number, low: number, high: number): number {
  const range = high - low;
  return value - range * Math.floor((value - low) / range);
}
