/** Most leaves at once. */
export const MOST_LEAVES = 10_000;
