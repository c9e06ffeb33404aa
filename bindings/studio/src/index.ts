// Learning in the background: films, cameras and tables go in, models come out, and nothing leaves the machine.

export type * from './types.js';
export { StudioError } from './module.js';
export { Studio, type LiveCapture } from './studio.js';
