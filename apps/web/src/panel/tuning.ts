// The guided calibration: breathe gently, blow hard. Afterwards a soft breath bends the flame and a hard one
// extinguishes it, whatever the microphone's sensitivity.

import type { Asked, Ear } from '../wind/ear.js';
import { after } from '../saving.js';
import { button, element } from './element.js';

const STEPS: readonly { asked: Asked; title: string; words: string; seconds: number }[] = [
  { asked: 'breathe gently', title: 'Breathe gently', words: 'As on a cold window: the flame is to lean and burn on.', seconds: 3 },
  { asked: 'blow hard', title: 'Blow hard', words: 'As on a birthday cake.', seconds: 2.5 },
];

/** Seconds to read the instruction and to inhale. */
const GET_READY = 1.5;
/** Seconds for which the last text stays. */
const STAYS = 6;

export class Tuning {
  private readonly title = element('h2', { id: 'tuning-title' });
  private readonly words = element('p', { 'aria-live': 'polite' });
  private readonly passed = element('progress', { max: 1, value: 0, 'aria-label': 'Time to listen' });
  private readonly steps = element('ol', { 'aria-hidden': 'true' }, ...STEPS.map(({ title }) => element('li', {}, title)));
  private readonly actions = element('div', { class: 'actions' });
  private readonly choice = element('select', { id: 'tuning-microphone', change: () => void this.ear.choose(this.choice.value).then(() => this.listChoices()) });
  private readonly choices = element('label', { class: 'microphones', for: 'tuning-microphone', hidden: true }, 'Microphone ', this.choice);
  /** number of the latest opening or step; earlier ones that still wait are abandoned */
  private turn = 0;
  private since = 0;
  private lasts = 0;

  constructor(private readonly ear: Ear, private readonly place: HTMLElement, private readonly returnTo: HTMLElement) {
    place.append(this.title, this.steps, this.words, this.choices, this.passed, this.actions);
  }

  get isOpen(): boolean {
    return !this.place.hidden;
  }

  /** Shows the steps, and a button that begins. */
  open(): void {
    if (this.isOpen) return;
    this.turn += 1;
    this.place.hidden = false;
    document.body.classList.add('tuning-on');
    this.show(null, 'Tune it to your breath', 'Two short sounds, so that a soft breath leans the flame and a hard one puts it out.');
    void this.listChoices();
    this.offer(['Begin', () => void this.begin()], ['Not now', () => this.close()]);
  }

  close(): void {
    if (!this.isOpen) return;
    this.turn += 1;
    this.place.hidden = true;
    document.body.classList.remove('tuning-on');
    this.ear.tune(false);
    this.returnTo.focus();
  }

  /** Lists the microphones where there are several. */
  private async listChoices(): Promise<void> {
    const found = await this.ear.choices();
    this.choice.replaceChildren(...found.map(({ id, name, open }) => element('option', { value: id, selected: open }, name)));
    this.choices.hidden = found.length < 2;
  }

  /** Updates the progress bar; closes the panel if the microphone went off while listening. */
  frame(): void {
    if (!this.isOpen) return;
    if (this.ear.state === 'off' && this.lasts > 0) return this.close();
    this.passed.value = this.lasts === 0 ? 0 : Math.min(1, (performance.now() - this.since) / 1000 / this.lasts);
  }

  private async begin(): Promise<void> {
    const turn = this.turn;
    this.offer(['Cancel', () => this.close()]);
    if (this.ear.state === 'off') await this.ear.open();
    if (turn !== this.turn) return;
    // open() has already reported why the microphone is off.
    if (this.ear.state === 'off') return this.close();
    this.ear.tune(true);
    await this.ask(0);
  }

  private async ask(index: number): Promise<void> {
    const step = STEPS[index];
    if (step === undefined) return this.end();
    const turn = ++this.turn;
    this.show(index, step.title, step.words);
    this.offer(['Cancel', () => this.close()]);
    await after(GET_READY);
    if (turn !== this.turn) return;
    this.since = performance.now();
    this.lasts = step.seconds;
    this.place.classList.add('listening');
    const heard = await this.ear.listenFor(step.asked, step.seconds);
    if (turn !== this.turn) return;
    if (heard) return this.ask(index + 1);
    this.show(index, step.title, 'I did not hear it. A little closer, or a little longer?');
    this.offer(['Try again', () => void this.ask(index)], ['Leave it', () => this.close()]);
  }

  private async end(): Promise<void> {
    const turn = ++this.turn;
    this.ear.tune(false);
    this.show(STEPS.length, 'Tuned', 'Breathe gently, and it leans. Blow hard, and it is out.');
    this.offer(['Done', () => this.close()]);
    await after(STAYS);
    if (turn === this.turn) this.close();
  }

  /** `index` of the current step; null: before the first. */
  private show(index: number | null, title: string, words: string): void {
    this.lasts = 0;
    if (index !== null) this.choices.hidden = true;
    this.place.classList.remove('listening');
    this.place.classList.toggle('measuring', index !== null && index < STEPS.length);
    this.title.textContent = title;
    this.words.textContent = words;
    [...this.steps.children].forEach((item, k) => {
      item.classList.toggle('past', index !== null && k < index);
      item.classList.toggle('now', k === index);
    });
  }

  private offer(...actions: [string, () => void][]): void {
    this.actions.replaceChildren(...actions.map(([words, act]) => button(words, act)));
    (this.actions.firstElementChild as HTMLElement).focus();
  }
}
