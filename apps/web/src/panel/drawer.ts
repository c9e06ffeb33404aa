// The drawer about the model: live plots, controls, facts and file.

import type { App } from '../app.js';
import { fetchPart } from '../part.js';
import type { Playing } from '../player.js';
import type { FrameCost } from '@wisp/player/parts/stage/stage';
import type { Reading } from '@wisp/player/parts/stage/scene';
import { button, closeButton, element } from './element.js';
import { telling } from './telling.js';
import { factsOf } from './facts.js';
import { introductionTo } from './introduction.js';
import { Plot } from './plot.js';

/** Frames per update of the plots. */
const PLOT_EVERY = 2;

export class Drawer {
  /** plots of wind, response and cost */
  private plots: readonly Plot[] = [];
  private frames = 0;
  private sensesOn = false;
  private address: string | null = null;

  constructor(private readonly place: HTMLElement, private readonly app: App) {
    place.addEventListener('keydown', (event) => {
      if (event.key === 'Escape') app.showDrawer(false);
    });
  }

  /** Shows whether tilt and touch are on. */
  showSenses(on: boolean): void {
    this.sensesOn = on;
    this.place.querySelector('[data-knob=senses]')?.setAttribute('aria-pressed', String(on));
  }

  get open(): boolean {
    return !this.place.hidden;
  }

  /** Whether one of the drawer's controls has the focus. */
  get holdsFocus(): boolean {
    return this.place.contains(document.activeElement);
  }

  show(open: boolean): void {
    this.place.hidden = !open;
    if (open) this.place.querySelector<HTMLElement>('button')?.focus();
  }

  /** Shows the model that plays, and settings. */
  fill(): void {
    const shown = this.app.player.playing;
    if (shown === null) return;
    this.place.replaceChildren(
      element('header', {}, element('h2', {}, 'What was learned'), closeButton(() => this.app.showDrawer(false))),
      element('p', { class: 'introduction' }, introductionTo(shown.model, shown.shipped, shown.borrows)),
      this.livePlots(shown),
      this.knobs(),
      factsOf(shown.model, shown.bytes.length),
      this.files(shown),
    );
  }

  frame(reading: Reading, cost: Readonly<FrameCost>): void {
    const values = [reading.wind, reading.answer, cost.update + cost.draw];
    this.plots.forEach((plot, k) => plot.push(values[k] as number));
    this.frames += 1;
    if (this.open && this.frames % PLOT_EVERY === 0) for (const plot of this.plots) plot.draw();
  }

  private livePlots({ model, scene }: Playing): HTMLElement {
    this.plots = [
      new Plot('Wind in', ['#7fc4ff', '#1767a8'], [-0.2, 1]),
      new Plot(`Out: ${scene.answerName}`, ['#ffb35c', '#b25a00'], [-0.3, 0.3]),
      new Plot('Our time a frame', ['#9fd8a4', '#2c7a3a'], [0, 4], 60, ' ms'),
    ];
    const section = element('section', {}, element('h3', {}, 'Live'), ...this.plots.flatMap(({ parts }) => parts));
    const driven = model.view === 'outline' && model.inputs.length > 0;
    if (driven) section.append(element('div', { class: 'actions' }, telling('Which one was filmed?', 'viewing', 'One moment…', () => this.viewing())));
    return section;
  }

  /** Runs a viewing test with twenty pairs of a filmed flame and the flame that plays. */
  private async viewing(): Promise<string> {
    const { wisp, player } = this.app;
    const { playing } = player;
    if (playing === null) return '';
    const { ANSWERS, rigPairs, Viewing } = await fetchPart(() => import('../viewing/viewing.js'));
    const pairs = await rigPairs(wisp, playing.bytes, ANSWERS);
    new Viewing(pairs, { model: playing.file, from: 'films of the candle rig' });
    return 'Answered';
  }

  private knobs(): HTMLElement {
    const again = button('Other chance', () => this.app.change({ seed: 1 + Math.floor(Math.random() * 1e6) }));
    const senses = button('Tilt and touch', () => this.app.toggleSenses(), { 'data-knob': 'senses', 'aria-pressed': String(this.sensesOn) });
    return element('section', {}, element('h3', {}, 'Change it'), this.noise(this.app.settings.noise), element('div', { class: 'actions' }, again, senses));
  }

  private noise(now: number): HTMLElement {
    const said = (value: number): string => `${Math.round(100 * value)} %`;
    const change = (): void => {
      output.value = said(input.valueAsNumber);
      this.app.change({ noise: input.valueAsNumber });
    };
    const input = element('input', { type: 'range', id: 'knob-noise', min: 0, max: 2, step: 0.05, value: now, 'data-knob': 'noise', input: change });
    const output = element('output', {}, said(now));
    return element('label', { class: 'knob', for: 'knob-noise' }, element('span', {}, 'Learned noise'), output, input);
  }

  private files(shown: Playing): HTMLElement {
    if (this.address !== null) URL.revokeObjectURL(this.address);
    this.address = URL.createObjectURL(new Blob([shown.bytes.slice()], { type: 'application/octet-stream' }));
    const save = element('a', { class: 'tool', href: this.address, download: shown.file, 'data-file': 'save' }, 'Save this model');
    const open = (): void => {
      this.app.take({ files: [...(chosen.files ?? [])], entries: [] });
      chosen.value = '';
    };
    const chosen = element('input', { type: 'file', accept: '.wisp', hidden: true, 'data-file': 'open', change: open });
    const send = button('Send it…', () => this.app.showCard(true), { 'data-file': 'card' });
    return element(
      'section',
      {},
      element('h3', {}, 'The file'),
      element('p', {}, 'A .wisp file can be dropped anywhere on this page to play it.'),
      element('div', { class: 'actions' }, save, button('Open a model…', () => chosen.click()), chosen, send),
    );
  }
}
