// A canvas as sharp as the screen.

import type { Kept } from '../reel.js';

/** Fits a canvas to its place and clears it; null where nothing can be drawn. The unit is the CSS pixel. */
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

/** How a picture lies in a place: every pixel of it is `scale` of ours, the first at x and y. */
export interface Fit {
  scale: number;
  x: number;
  y: number;
}

/** All of a picture, in the middle. */
export function contain(picture: { width: number; height: number }, width: number, height: number): Fit {
  const scale = Math.min(width / picture.width, height / picture.height);
  return { scale, x: (width - scale * picture.width) / 2, y: (height - scale * picture.height) / 2 };
}

/** A line through points, x and y by turns; `x` and `y` say where each goes. */
export function trace(context: CanvasRenderingContext2D | OffscreenCanvasRenderingContext2D, line: ArrayLike<number>, { scale, x, y }: Fit): void {
  context.beginPath();
  for (let k = 0; k + 1 < line.length; k += 2) context.lineTo(x + scale * (line[k] as number), y + scale * (line[k + 1] as number));
}

/** A kept picture, at its place in the film. */
export function drawKept(context: CanvasRenderingContext2D, { part, bitmap }: Kept, { scale, x, y }: Fit): void {
  context.drawImage(bitmap, x + scale * part.x, y + scale * part.y, scale * part.width, scale * part.height);
}
