// Small preview of a frame, averaged from the frame's own planes. Drawing the frame to a canvas instead is slow where
// the processor emulates a graphics card: on two cores, beside the worker, the page then draws five pictures a second.

import type { RawPicture } from './engine.js';

/** A picture in the format of ImageData. */
export interface SmallPicture {
  width: number;
  height: number;
  /** red, green, blue, opacity of each pixel */
  data: Uint8ClampedArray<ArrayBuffer>;
}

/** Reused buffers for previews and their planes, which avoid ten megabytes of garbage per second. */
const rooms: Uint8ClampedArray<ArrayBuffer>[] = [];

/** Returns the k-th buffer, renewed if its size is not `bytes`. */
function roomFor(k: number, bytes: number): Uint8ClampedArray<ArrayBuffer> {
  const room = rooms[k];
  return room?.length === bytes ? room : (rooms[k] = new Uint8ClampedArray(bytes));
}

/** Preview with at most `most` pixels per side, each the mean of the pixels it covers; valid until the next call. */
export function smallPicture(picture: RawPicture, most: number): SmallPicture {
  const share = Math.min(1, most / Math.max(picture.width, picture.height));
  const [width, height] = [Math.max(1, Math.round(picture.width * share)), Math.max(1, Math.round(picture.height * share))];
  const data = roomFor(3, 4 * width * height).fill(255);
  const small = picture.planes.map((_, k) =>
    smallPlane(picture, k, k === 0 || picture.layout === 'rgb' ? [0, 0] : [picture.shiftX ?? 0, picture.shiftY ?? 0], width, height),
  );
  const [first, second = first, third = first] = small as [Uint8ClampedArray, Uint8ClampedArray?, Uint8ClampedArray?];
  if (picture.layout === 'yuv') fromLuma(picture, first, second, third, data);
  else {
    for (let k = 0; k < first.length; ++k) {
      data[4 * k] = first[k]!;
      data[4 * k + 1] = second[k]!;
      data[4 * k + 2] = third[k]!;
    }
  }
  return { width, height, data };
}

/** Boundaries of `to` equal parts of `from` pixels. */
const edges = (from: number, to: number): Int32Array => Int32Array.from({ length: to + 1 }, (_, k) => Math.floor((k * from) / to));

/** One plane of the preview, from a plane 2^shift times smaller than the picture. */
function smallPlane({ data, planes, width: from, height: high }: RawPicture, k: number, shift: readonly [number, number], width: number, height: number): Uint8ClampedArray {
  const { offset, stride, step } = planes[k]!;
  const out = roomFor(k, width * height);
  const columns = edges(-(-from >> shift[0]), width);
  const rows = edges(-(-high >> shift[1]), height);
  for (let j = 0, at = 0; j < height; ++j) {
    const y0 = rows[j]!;
    const y1 = Math.max(y0 + 1, rows[j + 1]!);
    for (let i = 0; i < width; ++i, ++at) {
      const x0 = columns[i]!;
      const x1 = Math.max(x0 + 1, columns[i + 1]!);
      let sum = 0;
      for (let y = y0; y < y1; ++y) for (let x = x0, place = offset + y * stride + x0 * step; x < x1; ++x, place += step) sum += data[place]!;
      out[at] = sum / ((x1 - x0) * (y1 - y0));
    }
  }
  return out;
}

/** Converts luma and colour differences to red, green and blue: BT.709 or BT.601. */
function fromLuma({ fullRange = false, bt709 = false }: RawPicture, luma: Uint8ClampedArray, blue: Uint8ClampedArray, red: Uint8ClampedArray, data: Uint8ClampedArray): void {
  const [black, light, colour] = fullRange ? [0, 1, 1] : [16, 255 / 219, 255 / 224];
  const [ofRed, ofBlue] = bt709 ? [0.2126, 0.0722] : [0.299, 0.114];
  const [toRed, toBlue] = [2 * (1 - ofRed) * colour, 2 * (1 - ofBlue) * colour];
  const ofGreen = 1 - ofRed - ofBlue;
  for (let k = 0; k < luma.length; ++k) {
    const y = light * (luma[k]! - black);
    const v = toRed * (red[k]! - 128);
    const u = toBlue * (blue[k]! - 128);
    data[4 * k] = y + v;
    data[4 * k + 1] = y - (ofRed * v + ofBlue * u) / ofGreen;
    data[4 * k + 2] = y + u;
  }
}
