// Mesh of a leaf: a sheet folded along its midrib and curved, large enough for every species; the fragment shader cuts
// the outline out. y along the midrib to the tip, x across, z out of the upper side; x and y are in units of half the
// leaf's width and length.

/** Position of the stalk's end along the midrib. */
const STALK = -0.28;

/**
 * A mesh of `rows` along and `columns` across. Per vertex x, y, z, then the position across (−1 … 1) and along the
 * midrib (below 0: the stalk; 1: the tip).
 */
export function leafMesh(rows: number, columns: number): { vertices: Float32Array; indices: Uint16Array } {
  const vertices: number[] = [];
  const indices: number[] = [];
  for (let row = 0; row <= rows; ++row) {
    const t = STALK + ((1 - STALK) * row) / rows;
    for (let column = 0; column <= columns; ++column) {
      const u = (2 * column) / columns - 1;
      const fold = 0.15 * Math.abs(u);
      const bend = 0.55 * (t - 0.45) ** 2;
      vertices.push(u, 2 * t - 1, fold - bend + 0.05 * Math.sin(5 * t + 2 * u), u, t);
    }
  }
  const across = columns + 1;
  for (let row = 0; row < rows; ++row) {
    for (let column = 0; column < columns; ++column) {
      const k = row * across + column;
      indices.push(k, k + 1, k + across, k + 1, k + across + 1, k + across);
    }
  }
  return { vertices: new Float32Array(vertices), indices: new Uint16Array(indices) };
}
