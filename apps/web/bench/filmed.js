// The filmed flames of the viewing test: two seconds each, of candle rig recordings that no shipped model has seen.
//
//     for k in 1 2 3; do
//       wisp simulate candle -o f$k.mp4 --seconds 40 --seed 61300$k && wisp capture flame f$k.mp4 -o f$k.csv; done
//     node apps/web/bench/filmed.js f1.csv f2.csv f3.csv        writes apps/web/public/models/filmed.json

import { readFileSync, writeFileSync } from 'node:fs';
import { fileURLToPath } from 'node:url';

const CLIPS = 24;
const SECONDS = 2;
/** Seconds of wind before each clip, in which the played flame settles. */
const BEFORE = 2;
/** Outlines kept per second; wind is kept at the recording's rate. */
const RATE = 30;
/** Clips with stronger wind (recording units) are skipped, since it may extinguish the flame. */
const MOST_WIND = 1.3;
const out = fileURLToPath(new URL('../public/models/filmed.json', import.meta.url));

const median = (values) => [...values].sort((a, b) => a - b)[values.length >> 1];

function recordingOf(path) {
  const lines = readFileSync(path, 'utf8').trim().split('\n');
  const rate = Number(lines.find((line) => line.startsWith('# rate_hz')).split(' ')[2]);
  const [head, ...rows] = lines.filter((line) => !line.startsWith('#'));
  const names = head.split(',').map((name) => name.replace(/^.:|\[.*$/g, ''));
  const cells = rows.map((row) => row.split(',').map(Number));
  const column = (name) => cells.map((row) => row[names.indexOf(name)]);
  const points = names.filter((name) => /^p\d+\.x$/.test(name)).length;
  const [xs, ys] = ['x', 'y'].map((axis) => Array.from({ length: points }, (_, k) => column(`p${k}.${axis}`)));
  const base = { x: median(column('base.x')), y: median(column('base.y')) };
  const height = median(cells.map((_, row) => base.y - Math.min(...ys.map((y) => y[row]))));
  return { rate, rows: rows.length, wind: column('wind'), xs, ys, base, height };
}

const recordings = process.argv.slice(2).map(recordingOf);
const { rate } = recordings[0];
const clips = [];
for (let k = 0; clips.length < CLIPS && k < 40 * CLIPS; ++k) {
  const { wind, rows, xs, ys, base, height } = recordings[k % recordings.length];
  const from = Math.round((BEFORE + (k / recordings.length) * (SECONDS + 0.5)) * rate);
  const to = from + SECONDS * rate;
  if (to > rows) break;
  const felt = wind.slice(from - BEFORE * rate, to);
  if (felt.some((one) => !(one < MOST_WIND))) continue;
  const outlines = [];
  for (let row = from; row < to; row += rate / RATE) outlines.push(xs.flatMap((x, p) => [(1000 * (x[row] - base.x)) / height, (1000 * (base.y - ys[p][row])) / height]).map(Math.round));
  clips.push({ wind: felt.map((one) => Math.round(1000 * one)), outlines });
}
if (clips.length < CLIPS) throw new Error(`only ${clips.length} clips: give more recordings`);
writeFileSync(out, `${JSON.stringify({ rate, shown: RATE, before: BEFORE, clips })}\n`);
console.log(`${clips.length} clips, ${JSON.stringify(clips).length} bytes`);
