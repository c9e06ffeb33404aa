// A canvas at the screen's resolution.

import type { Region } from '@wisp/studio';
import type { Kept } from '../reel.js';

/** Fits a canvas to its element's size and clears it; null where drawing is impossible. Units are CSS pixels. */
export function surfaceOf(canvas: HTMLCanvasElement): { context: CanvasRenderingContext2D; width: number; height: number } | null {
  const context = canvas.getContext('2d');
  const { clientWidth: width, clientHeight: height } = canvas;
  if (context === null || width === 0 || height === 0) return null;
  const share = Math.min(2, window.devicePixelRatio);
  const [across, down] = [Math.round(width * share), Math.round(height * share)];
  if (canvas.width !== across || canvas.height !== down) {
    canvas.width = across;
    canvas.height = down;
  }
  context.setTransform(share, 0, 0, share, 0, 0);
  context.clearRect(0, 0, width, height);
  return { context, width, height };
}

/** Returns a function that requests `draw` for the next screen refresh, at most once per refresh. */
export function atRefresh(draw: () => void): () => void {
  let asked = 0;
  return () => {
    asked ||= requestAnimationFrame(() => {
      asked = 0;
      draw();
    });
  };
}

/** Placement of a picture: `scale` CSS pixels per pixel of the picture, its upper left corner at x and y. */
export interface Fit { scale: number; x: number; y: number }

/** Placement of a whole picture, centred. */
export function contain(picture: { width: number; height: number }, width: number, height: number): Fit {
  const scale = Math.min(width / picture.width, height / picture.height);
  return { scale, x: (width - scale * picture.width) / 2, y: (height - scale * picture.height) / 2 };
}

/** Placement of a film with which a part of it fits into a cell, centred. */
export function fitPart(part: Region, cell: Region): Fit {
  const { scale, x, y } = contain(part, cell.width, cell.height);
  return { scale, x: cell.x + x - scale * part.x, y: cell.y + y - scale * part.y };
}

/** Converts a line from pixels of the film to CSS pixels. */
export const placed = (line: Float32Array, { scale, x, y }: Fit): Float32Array => line.map((value, k) => (k % 2 === 0 ? x : y) + scale * value);

export const WHOLE: Fit = { scale: 1, x: 0, y: 0 };

/** Begins a path through points, x and y alternating, placed by a fit; the caller strokes or fills it. */
export function trace(context: CanvasRenderingContext2D, line: ArrayLike<number>, { scale, x, y }: Fit): void {
  context.beginPath();
  for (let k = 0; k + 1 < line.length; k += 2) context.lineTo(x + scale * (line[k] as number), y + scale * (line[k + 1] as number));
}

/** Strokes a line through points, x and y alternating, placed by a fit. */
export function stroke(context: CanvasRenderingContext2D, line: ArrayLike<number>, fit: Fit, colour: string, width: number): void {
  trace(context, line, fit);
  Object.assign(context, { strokeStyle: colour, lineWidth: width });
  context.stroke();
}

/** Colours of a gradient, each at a share of the way. */
export type Stops = readonly (readonly [share: number, colour: string])[];

export function shaded(gradient: CanvasGradient, stops: Stops): CanvasGradient {
  for (const [share, colour] of stops) gradient.addColorStop(share, colour);
  return gradient;
}

/** Draws a kept picture at its position in the film. */
export function drawKept(context: CanvasRenderingContext2D, { part, bitmap }: Kept, { scale, x, y }: Fit): void {
  context.drawImage(bitmap, x + scale * part.x, y + scale * part.y, scale * part.width, scale * part.height);
}
