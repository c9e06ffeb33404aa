import { load } from './node_modules/@wisp/player/dist/index.js';
import { openMicrophone } from './node_modules/@wisp/player/dist/microphone.js';
import { offer } from './exercise.js';

offer({ load, openMicrophone }, new Worker('worker.js', { type: 'module' }));
