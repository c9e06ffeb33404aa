// Card for composing a link: recipient, age, text for the smoke; and the ways to send it.

import type { App } from '../app.js';
import { LETTERS, MAX_CANDLES, shortened } from '../link.js';
import { saveGif, saveLoop, savePicture } from '../saving.js';
import type { Tune } from '../senses/tune.js';
import { button, closeButton, element } from './element.js';
import { telling } from './telling.js';

const FIELDS: readonly { name: keyof typeof LETTERS; words: string; hint: string }[] = [
  { name: 'name', words: 'For', hint: 'a name on the cake' },
  { name: 'from', words: 'From', hint: 'so that it can be sent back' },
  { name: 'wish', words: 'What the smoke says', hint: 'when the last flame is out' },
];

/** The scene of a changed cake. A candle that burns keeps its model. */
const inCandle = ({ player }: App): { scene?: 'candle' } => (player.playing?.tab === 'candle' ? {} : { scene: 'candle' });

export class Card {
  private readonly fields = new Map<keyof typeof LETTERS, HTMLInputElement>();
  private readonly age = element('input', { type: 'number', id: 'card-age', min: 1, max: 999, inputmode: 'numeric', placeholder: 'years', input: () => this.changeAge() });
  private readonly inFigures = element('input', { type: 'checkbox', id: 'card-figures', input: () => this.changeAge() });
  private readonly tune = element('input', { type: 'checkbox', id: 'card-tune', input: () => void this.app.change({ tune: Number(this.tune.checked) }) });
  private readonly send = telling('Copy the link', 'send', '', () => this.app.send());

  constructor(private readonly place: HTMLElement, private readonly app: App, tune: Tune) {
    this.send.classList.add('main');
    const hear = button('Hear it', () => (hear.textContent = tune.toggle() ? 'Silence' : 'Hear it'));
    place.append(
      element('header', {}, element('h2', {}, 'Send it'), closeButton(() => app.showCard(false))),
      ...FIELDS.map((field) => this.field(field)),
      element('div', { class: 'field' }, element('label', { for: 'card-age' }, 'Turns'), this.age, element('label', { class: 'check' }, this.inFigures, 'in figures')),
      element('div', { class: 'field' }, element('label', { class: 'check' }, this.tune, 'with a tune, for whoever asks for it'), hear),
      element('div', { class: 'actions' }, this.send),
      element('p', {}, 'All of it is in the link itself: nobody else reads it. Whoever opens it blows the candles out.'),
      element(
        'div',
        { class: 'actions' },
        telling('Save a film of it', 'loop', 'Filming…', () => saveLoop(app)),
        telling('As a GIF', 'gif', 'Filming…', () => saveGif(app)),
        telling('Save a picture', 'picture', 'One moment…', () => savePicture(app)),
      ),
    );
    place.addEventListener('keydown', (event) => {
      // Keys type text here and do not act on the page.
      if (event.key === 'Escape') app.showCard(false);
      event.stopPropagation();
    });
  }

  get open(): boolean {
    return !this.place.hidden;
  }

  show(open: boolean): void {
    this.place.hidden = !open;
    if (!open) return;
    const { settings } = this.app;
    for (const [name, field] of this.fields) field.value = settings[name];
    const many = settings.age > 0 ? settings.age : settings.candles;
    this.age.value = many > 1 || settings.age > 0 ? String(many) : '';
    this.inFigures.checked = settings.age > 0;
    this.tune.checked = settings.tune > 0;
    this.send.focus();
  }

  private field({ name, words, hint }: (typeof FIELDS)[number]): HTMLElement {
    const change = (): void => this.app.change({ ...inCandle(this.app), [name]: shortened(input.value, LETTERS[name]) });
    const input = element('input', { type: 'text', id: `card-${name}`, maxlength: LETTERS[name], placeholder: hint, autocomplete: 'off', 'data-card': name, input: change });
    this.fields.set(name, input);
    return element('div', { class: 'field' }, element('label', { for: `card-${name}` }, words), input);
  }

  /** Sets the number of candles to the age; above MAX_CANDLES digit candles show the age. */
  private changeAge(): void {
    const years = Math.min(999, Math.max(0, Math.floor(this.age.valueAsNumber || 0)));
    if (years > MAX_CANDLES) this.inFigures.checked = true;
    this.app.change({ ...inCandle(this.app), age: this.inFigures.checked ? years : 0, candles: Math.max(1, Math.min(MAX_CANDLES, years)) });
  }
}
