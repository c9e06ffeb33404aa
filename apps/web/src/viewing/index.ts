// The viewing test, loaded at first use.

export { filmPairs, rigPairs } from './pairs.js';
export { ANSWERS, Viewing } from './viewing.js';
