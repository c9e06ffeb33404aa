// Decoded frames as pictures that use the frames' own planes.

import type { RawPicture } from './engine.js';

/** Maximum number of pixels; larger pictures are reduced. It suffices, as edges are located to a tenth of a pixel. */
const MAX_PIXELS = 3840 * 2160;

const SHIFTS: Record<string, [number, number]> = { I420: [1, 1], I422: [1, 0], I444: [0, 0], NV12: [1, 1] };

let canvas: OffscreenCanvas | null = null;
/** Reused buffer for a frame's planes, which avoids a megabyte of garbage per frame. */
let room = new Uint8Array(0);

/**
 * Whether colours are of BT.709 instead of BT.601. A film whose file states neither is BT.601, as in the program
 * (src/capture/media/frame_picture.cpp), whatever the browser guesses. `stated`: from the file; undefined for a
 * camera, whose frames state it.
 */
export const isBt709 = (stated: VideoColorSpaceInit | undefined, frame: VideoColorSpaceInit): boolean => (stated ?? frame).matrix === 'bt709';

/** Returns a frame's pixels, valid until the next call. `turn`: clockwise rotation in degrees for display. */
export async function rawOfFrame(frame: VideoFrame, turn = 0, stated?: VideoColorSpaceInit): Promise<RawPicture> {
  const { width, height } = frame.visibleRect ?? { width: frame.codedWidth, height: frame.codedHeight };
  const shifts = SHIFTS[frame.format ?? ''];
  if (shifts === undefined || width * height > MAX_PIXELS) return redrawn(frame, width, height, turn);
  const size = frame.allocationSize();
  if (room.length !== size) room = new Uint8Array(size);
  const data = room;
  const layout = await frame.copyTo(data);
  const planes = layout.map(({ offset, stride }) => ({ offset, stride, step: 1 }));
  if (frame.format === 'NV12') {
    const { offset, stride } = planes[1]!;
    planes[1] = { offset, stride, step: 2 };
    planes[2] = { offset: offset + 1, stride, step: 2 };
  }
  const { fullRange } = frame.colorSpace;
  const picture: RawPicture = { layout: 'yuv', width, height, data, planes, shiftX: shifts[0], shiftY: shifts[1], fullRange: fullRange ?? false, bt709: isBt709(stated, frame.colorSpace.toJSON()) };
  return turn === 0 ? picture : turned(picture, turn / 90);
}

/** The picture rotated clockwise by quarter turns, plane by plane. */
function turned(picture: RawPicture, quarters: number): RawPicture {
  const sideways = quarters % 2 !== 0;
  const { width, height, data, shiftX = 0, shiftY = 0 } = picture;
  const sizes = [[width, height], [-(-width >> shiftX), -(-height >> shiftY)]] as const;
  const out = new Uint8Array(sizes[0][0] * sizes[0][1] + 2 * sizes[1][0] * sizes[1][1]);
  let next = 0;
  const planes = picture.planes.map(({ offset, stride, step }, k) => {
    const [wide, tall] = sizes[k === 0 ? 0 : 1];
    const plane = { offset: next, stride: sideways ? tall : wide, step: 1 };
    // In the source plane: address of the first pixel, and steps to the next pixel and to the next row.
    const [outWidth, outHeight] = sideways ? [tall, wide] : [wide, tall];
    const [first, along, down] =
      quarters === 1 ? [offset + (tall - 1) * stride, -stride, step]
      : quarters === 2 ? [offset + (tall - 1) * stride + (wide - 1) * step, -step, -stride]
      : [offset + (wide - 1) * step, stride, -step];
    for (let y = 0; y < outHeight; ++y) for (let x = 0, at = first + y * down; x < outWidth; ++x, at += along) out[next++] = data[at]!;
    return plane;
  });
  return { ...picture, width: sideways ? height : width, height: sideways ? width : height, data: out, planes, shiftX: sideways ? shiftY : shiftX, shiftY: sideways ? shiftX : shiftY };
}

/** A picture drawn to a canvas, reduced where it is large, as packed colours. */
function redrawn(shown: VideoFrame | ImageBitmap, width: number, height: number, turn: number): RawPicture {
  const share = Math.min(1, Math.sqrt(MAX_PIXELS / (width * height)));
  const [wide, tall] = [Math.round(width * share), Math.round(height * share)];
  const [across, down] = turn % 180 === 0 ? [wide, tall] : [tall, wide];
  if (canvas === null || canvas.width !== across || canvas.height !== down) canvas = new OffscreenCanvas(across, down);
  const on = canvas.getContext('2d', { willReadFrequently: true })!;
  on.setTransform(1, 0, 0, 1, across / 2, down / 2);
  on.rotate((turn * Math.PI) / 180);
  on.globalCompositeOperation = 'copy'; // nothing of the picture before shows through
  on.drawImage(shown, -wide / 2, -tall / 2, wide, tall);
  const data = new Uint8Array(on.getImageData(0, 0, across, down).data.buffer);
  return { layout: 'rgb', width: across, height: down, data, planes: [0, 1, 2].map((offset) => ({ offset, stride: 4 * across, step: 4 })) };
}

/** Returns a still picture's pixels. */
export const rawOfBitmap = (bitmap: ImageBitmap): RawPicture => redrawn(bitmap, bitmap.width, bitmap.height, 0);
