// Modules for after the first flame: drawer, help, microphone, files. One bundle, fetched while the flame burns.

import './late.css';
import type { App } from './app.js';
import type { Dropped } from './drops.js';
import { isLesson, readDropped, refusalOf } from './files.js';
import { Card } from './panel/card.js';
import { Drawer } from './panel/drawer.js';
import { byId } from './panel/element.js';
import { fillHelp } from './panel/help.js';
import { Senses } from './senses/senses.js';
import { Tune } from './senses/tune.js';
import { StudioDoor } from './studio_door.js';
import { Tuning } from './panel/tuning.js';
import { Ear } from './wind/ear.js';

export { MAX_PACKED_BYTES, packModel } from './model_link.js';

export type Parts = ReturnType<typeof furnish>;

export function furnish(app: App) {
  const ear = new Ear(app);
  const tuning = new Tuning(ear, byId('tuning', HTMLElement), byId('blow', HTMLButtonElement));
  byId('tune', HTMLButtonElement).addEventListener('click', () => tuning.open());
  // In the studio this key does nothing.
  app.keys.t = () => document.body.classList.contains('studying') || tuning.open();
  const { escape } = app.keys;
  app.keys.escape = () => (tuning.isOpen ? tuning.close() : escape?.());
  const drawer = new Drawer(byId('drawer', HTMLElement), app);
  const tune = new Tune();
  const card = new Card(byId('card', HTMLElement), app, tune);
  const play = byId('tune-play', HTMLButtonElement);
  play.addEventListener('click', () => play.setAttribute('aria-pressed', String(tune.toggle())));
  byId('back', HTMLButtonElement).addEventListener('click', () => void app.sendBack());
  fillHelp(app.help, app);
  drawer.fill();
  return { ear, drawer, senses: new Senses(), door: new StudioDoor(app), tuning, card, tune };
}

/** Reports an error as a sentence. */
export function sayWrong(app: App, error: unknown): void {
  const words = error instanceof Error ? error.message : String(error);
  app.notices.say(`${/[.!?]$/.test(words) ? words : `${words}.`} What plays goes on.`);
}

/** Plays a dropped or chosen model. Files to learn from open the studio, which takes all files while it is open. */
export function openDropped(app: App, { files, entries }: Dropped): void {
  const [file] = files;
  if (file === undefined) return;
  const door = app.parts?.door;
  if (isLesson(files, entries) || (door?.inside === true && !/\.wisp$/i.test(file.name))) return door?.open({ files, entries });
  readDropped(file)
    .then((bytes) => app.player.playFile(file.name, bytes))
    .then(() => {
      door?.leave();
      app.notices.say(`Playing ${file.name}.`);
    })
    .catch((error: unknown) => sayWrong(app, refusalOf(file.name, error)));
}
