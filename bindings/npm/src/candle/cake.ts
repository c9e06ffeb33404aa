// Parts of the room needed by a cake only, fetched when there is one.

export { default as cake } from './shaders/cake.glsl.js';
export { Lettering } from './lettering.js';
