import { load } from './node_modules/@wisp/player/dist/index.js';
import { work } from './life_worker.js';

work({ load });
