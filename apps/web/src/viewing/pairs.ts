// Pairs of a filmed and a played flame in the same wind, two seconds of outlines each: films of the rig, played by the
// shipped model; or parts of a visitor's film (made in the studio), played by the model learned from it.

import type { Library, Model } from '@wisp/player';
import { fetchShipped } from '../shipped.js';
import type { Outlines } from '../studio/outlines.js';
import { evenKnots, Spline } from '../studio/spline.js';

/** Consecutive outlines in flame heights above the base, x and y alternating. */
export interface Clip { rate: number; outlines: Float32Array[] }

export interface Pair { name: string; filmed: Clip; played: Clip }

/** A stretch of a recording: outlines, and wind that begins some time earlier. */
interface Stretch {
  name: string;
  filmed: Clip;
  wind: ArrayLike<number> | null;
  /** rate of the wind, and number of its rows before the first outline */
  rate: number;
  before: number;
}

const SECONDS = 2;
const SHOWN = 30;
const POINTS = 56;

/** Plays a model in the wind of a stretch, relighting it whenever it goes out. */
function played(model: Model, { wind, rate, before, filmed }: Stretch, seed: number): Clip {
  const bank = model.bank({ polylinePoints: POINTS, seed });
  const flame = bank.spawn();
  // The unit "0.95 m/s" of an input means that 1 in the model is 0.95 m/s in the recording.
  const one = parseFloat(model.inputs[0]?.unit ?? '') || 1;
  const outlines: Float32Array[] = [];
  for (let row = 0; outlines.length < filmed.outlines.length; ++row) {
    if (model.inputs.length > 0) bank.setInstanceInputs(flame, [(wind?.[row] ?? 0) / one]);
    if (model.facts.blowOut !== null && !bank.flameState(flame).lit) bank.relight(flame);
    bank.advance(1e9 / rate);
    // A film of a lower rate than the clip's shows a row more than once.
    while (outlines.length < filmed.outlines.length && row >= before + Math.floor((outlines.length * rate) / filmed.rate)) outlines.push(bank.polyline(flame).slice());
  }
  bank.free();
  return { rate: filmed.rate, outlines };
}

const pairOf = (model: Model, stretch: Stretch, seed: number): Pair => ({ name: stretch.name, filmed: stretch.filmed, played: played(model, stretch, seed) });

const shuffled = <T>(list: readonly T[]): T[] => list.map((one) => [Math.random(), one] as const).sort(([a], [b]) => a - b).map(([, one]) => one);

/** Pairs from the rig's films and a model that was not learned from them. */
export async function rigPairs(wisp: Library, bytes: Uint8Array, many: number): Promise<Pair[]> {
  const { rate, shown, before, clips } = JSON.parse(new TextDecoder().decode(await fetchShipped('filmed.json'))) as Record<'rate' | 'shown' | 'before', number> & { clips: { wind: number[]; outlines: number[][] }[] };
  const model = wisp.model(bytes);
  const points = (clips[0]?.outlines[0]?.length ?? 0) / 2;
  const spline = new Spline(points, evenKnots(points), POINTS);
  const made = shuffled([...clips.entries()]).slice(0, many).map(([k, { wind, outlines }], seed) => {
    const lines = outlines.map((control) => spline.draw(control.map((value) => value / 1000)));
    return pairOf(model, { name: `rig ${k + 1}`, filmed: { rate: shown, outlines: lines }, wind: wind.map((one) => one / 1000), rate, before: before * rate }, seed + 1);
  });
  model.free();
  return made;
}

/** Pairs of a visitor's film and the flame learned from it; a short film gives fewer than `many`. */
export function filmPairs(wisp: Library, bytes: Uint8Array, film: Outlines, many: number): Pair[] {
  const model = wisp.model(bytes);
  const rows = Math.round(SECONDS * film.rate);
  const seen = (row: number): Float32Array | undefined => film.line(row)?.map((value, k) => (k % 2 === 0 ? value - film.base.x : film.base.y - value) / film.height);
  const starts = Array.from({ length: Math.floor((2 * (film.rows - rows)) / rows) }, (_, k) => rows + Math.floor((k * rows) / 2)).filter((from) => from + rows <= film.rows);
  const made: Pair[] = [];
  for (const from of shuffled(starts)) {
    if (made.length === many) break;
    const outlines = Array.from({ length: SECONDS * SHOWN }, (_, k) => seen(from + Math.floor((k * film.rate) / SHOWN)));
    if (outlines.includes(undefined)) continue;
    const stretch = { name: `${(from / film.rate).toFixed(1)} s`, filmed: { rate: SHOWN, outlines: outlines as Float32Array[] }, wind: film.wind?.slice(from - rows, from + rows) ?? null, rate: film.rate, before: rows };
    made.push(pairOf(model, stretch, made.length + 1));
  }
  model.free();
  return made;
}
