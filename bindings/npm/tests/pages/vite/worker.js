import { load } from '@wisp/player';
import { work } from './life_worker.js';

work({ load });
