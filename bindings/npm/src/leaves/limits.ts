/** Maximum number of leaves. */
export const MAX_LEAVES = 10_000;
