// A leaf as triangles: the blade, pointed and a little curled, and its stalk. y along the midrib towards the tip, x
// across, z out of the upper side; lengths are shares of half the leaf's width (x) and length (y).

/** Numbers a vertex: x, y, z, then across (−1 … 1) and along (0 stalk end … 1 tip). */
export const MESH_NUMBERS = 5;

export interface LeafMesh {
  vertices: Float32Array;
  indices: Uint16Array;
}

/** Half the blade's width at the share t from base to tip. */
function blade(t: number): number {
  return Math.pow(Math.sin(Math.PI * Math.pow(t, 0.7)), 1.05) * (1.02 - 0.2 * t);
}

/** A mesh with so many rows along and columns across. */
export function leafMesh(rows: number, columns: number): LeafMesh {
  const vertices: number[] = [];
  const indices: number[] = [];
  for (let row = 0; row <= rows; ++row) {
    const t = row / rows;
    for (let column = 0; column <= columns; ++column) {
      const u = (2 * column) / columns - 1;
      const half = blade(t);
      const notch = 0.05 * Math.cos(t * 34) * Math.abs(u) ** 6;
      const x = u * half * (1 + notch);
      const fold = 0.15 * Math.abs(u) * half;
      const bend = 0.55 * (t - 0.45) ** 2;
      vertices.push(x, 2 * t - 1, fold - bend + 0.05 * Math.sin(5 * t + 2 * u), u, t);
    }
  }
  const across = columns + 1;
  for (let row = 0; row < rows; ++row) {
    for (let column = 0; column < columns; ++column) {
      const k = row * across + column;
      indices.push(k, k + 1, k + across, k + 1, k + across + 1, k + across);
    }
  }
  const stalk = vertices.length / MESH_NUMBERS;
  vertices.push(-0.045, -0.96, -0.06, 0, 0, 0.045, -0.96, -0.06, 0, 0, 0.05, -1.5, -0.2, 0, 0);
  indices.push(stalk, stalk + 2, stalk + 1);
  return { vertices: new Float32Array(vertices), indices: new Uint16Array(indices) };
}
