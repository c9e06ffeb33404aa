// What comes after the first flame: the drawer, the help, the microphone, files. One piece, fetched while the flame burns.

import './late.css';

export { readDropped, Refused, refusalOf } from './files.js';
export { MOST_PACKED_BYTES, packModel } from './model_link.js';
export { Drawer } from './panel/drawer.js';
export { fillHelp } from './panel/help.js';
export { Senses } from './senses/senses.js';
export { saveLoop, savePicture } from './saving.js';
export { Ear } from './wind/ear.js';
