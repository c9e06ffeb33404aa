// Panel of long work: current stage with explanation, progress, and a way to cancel.

import type { Seen, Watch } from '@wisp/studio';
import { definitions, element } from '../../panel/element.js';
import { stageInWords, type Thing } from '../words.js';
import { button } from './verdict.js';

export class Working {
  readonly panel: HTMLElement;
  private readonly stage = element('p', { class: 'stage-words' });
  private readonly bar = element('progress', { max: 1, 'aria-label': 'Progress' });
  private readonly facts = element('dl', { class: 'found' });
  readonly control = new AbortController();
  private shown = '';

  /** `announce`: reads a message to screen readers */
  constructor(title: string, words: string, private readonly announce: (words: string) => void, private readonly thing: Thing | 'either' = 'flame') {
    this.panel = element(
      'div',
      { class: 'panel working' },
      element('h2', { tabindex: '-1' }, title),
      element('p', {}, words),
      this.bar,
      this.stage,
      this.facts,
      element('div', { class: 'actions' }, button('Cancel', 'cancel', () => this.abort())),
    );
  }

  /** Observer of the work that this panel shows. */
  watch(seen?: (seen: Seen) => void): Watch {
    return { signal: this.control.signal, progress: (stage, share) => this.progress(stage, share), ...(seen === undefined ? {} : { seen }) };
  }

  abort(): void { this.control.abort(); }

  /** Shows names and values of what is found so far. */
  found(facts: readonly (readonly [string, string])[]): void {
    const text = facts.map(([name, value]) => `${name}: ${value}`).join();
    if (text === this.shown) return;
    this.shown = text;
    this.facts.replaceChildren(...definitions(facts));
  }

  private progress(stage: string, share: number): void {
    if (share < 0) this.bar.removeAttribute('value');
    else this.bar.value = share;
    const words = stageInWords(stage, this.thing);
    if (this.stage.textContent === words) return;
    this.stage.textContent = words;
    this.announce(words);
  }
}
