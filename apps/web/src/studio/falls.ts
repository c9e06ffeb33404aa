// Falls as lines over the film that they were found in.

import type { Captured } from '@wisp/studio';

/** The way of every fall, pixels of the film, x and y by turns. `metres`: of wall that the picture shows, top to bottom. */
export function linesOfFalls({ series, episodes, rows }: Captured, metres: number, { width, height }: { width: number; height: number }): Float32Array[] {
  const [x, z] = ['pos.x', 'pos.z'].map((name) => series.find((one) => one.name === name)?.samples);
  if (x === undefined || z === undefined) return [];
  const scale = height / metres;
  return episodes.map((begin, k) => {
    const end = episodes[k + 1] ?? rows;
    const line = new Float32Array(2 * (end - begin));
    for (let row = begin; row < end; ++row) {
      line[2 * (row - begin)] = width / 2 + scale * (x[row] as number);
      line[2 * (row - begin) + 1] = height - scale * (z[row] as number);
    }
    return line;
  });
}
