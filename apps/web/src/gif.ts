// Records a few seconds of a canvas as a GIF: 256 colours, but shown by every chat and forum.

import { applyPalette, GIFEncoder, quantize } from 'gifenc';

/** Milliseconds between pictures. Viewers count in hundredths of a second. */
const STEP_MS = 50;
/** Length of the longer side, pixels. */
const LONGEST = 480;
/** Dithering matrix: with 256 colours, the slow falloff of light around a flame would show as rings. */
const DITHER = [0, 8, 2, 10, 12, 4, 14, 6, 3, 11, 1, 9, 15, 7, 13, 5];
const DITHER_LEVELS = 10;

/** Returns pictures of the canvas, each read in the frame that drew it, as the canvas is cleared afterwards. */
function pictures(canvas: HTMLCanvasElement, seconds: number): Promise<ImageData[]> {
  const scale = Math.min(1, LONGEST / Math.max(canvas.width, canvas.height));
  const small = new OffscreenCanvas(Math.max(1, Math.round(canvas.width * scale)), Math.max(1, Math.round(canvas.height * scale)));
  const context = small.getContext('2d', { willReadFrequently: true });
  if (context === null) throw new Error('There is no place to draw.');
  const wanted = Math.round((1000 * seconds) / STEP_MS);
  return new Promise((resolve) => {
    const taken: ImageData[] = [];
    let first: number | null = null;
    const take = (now: number): void => {
      first ??= now;
      // A late frame is repeated for the frames missed before it.
      while (taken.length < wanted && taken.length * STEP_MS <= now - first) {
        context.drawImage(canvas, 0, 0, small.width, small.height);
        taken.push(context.getImageData(0, 0, small.width, small.height));
      }
      if (taken.length === wanted) resolve(taken);
      else requestAnimationFrame(take);
    };
    requestAnimationFrame(take);
  });
}

function dither({ data, width }: ImageData): void {
  for (let at = 0; at < data.length; at += 4) {
    const [x, y] = [(at >> 2) % width, Math.floor((at >> 2) / width)];
    const shift = ((DITHER[(y & 3) * 4 + (x & 3)] as number) / 16 - 0.47) * DITHER_LEVELS;
    for (let c = 0; c < 3; ++c) data[at + c] = (data[at + c] as number) + shift;
  }
}

export async function gifOf(canvas: HTMLCanvasElement, seconds: number): Promise<Blob> {
  const all = await pictures(canvas, seconds);
  // One palette for all pictures, so that still parts do not shimmer.
  const some = [0.1, 0.5, 0.9].map((share) => all[Math.floor(share * all.length)]?.data ?? new Uint8ClampedArray());
  const palette = quantize(new Uint8ClampedArray(await new Blob(some).arrayBuffer()), 256);
  const encoder = GIFEncoder();
  for (const [k, picture] of all.entries()) {
    // Yields to the page between pictures.
    await new Promise((resolve) => setTimeout(resolve));
    dither(picture);
    const { data, width, height } = picture;
    encoder.writeFrame(applyPalette(data, palette), width, height, { delay: STEP_MS, ...(k === 0 ? { palette } : {}) });
  }
  encoder.finish();
  return new Blob([encoder.bytes().slice()], { type: 'image/gif' });
}
