// Learning in the background: films, cameras and tables in, models out; no data leaves the machine.

export type * from './types.js';
export { StudioError } from './module.js';
export { Studio, type LiveCapture } from './studio.js';
