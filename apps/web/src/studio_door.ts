// Entry to the studio: tab, key and link. The studio itself is loaded at first entry.

import type { App } from './app.js';
import type { Dropped } from './drops.js';
import { fetchPart, once } from './part.js';
import { byId, element } from './panel/element.js';
import { after, saveGif, saveLoop } from './saving.js';
import type { Moving } from './studio/panels/taking.js';
import type { Room } from './studio/room.js';

/** Seconds until a newly shown flame has full brightness. */
const LIT = 0.9;

export class StudioDoor {
  private readonly tab = element('button', { type: 'button', 'data-scene': 'yours', 'aria-current': 'false' }, 'Yours');
  private readonly room = once(() => fetchPart(() => import('./studio/room.js')).then(({ Room }) => new Room(this)));
  /** whether the studio is open */
  inside = false;
  /** whether a film of the scene is being made */
  private films = false;

  constructor(readonly app: App) {
    const tabs = byId('scenes', HTMLElement);
    tabs.append(this.tab);
    tabs.addEventListener('click', ({ target }) => {
      if (target === this.tab) this.open();
      else if (target instanceof HTMLButtonElement) this.leave();
    });
    app.keys['3'] = () => this.open();
    for (const scene of ['1', '2']) {
      const stay = app.keys[scene];
      app.keys[scene] = () => { this.leave(); stay?.(); };
    }
    if (new URLSearchParams(location.hash.slice(1)).has('yours')) this.open();
  }

  /** Enters the studio, optionally with files to learn from. */
  open(dropped?: Dropped): void {
    this.room().then(
      (room) => { if (!this.inside) this.enter(room); if (dropped !== undefined) room.take(dropped); },
      () => this.app.notices.say('The studio could not be fetched. Is there a network? Press Yours to try again.'),
    );
  }

  private enter(room: Room): void {
    this.inside = true;
    const { app } = this;
    app.showDrawer(false);
    app.parts?.tuning.close();
    if (app.parts !== null && app.parts.ear.state !== 'off') app.parts.ear.close();
    app.stage.loop.stop();
    document.body.classList.add('studying');
    this.markTab();
    room.show(true);
  }

  private markTab(): void {
    for (const tab of this.tab.parentElement?.children ?? []) tab.setAttribute('aria-current', String(tab === this.tab));
  }

  /** Leaves the studio; its session is kept. */
  leave(): void {
    if (!this.inside) return;
    this.inside = false;
    void this.room().then((room) => room.show(false));
    document.body.classList.remove('studying');
    this.tab.setAttribute('aria-current', 'false');
    // Selects the scene's own tab again.
    this.app.change({});
    this.app.stage.loop.start();
  }

  /** Plays a learned flame or fall in the page's own scene, and opens the microphone. */
  async blow(file: string, model: Uint8Array): Promise<void> {
    const { app } = this;
    await app.player.playFile(file, model);
    this.leave();
    if (app.player.playing?.tab !== 'candle') return;
    if (app.player.playing.model.inputs.length === 0) {
      await app.player.borrowWind();
      app.notices.say('It was filmed without wind: how it leans and goes out is borrowed from the flame that comes with this page.');
    }
    if (app.parts?.ear.state === 'off') app.toggleMicrophone();
  }

  /** Saves a film or GIF of a flame in the page's own scene. Returns a message about the result. */
  async film(file: string, model: Uint8Array, kind: Moving): Promise<string> {
    if (this.films) return 'One moment: another is being made';
    this.films = true;
    const { app } = this;
    try {
      await app.player.playFile(file, model);
      if (app.player.playing?.model.inputs.length === 0) await app.player.borrowWind();
      this.markTab();
      app.stage.loop.start();
      await after(LIT);
      return await (kind === 'gif' ? saveGif : saveLoop)(app);
    } finally {
      this.films = false;
      if (this.inside) app.stage.loop.stop();
    }
  }
}
