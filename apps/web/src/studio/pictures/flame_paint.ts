// Paints a flame: a body from its outline, a bright core, a blue foot, and a glow.

import { shaded, trace, WHOLE, type Stops } from './surface.js';

/** Radius of the glow, flame heights. */
const REACH = 1.5;
/** Colours of the glow from the middle outwards, and of body and core from foot to top. */
const GLOW: Stops = [[0, 'rgb(255 150 60 / 34%)'], [0.35, 'rgb(255 120 40 / 12%)'], [1, 'rgb(255 110 30 / 0%)']];
const BODY: Stops = [[0, 'rgb(70 90 200 / 55%)'], [0.12, 'rgb(255 140 60 / 82%)'], [0.4, '#ffc46a'], [1, '#ff9a3c']];
const CORE: Stops = [[0, 'rgb(255 190 110 / 0%)'], [0.3, 'rgb(255 232 180 / 34%)'], [0.75, 'rgb(255 250 236 / 42%)'], [1, 'rgb(255 224 160 / 0%)']];

/** Paints a flame with an outline in pixels, x and y alternating, from the base's left over the tip to its right. */
export function paintFlame(context: CanvasRenderingContext2D, line: Float32Array, height: number): void {
  let [top, foot, middle, low] = [Infinity, -Infinity, 0, 0];
  for (let k = 0; k < line.length; k += 2) {
    top = Math.min(top, line[k + 1] as number);
    foot = Math.max(foot, line[k + 1] as number);
    middle += (line[k] as number) / (line.length / 2);
    low += (line[k + 1] as number) / (line.length / 2);
  }
  if (!(foot - top > 1)) return;
  context.save();
  context.globalCompositeOperation = 'lighter';
  context.fillStyle = shaded(context.createRadialGradient(middle, low, 0, middle, low, REACH * height), GLOW);
  context.fillRect(middle - 2 * height, low - 2 * height, 4 * height, 4 * height);
  context.globalCompositeOperation = 'source-over';
  context.shadowColor = 'rgb(255 150 60 / 90%)';
  context.shadowBlur = 0.14 * height;
  context.fillStyle = shaded(context.createLinearGradient(0, foot, 0, top), BODY);
  trace(context, line, WHOLE);
  context.closePath();
  context.fill();
  context.shadowColor = 'rgb(255 240 200 / 60%)';
  context.shadowBlur = 0.05 * height;
  context.fillStyle = shaded(context.createLinearGradient(0, foot, 0, top), CORE);
  for (const inset of [0.1, 0.17, 0.24, 0.31]) paintCore(context, line, foot, top, inset);
  context.restore();
}

// Fills one layer of the core: the outline narrowed towards its middle by `inset` at every height, and slightly lower.
function paintCore(context: CanvasRenderingContext2D, line: Float32Array, foot: number, top: number, inset: number): void {
  const points = line.length / 2;
  context.beginPath();
  for (let k = 0; k < points; ++k) {
    const other = points - 1 - k;
    const [x, y] = [line[2 * k] as number, line[2 * k + 1] as number];
    const [across, level] = [line[2 * other] as number, line[2 * other + 1] as number];
    context.lineTo(x + inset * (across - x), foot + (1 - 0.4 * inset) * (y + inset * (level - y) - foot) - 0.1 * inset * (foot - top));
  }
  context.closePath();
  context.fill();
}
