// What only a cake needs of the room; fetched when there is one.

export { default as cake } from './shaders/cake.glsl.js';
export { Lettering } from './lettering.js';
