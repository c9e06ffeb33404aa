// Controls over the stage: scene tabs, number of candles or leaves, microphone button, action button (light or kick).

import type { App } from '../app.js';
import { MAX_CANDLES, MAX_LEAVES, type SceneName, type Settings } from '../link.js';
import { byId } from './element.js';

/** State of the microphone. */
export type Hearing = 'off' | 'asking' | 'listening' | 'asleep';

export class Controls {
  /** buttons of the scenes; a new scene needs a button in index.html and a line in player.ts */
  private readonly tabs = [...byId('scenes', HTMLElement).querySelectorAll('button')];
  private readonly count = byId('count', HTMLInputElement);
  private readonly countName = byId('count-name', HTMLSpanElement);
  private readonly countShown = byId('count-shown', HTMLOutputElement);
  private readonly blow = byId('blow', HTMLButtonElement);
  private readonly blowWord = byId('blow-word', HTMLSpanElement);
  private readonly ring = document.getElementById('blow-ring');
  private readonly act = byId('act', HTMLButtonElement);
  private readonly tune = byId('tune', HTMLButtonElement);
  private tab: SceneName | null = 'candle';
  private word = '';
  private shownLevel = -1;

  constructor(private readonly app: App) {
    for (const button of this.tabs) button.addEventListener('click', () => app.change({ scene: button.dataset.scene as SceneName }));
    this.count.addEventListener('input', () => app.change(this.counted(this.count.valueAsNumber)));
    this.blow.addEventListener('click', () => app.toggleMicrophone());
    this.act.addEventListener('click', () => app.act());
  }

  /** Shows the selected tab, and the number of candles or leaves. */
  show(tab: SceneName | null, settings: Readonly<Settings>): void {
    this.tab = tab;
    for (const button of this.tabs) button.setAttribute('aria-current', String(button.dataset.scene === tab));
    const leaves = tab === 'leaves';
    (this.count.closest('label') as HTMLElement).hidden = tab === null;
    this.countName.textContent = leaves ? 'Leaves' : 'Candles';
    this.act.textContent = leaves ? 'Kick' : tab === null ? 'Start again' : 'Light';
    const many = leaves ? settings.leaves : settings.candles;
    this.countShown.value = !leaves && settings.age > 0 ? String(settings.age) : many.toLocaleString('en');
    if (document.activeElement !== this.count) {
      this.count.value = String(Math.log(many) / Math.log(leaves ? MAX_LEAVES : MAX_CANDLES));
    }
    this.count.setAttribute('aria-valuetext', this.countShown.value);
  }

  /** Changes the number by one step, as requested by a key. */
  step(way: 1 | -1, settings: Readonly<Settings>): void {
    if (this.tab === 'leaves') {
      const leaves = Math.round(way > 0 ? settings.leaves * 1.5 + 1 : settings.leaves / 1.5 - 1);
      this.app.change({ leaves: Math.max(1, Math.min(MAX_LEAVES, leaves)) });
    } else if (this.tab === 'candle') {
      this.app.change({ candles: Math.max(1, Math.min(MAX_CANDLES, settings.candles + way)), age: 0 });
    }
  }

  /** Enables the scene's own action while it has an effect. */
  setActive(able: boolean): void {
    if (this.act.disabled === able) this.act.disabled = !able;
  }

  /** Shows the microphone's state. `level`: strength of breath, 0 to 1. */
  hear(state: Hearing, level: number): void {
    const words = { off: 'Blow', asking: 'May I listen?', listening: 'Listening', asleep: 'Tap to wake' } as const;
    if (this.word !== state) {
      this.word = state;
      this.blowWord.textContent = words[state];
      this.blow.setAttribute('aria-pressed', String(state === 'listening'));
      this.blow.setAttribute('aria-label', state === 'off' ? 'Blow: microphone on' : `${words[state]}: microphone off`);
      this.blow.classList.toggle('live', state === 'listening');
      this.blow.classList.toggle('small-word', state !== 'off');
      this.tune.hidden = state !== 'listening';
    }
    const shown = Math.round(100 * Math.max(0, Math.min(1, level)));
    if (shown === this.shownLevel) return;
    this.shownLevel = shown;
    if (this.ring !== null) this.ring.style.strokeDasharray = `${shown} 100`;
  }

  private counted(share: number): Partial<Settings> {
    if (this.tab === 'leaves') return { leaves: Math.round(MAX_LEAVES ** share) };
    return { candles: Math.round(MAX_CANDLES ** share), age: 0 };
  }
}
