import { load } from '@wisp/player';
import { openMicrophone } from '@wisp/player/microphone';
import { offer } from './exercise.js';

offer({ load, openMicrophone }, new Worker(new URL('./worker.js', import.meta.url), { type: 'module' }));
