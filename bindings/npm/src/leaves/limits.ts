export const MAX_LEAVES = 10_000;
