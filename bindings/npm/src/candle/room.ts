// Positions of things in the candle's room, and their projection to the picture.
//
// Room units: 1 is the height of a lone candle's calm flame. x right, y up from the table, z towards the eye. The eye
// looks horizontally, so verticals stay vertical and a flame is a flat board facing the eye.

/** Position and size of a candle. */
export interface Stand {
  x: number;
  z: number;
  /** height of its support */
  ground: number;
  height: number;
  radius: number;
  /** height of its calm flame (1 flame unit), room units */
  unit: number;
  wax: readonly [number, number, number];
  striped: boolean;
  /** radius of its dish; 0: none */
  saucer: number;
  seed: number;
  /** index below MAX_LAMPS of the light of its flame; many candles share lights */
  lamp: number;
  /** digit shape of the candle; null: a stick */
  figure: string | null;
}

/** Arrangement on the table. */
export interface Setting { stands: Stand[]; cake: { x: number; radius: number; height: number } | null }

/** Maximum number of candles on a cake, and of lights for them; more candles than lights share lights. */
export const MAX_CANDLES = 100;
export const MAX_LAMPS = 12;
/** Height of a digit candle. */
const FIGURE_HEIGHT = 0.95;
/** Maximum digits of a number on a cake. */
const MAX_DIGITS = 3;

/** Digit candles for a text: its first MAX_DIGITS digits. */
export const figuresOf = (text: string): string => text.replace(/\D/g, '').slice(0, MAX_DIGITS);

/** Distance from a candle's upper end to its flame's base, flame units. */
const WICK_GAP = 0.085;

/** Height in the room of the base of a candle's flame. */
export const flameFoot = ({ ground, height, unit }: Stand): number => ground + height + WICK_GAP * unit;

const PASTELS: readonly (readonly [number, number, number])[] = [
  [0.92, 0.42, 0.46],
  [0.42, 0.66, 0.88],
  [0.94, 0.74, 0.36],
  [0.52, 0.78, 0.56],
  [0.72, 0.54, 0.86],
];

/** A single candle, or a cake with 2 to MAX_CANDLES candles or with digit candles. */
export function settingFor(candles: number, figures = ''): Setting {
  const plain = { lamp: 0, figure: null, striped: false, saucer: 0, z: 0, ground: 0 };
  if (candles <= 1 && figures === '') {
    const wax = [0.93, 0.86, 0.74] as const;
    return { cake: null, stands: [{ ...plain, x: 0, height: 1.72, radius: 0.335, unit: 1, wax, saucer: 0.74, seed: 3 }] };
  }
  const cake = { x: 0, radius: 1.9, height: 1.06 };
  const on = { ...plain, ground: cake.height };
  const hue = (k: number): (typeof PASTELS)[number] => PASTELS[k % PASTELS.length] as (typeof PASTELS)[number];
  if (figures !== '') {
    const middle = (figures.length - 1) / 2;
    const stands = [...figures].map((figure, k): Stand => ({ ...on, x: 0.92 * (k - middle), z: 0.5, height: FIGURE_HEIGHT, radius: 0.1, unit: 0.5, wax: hue(k), seed: k + 1, lamp: k, figure }));
    return { cake, stands };
  }
  // More than MAX_LAMPS candles are smaller.
  const small = candles <= MAX_LAMPS ? 1 : Math.max(0.5, (MAX_LAMPS / candles) ** 0.3);
  const spots = candles <= MAX_LAMPS ? places(candles) : rings(candles);
  const stands = spots.map(
    ([x, z], k): Stand => ({
      ...on,
      x,
      z,
      height: 0.74 * (0.4 + 0.6 * small),
      radius: 0.072 * small,
      unit: 0.46 * small,
      wax: hue(k),
      striped: true,
      seed: k + 1,
      lamp: candles <= MAX_LAMPS ? k : Math.floor((k * MAX_LAMPS) / candles),
    }),
  );
  // Sorted from far to near, as nearer ones are drawn over them.
  return { cake, stands: stands.sort((a, b) => a.z - b.z) };
}

/** Positions of many candles on 2, 3 or 6 rings; the number on a ring is proportional to its radius. */
function rings(candles: number): [number, number][] {
  const radii = [1.42, 1.16, 0.9, 0.64, 0.38, 0.12].slice(0, candles <= 30 ? 2 : candles <= 50 ? 3 : 6);
  const around = radii.reduce((sum, radius) => sum + radius, 0);
  let left = candles;
  let total = around;
  return radii.flatMap((radius, ring) => {
    const many = ring === radii.length - 1 ? left : Math.round((left * radius) / total);
    left -= many;
    total -= radius;
    return Array.from({ length: many }, (_, k): [number, number] => {
      const turn = (2 * Math.PI * (k + 0.5 * (ring % 2))) / Math.max(1, many) + 0.4;
      return [radius * Math.cos(turn), radius * Math.sin(turn)];
    });
  });
}

const DISTANCE = 11;

/** Scale at a depth relative to z = 0. */
const nearnessAt = (z: number): number => DISTANCE / (DISTANCE - z);

/** Positions around the cake, alternately in front and behind, evenly spaced in the view: none hides another. */
function places(candles: number): [x: number, z: number][] {
  const ring = candles < 4 ? 0.85 : 1.36;
  return Array.from({ length: candles }, (_, k): [number, number] => {
    const seen = ring * ((2 * k + 1) / candles - 1);
    const side = k % 2 === 0 ? 1 : -1;
    let x = seen;
    let z = 0;
    for (let round = 0; round < 8; ++round) {
      z = side * Math.sqrt(Math.max(0, ring * ring - x * x));
      x = Math.max(-ring, Math.min(ring, seen / nearnessAt(z)));
    }
    return [x, z];
  });
}

/** Projection of the room to a picture. Pixels, y up from the lower edge. */
export class RoomView {
  readonly eye = 3.4;
  readonly distance = DISTANCE;
  readonly nearness = nearnessAt;
  width = 1;
  footer = 0;
  clear = false;
  height = 1;
  /** pixels per unit at z = 0 */
  scale = 1;
  /** pixel column of x = 0 */
  middle = 0;
  /** pixel row of the eye's height */
  horizon = 0;

  /**
   * Fits the setting into a picture. `footer`: share of the picture's height covered by controls below; `clear`: a
   * cake's candles without the cake; `above`: extra height of digits over sticks.
   */
  frame(width: number, height: number, cake: boolean, footer: number, clear: boolean, above = 0): void {
    Object.assign(this, { width, height, footer, clear });
    const free = height * (1 - footer);
    // Room units: height and width of the drawn part, and height of the table (y = 0) above its lower edge.
    const [tall, wide, low] = cake ? (clear ? [1.95, 3.4, -0.6] : [4 + above, 5, 0.94]) : [3.6, 2.9, 0.4];
    this.scale = Math.min(free / tall, width / wide);
    this.middle = width / 2;
    // In tall pictures the setting stays near the middle.
    const spare = Math.max(0, free - this.scale * tall);
    const foot = height * footer + 0.42 * spare + this.scale * low;
    this.horizon = foot + this.scale * this.eye;
  }

  pixelX(x: number, z: number): number {
    return this.middle + x * this.nearness(z) * this.scale;
  }

  pixelY(y: number, z: number): number {
    return this.horizon + (y - this.eye) * this.nearness(z) * this.scale;
  }

  roomX(pixel: number, z: number): number {
    return (pixel - this.middle) / (this.nearness(z) * this.scale);
  }

  roomY(pixel: number, z: number): number {
    return this.eye + (pixel - this.horizon) / (this.nearness(z) * this.scale);
  }

  /** Height / width in the picture of a level circle at height y and depth z. */
  flatness(y: number, z: number): number {
    return Math.max(0.02, (this.eye - y) / (this.distance - z));
  }
}
