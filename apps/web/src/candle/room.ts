// Where things stand in the candle's room, and where that is in the picture.
//
// Room units: 1 is the height of a lone candle's calm flame. x right, y up from the table, z towards the eye. The eye
// looks straight ahead, so that verticals stay vertical and a flame is a flat board that faces it.

/** A candle as it stands. */
export interface Stand {
  x: number;
  z: number;
  /** height of what it stands on */
  ground: number;
  height: number;
  radius: number;
  /** room units a flame unit */
  unit: number;
  wax: readonly [number, number, number];
  striped: boolean;
  seed: number;
}

/** What stands on the table. */
export interface Setting {
  stands: Stand[];
  cake: { x: number; radius: number; height: number } | null;
}

/** Most candles on a cake. */
export const MOST_CANDLES = 12;

/** From the upper end of a candle to the base of its flame, in flame units. */
export const WICK_GAP = 0.085;

const PASTELS: readonly (readonly [number, number, number])[] = [
  [0.92, 0.42, 0.46],
  [0.42, 0.66, 0.88],
  [0.94, 0.74, 0.36],
  [0.52, 0.78, 0.56],
  [0.72, 0.54, 0.86],
];

/** One candle by itself, or a cake with 2 to MOST_CANDLES of them. */
export function settingFor(candles: number): Setting {
  if (candles <= 1) {
    const wax = [0.93, 0.85, 0.72] as const;
    return {
      cake: null,
      stands: [{ x: 0, z: 0, ground: 0, height: 1.72, radius: 0.335, unit: 1, wax, striped: false, seed: 3 }],
    };
  }
  const cake = { x: 0, radius: 1.9, height: 1.06 };
  const ring = candles < 4 ? 0.85 : 1.32;
  const start = clearestTurn(candles);
  const stands = Array.from({ length: candles }, (_, k): Stand => {
    const turn = (2 * Math.PI * k) / candles + start;
    return {
      x: ring * Math.cos(turn),
      z: ring * Math.sin(turn),
      ground: cake.height,
      height: 0.74,
      radius: 0.072,
      unit: 0.46,
      wax: PASTELS[k % PASTELS.length] as (typeof PASTELS)[number],
      striped: true,
      seed: k + 1,
    };
  });
  // The farthest first: nearer ones are drawn over them.
  return { cake, stands: stands.sort((a, b) => a.z - b.z) };
}

/** The turn of the ring in which no candle hides another, as far as that goes. */
function clearestTurn(candles: number): number {
  let best = 0;
  let widest = -1;
  for (let trial = 1; trial < 40; ++trial) {
    const start = (trial / 40) * ((2 * Math.PI) / candles);
    const across = Array.from({ length: candles }, (_, k) => Math.cos((2 * Math.PI * k) / candles + start)).sort((a, b) => a - b);
    const gap = Math.min(...across.slice(1).map((x, k) => x - (across[k] as number)));
    if (gap > widest) [widest, best] = [gap, start];
  }
  return best;
}

/** A picture of the room. Pixels, y up from the lower edge. */
export class RoomView {
  readonly eye = 3.4;
  readonly distance = 11;
  width = 1;
  height = 1;
  /** pixels a unit at z = 0 */
  scale = 1;
  /** pixel of x = 0 */
  middle = 0;
  /** pixel of the eye's height */
  horizon = 0;

  /** Frames what stands on the table in a picture of that size. */
  frame(width: number, height: number, cake: boolean): void {
    this.width = width;
    this.height = height;
    this.scale = cake ? Math.min(height / 4.7, width / 5.0) : Math.min(height / 4.6, width / 3.0);
    this.middle = width / 2;
    const foot = cake ? 0.245 : 0.225;
    // Where the picture is tall, what stands there stays in its middle.
    const spare = Math.max(0, height - this.scale * (cake ? 4.5 : 4.6));
    this.horizon = foot * (height - spare) + spare * 0.34 + this.scale * this.eye;
  }

  /** How much larger things look at that depth than at z = 0. */
  nearness(z: number): number {
    return this.distance / (this.distance - z);
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

  /** How round a level circle at that height and depth looks: the share of its width that is seen as height. */
  flatness(y: number, z: number): number {
    return Math.max(0.02, (this.eye - y) / (this.distance - z));
  }
}
