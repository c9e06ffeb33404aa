// A candle in the round: blown at from the eye, the flame leans away, from all sides alike; candles shelter each other.

import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { test } from 'node:test';

import { CandleScene } from '../dist/candle/scene.js';
import { shelter } from '../dist/air/delay.js';
import { load } from '../dist/index.js';

const wisp = await load();
const flame = readFileSync(new URL('../dist/models/flame.wisp', import.meta.url));
const pointer = { x: 0, y: 0, fromX: 0, fromY: 0, speedX: 0, speedY: 0, present: false };

/** Plays a scene seen from an azimuth while `air` blows. Returns the tip's mean lean to the right and away. */
function leaning(azimuth, air, { count = 1, seconds = 3, noise = 0 } = {}) {
  const scene = new CandleScene(wisp.model(flame), { seed: 5, noise, count });
  scene.frame(800, 600, 0, false);
  scene.goRound(azimuth);
  const tips = [];
  for (let k = 0; k < 60 * seconds; ++k) {
    scene.update({ seconds: 1 / 60, breath: air.right + air.away, air, pointer });
    const [{ shape, tipAway }] = scene.candles;
    if (k > 60) tips.push([shape.tipX, tipAway]);
  }
  const mean = (which) => tips.reduce((sum, tip) => sum + tip[which], 0) / tips.length;
  return { right: mean(0), away: mean(1), tips, scene };
}

test('a breath from the eye leans it away and not aside; a wind across leans it aside and not away', () => {
  const [blown, crossed] = [leaning(0.7, { right: 0, away: 0.5 }), leaning(0.7, { right: 0.5, away: 0 })];
  assert.ok(blown.away > 0.1 && Math.abs(blown.right) < 0.05, `away ${blown.away}, right ${blown.right}`);
  assert.ok(crossed.right > 0.1 && Math.abs(crossed.away) < 0.05, `right ${crossed.right}, away ${crossed.away}`);
});

test('one flame in one wind is the same from every side', () => {
  // Converts from the room's axes to the eye's, or with a negative azimuth from the eye's axes to the room's.
  const seen = (azimuth, x, z) => [Math.cos(azimuth) * x - Math.sin(azimuth) * z, Math.sin(azimuth) * x + Math.cos(azimuth) * z];
  const tips = [0, 2.1].map((azimuth) => {
    const [right, near] = seen(azimuth, 0.4, -0.2);
    return leaning(azimuth, { right, away: -near }).tips.map(([across, away]) => seen(-azimuth, across, -away));
  });
  tips[0].forEach(([x, z], k) => {
    const [otherX, otherZ] = tips[1][k];
    assert.ok(Math.hypot(x - otherX, z - otherZ) < 0.02, `frame ${k}: ${x}, ${z} and ${otherX}, ${otherZ}`);
  });
  assert.ok(tips[0].every(([x]) => x > 0.1));
});

test('a hard breath from the eye puts it out, and an old model without other sides says so', () => {
  assert.equal(leaning(1.3, { right: 0, away: 3 }).scene.burning().lit, 0);
  const plane = new CandleScene(wisp.model(readFileSync(new URL('../../../apps/web/public/models/flame-2.wisp', import.meta.url))), { seed: 5, noise: 0, count: 1 });
  assert.equal(plane.goRound(1), false);
});

test('candles of a cake turn with the eye, the farthest first, and feel a breath from it later the farther they are', () => {
  const { scene } = leaning(0.9, { right: 0, away: 0 }, { count: 7, seconds: 1 });
  const depths = scene.candles.map(({ stand }) => stand.z);
  assert.deepEqual(depths, [...depths].sort((a, b) => a - b));
  for (const { stand, seat } of scene.candles) assert.ok(Math.abs(Math.hypot(stand.x, stand.z) - Math.hypot(...seat)) < 1e-9);
  const felt = new Map();
  for (let k = 0; k < 60; ++k) {
    scene.update({ seconds: 1 / 60, breath: 0.3, air: { right: 0, away: 0.3 }, pointer });
    for (const candle of scene.candles) if (candle.wind > 0.05 && !felt.has(candle)) felt.set(candle, k);
  }
  const [far, near] = [felt.get(scene.candles[0]), felt.get(scene.candles.at(-1))];
  assert.ok(near < far - 8, `near after ${near} frames, far after ${far}`);
});

test('a candle shelters what is right behind it, and nothing else', () => {
  const [front, behind, beside] = [{ x: 0, z: 0.5 }, { x: 0, z: 0 }, { x: 0.8, z: 0 }];
  const left = (at) => shelter(at, [front, behind, beside], 0, -1);
  assert.equal(left(front), 1);
  assert.ok(left(behind) < 0.8, String(left(behind)));
  assert.ok(left(beside) > 0.99);
  const crowd = Array.from({ length: 30 }, (_, k) => ({ x: 0, z: 0.1 * (k + 1) }));
  assert.equal(shelter({ x: 0, z: 0 }, crowd, 0, -1), 0.5);
});

test('a direction that is no unit vector is refused with its numbers', () => {
  assert.throws(() => wisp.model(flame).bank().look(2, 0), /given \(2/);
});
