// Messages that appear, are read out by screen readers, and disappear.

import { button, element } from './element.js';

const STAYS = 9000;
const MOST = 3;

export class Notices {
  constructor(private readonly place: HTMLElement) {}

  /** Shows a sentence or two for a while; a repeated message only stays longer. `offer`: an action, by a button. */
  say(text: string, offer?: { words: string; accept(): void }): void {
    for (const shown of this.place.querySelectorAll('.notice')) {
      if (shown.querySelector('p')?.textContent === text) shown.remove();
    }
    const close = element('button', { type: 'button', 'aria-label': 'Dismiss', click: () => void notice.remove() }, '×');
    const notice = element('div', { class: 'notice' }, element('p', {}, text), close);
    if (offer !== undefined) {
      const accept = (): void => {
        notice.remove();
        offer.accept();
      };
      close.before(button(offer.words, accept));
    }
    this.place.append(notice);
    while (this.place.children.length > MOST) this.place.firstElementChild?.remove();
    setTimeout(() => notice.remove(), offer === undefined ? STAYS : 2 * STAYS);
  }
}

/** One line near the lower edge that suggests an action until it was done. */
export class Hint {
  private timer = 0;

  constructor(private readonly place: HTMLElement) {}

  /** Shows a text for a number of seconds; 0: until the next text or hide(). */
  show(text: string, seconds = 0): void {
    clearTimeout(this.timer);
    if (this.place.textContent !== text) this.place.textContent = text;
    this.place.classList.add('shown');
    if (seconds > 0) this.timer = window.setTimeout(() => this.hide(), 1000 * seconds);
  }

  hide(): void {
    clearTimeout(this.timer);
    this.place.classList.remove('shown');
  }
}
