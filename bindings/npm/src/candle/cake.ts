// What only a cake needs of the room's shaders; fetched when there is one.

export { default as cake } from './shaders/cake.glsl.js';
