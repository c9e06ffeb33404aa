// A loop of a flame as a flipbook: its pictures side by side in one PNG, and where they are, as engines and sprite tools take it.

import type { Exported } from '@wisp/studio';
import { paintFlame } from './flame_paint.js';

/** Pixels of the outline's own height. */
export const FLIPBOOK_HEIGHT = 192;
const MAX_PICTURES = 64;
/** Around the outline, for its light, in heights. */
const ROOM = 0.4;
const POINTS_A_CURVE = 8;

type Pair = [number, number];
type Path = Readonly<Record<'v' | 'i' | 'o', readonly Pair[]>>;

interface Loop {
  rate: number;
  width: number;
  height: number;
  lines: Float32Array[];
}

/** The curves of a path as points; ways in and out are told from the vertex. */
function lineOf({ v, i, o }: Path): Float32Array {
  const line: number[] = [];
  for (let k = 0; k + 1 < v.length; ++k) {
    const [from, to] = [v[k] as Pair, v[k + 1] as Pair];
    for (let part = k === 0 ? 0 : 1; part <= POINTS_A_CURVE; ++part) {
      const t = part / POINTS_A_CURVE;
      for (const axis of [0, 1] as const) {
        const out = from[axis] + (o[k] as Pair)[axis];
        const into = to[axis] + (i[k + 1] as Pair)[axis];
        line.push((1 - t) ** 3 * from[axis] + 3 * (1 - t) ** 2 * t * out + 3 * (1 - t) * t * t * into + t ** 3 * to[axis]);
      }
    }
  }
  return Float32Array.from(line);
}

/** The loop that a Lottie file of ours holds, in as many pictures as a sheet takes. */
function loopOf(lottie: Uint8Array): Loop {
  const { fr, w, h, layers } = JSON.parse(new TextDecoder().decode(lottie));
  const keys = (layers[0].shapes[0].it[0].ks.k as { s?: [Path] }[]).flatMap(({ s }) => s ?? []);
  const step = Math.ceil(keys.length / MAX_PICTURES);
  const pictures = Math.ceil(keys.length / step);
  // Evenly spaced, so that the loop has no seam where the step does not divide it.
  const lines = Array.from({ length: pictures }, (_, k) => lineOf(keys[Math.round((k * keys.length) / pictures)] as Path));
  return { rate: (fr * pictures) / keys.length, width: w, height: h, lines };
}

/** What stands still: the middle of the base, over all pictures. */
function baseOf(lines: readonly Float32Array[]): Pair {
  const middle = (axis: 0 | 1): number =>
    lines.reduce((sum, line) => sum + ((line[axis] as number) + (line[line.length - 2 + axis] as number)) / 2, 0) / lines.length;
  return [middle(0), middle(1)];
}

/**
 * Paints a loop, from the Lottie file of it: NAME.png of straight opacity, and NAME.atlas.json in the list form that sprite
 * packers write, as the program's export has it.
 */
export async function flipbookOf(lottie: Uint8Array, name: string): Promise<Exported[]> {
  const { rate, width, height, lines } = loopOf(lottie);
  const room = Math.round(ROOM * height);
  const [w, h] = [width + 2 * room, height + 2 * room];
  const columns = Math.ceil(Math.sqrt((lines.length * h) / w));
  const rows = Math.ceil(lines.length / columns);
  const canvas = new OffscreenCanvas(columns * w, rows * h);
  const context = canvas.getContext('2d');
  if (context === null) throw new Error('There is no place to draw.');
  const [x, y] = baseOf(lines);
  const frames = lines.map((line, k) => {
    const at = { x: (k % columns) * w, y: Math.floor(k / columns) * h };
    context.save();
    context.beginPath();
    context.rect(at.x, at.y, w, h);
    context.clip();
    paintFlame(context, line.map((value, n) => value + room + (n % 2 === 0 ? at.x : at.y)), height, ROOM);
    context.restore();
    return {
      filename: String(k),
      frame: { ...at, w, h },
      rotated: false,
      trimmed: false,
      spriteSourceSize: { x: 0, y: 0, w, h },
      sourceSize: { w, h },
      duration: 1000 / rate,
      pivot: { x: (room + x) / w, y: (room + y) / h },
    };
  });
  const meta = { app: 'Wisp', image: `${name}.png`, format: 'RGBA8888', premultiplied: false, size: { w: canvas.width, h: canvas.height }, scale: '1', columns, rows, rate_hz: rate, loop: true };
  const png = await canvas.convertToBlob({ type: 'image/png' });
  return [
    { name: `${name}.png`, bytes: new Uint8Array(await png.arrayBuffer()) },
    { name: `${name}.atlas.json`, bytes: new TextEncoder().encode(`${JSON.stringify({ frames, meta })}\n`) },
  ];
}
