// The viewing test, fetched when somebody takes it.

export { filmPairs, rigPairs } from './pairs.js';
export { ANSWERS, Viewing } from './viewing.js';
