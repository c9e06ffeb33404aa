// Previews of frames whose planes have known colours.

import assert from 'node:assert/strict';
import { test } from 'node:test';

import { smallPicture } from '../dist/small.js';

/** A picture of 4:2:0 whose left half has one colour and whose right half another: luma, blue and red difference. */
function halves(width, height, left, right, how) {
  const [wide, tall] = [(width + 1) >> 1, (height + 1) >> 1];
  const data = new Uint8Array(width * height + 2 * wide * tall);
  for (let k = 0; k < width * height; ++k) data[k] = (k % width < width / 2 ? left : right)[0];
  for (let k = 0; k < wide * tall; ++k) {
    const colour = k % wide < wide / 2 ? left : right;
    data[width * height + k] = colour[1];
    data[width * height + wide * tall + k] = colour[2];
  }
  const planes = [{ offset: 0, stride: width, step: 1 }, { offset: width * height, stride: wide, step: 1 }, { offset: width * height + wide * tall, stride: wide, step: 1 }];
  return { layout: 'yuv', width, height, data, planes, shiftX: 1, shiftY: 1, ...how };
}

const pixel = ({ data, width }, x, y) => [...data.subarray(4 * (y * width + x), 4 * (y * width + x) + 4)];
const near = (found, wanted) => found.forEach((value, k) => assert.ok(Math.abs(value - wanted[k]) <= 2, `${found} for ${wanted}`));

test('white and the primary red of each standard come out as they are', () => {
  // Codes of red from the tables of the standards: BT.709, BT.601, and BT.601 in full range.
  for (const [red, light, how] of [[[63, 102, 240], 235, { bt709: true }], [[81, 90, 240], 235, {}], [[76, 85, 255], 255, { fullRange: true }]]) {
    const small = smallPicture(halves(1280, 720, red, [light, 128, 128], { bt709: false, ...how }), 640);
    assert.deepEqual([small.width, small.height], [640, 360]);
    near(pixel(small, 5, 200), [255, 0, 0, 255]);
    near(pixel(small, 630, 10), [255, 255, 255, 255]);
  }
});

test('a pixel is the mean of those that it stands for, whatever the sizes', () => {
  const width = 7;
  const data = Uint8Array.from({ length: 49 }, (_, k) => k);
  const small = smallPicture({ layout: 'grey', width, height: 7, data, planes: [{ offset: 0, stride: width, step: 1 }] }, 3);
  assert.deepEqual([small.width, small.height], [3, 3]);
  // A pixel is the mean of columns 0-1, 2-3 or 4-6, and of the same rows.
  near(pixel(small, 0, 0), [4, 4, 4, 255]);
  near(pixel(small, 2, 2), [40, 40, 40, 255]);
});

test('what is small stays as large as it is, packed colours too, and odd sizes of subsampled ones', () => {
  const data = Uint8Array.from({ length: 4 * 5 * 3 }, (_, k) => k * 4);
  const planes = [0, 1, 2].map((offset) => ({ offset, stride: 20, step: 4 }));
  const small = smallPicture({ layout: 'rgb', width: 5, height: 3, data, planes }, 640);
  assert.deepEqual([small.width, small.height], [5, 3]);
  near(pixel(small, 4, 2), [56 * 4, 57 * 4, 58 * 4, 255]);
  near(pixel(smallPicture(halves(5, 3, [235, 128, 128], [16, 128, 128]), 640), 4, 2), [0, 0, 0, 255]);
});
