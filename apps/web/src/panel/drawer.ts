// The drawer about the model: live plots, controls, facts and file.

import type { Model } from '@wisp/player';
import type { Settings } from '../link.js';
import type { FrameCost } from '@wisp/player/parts/stage/stage';
import type { Reading } from '@wisp/player/parts/stage/scene';
import { element } from './element.js';
import { telling } from './telling.js';
import { factsOf } from './facts.js';
import { introductionTo } from './introduction.js';
import { Plot, type Ink } from './plot.js';

/** Model shown in the drawer. */
export interface Shown {
  model: Model;
  bytes: Uint8Array;
  file: string;
  /** false: a dropped file */
  shipped: boolean;
  answerName: string;
  /** whether its wind response is borrowed from the shipped flame */
  borrows: boolean;
}

export interface DrawerEvents {
  change(change: Partial<Settings>): void;
  open(file: File): void;
  closed(): void;
  send(): void;
  /** opens the viewing test */
  viewing(): Promise<string>;
  /** toggles tilt and touch; returns the new state */
  senses(): boolean;
}

/** Frames per update of the plots. */
const PLOT_EVERY = 2;

export class Drawer {
  private plots: Record<'wind' | 'answer' | 'cost', Plot> | null = null;
  private outputs: Partial<Record<'wind' | 'answer' | 'cost', HTMLOutputElement>> = {};
  private frames = 0;
  private sensesOn = false;
  private address: string | null = null;

  constructor(
    private readonly place: HTMLElement,
    private readonly events: DrawerEvents,
  ) {
    place.addEventListener('keydown', (event) => {
      if (event.key === 'Escape') events.closed();
    });
  }

  /** Whether tilt and touch are on. */
  showSenses(on: boolean): void {
    this.sensesOn = on;
    this.place.querySelector('[data-knob=senses]')?.setAttribute('aria-pressed', String(on));
  }

  get open(): boolean {
    return !this.place.hidden;
  }

  /** Whether one of its controls has the focus. */
  get holdsFocus(): boolean {
    return this.place.contains(document.activeElement);
  }

  show(open: boolean): void {
    this.place.hidden = !open;
    if (open) this.place.querySelector<HTMLElement>('button')?.focus();
  }

  /** Shows a model and settings. */
  fill(shown: Shown, settings: Readonly<Settings>): void {
    const close = element('button', { type: 'button', class: 'tool round', 'aria-label': 'Close' }, '×');
    close.addEventListener('click', () => this.events.closed());
    this.place.replaceChildren(
      element('header', {}, element('h2', {}, 'What was learned'), close),
      element('p', { class: 'introduction' }, introductionTo(shown.model, shown.shipped, shown.borrows)),
      this.livePlots(shown),
      this.knobs(settings),
      factsOf(shown.model, shown.bytes.length),
      this.files(shown),
    );
  }

  /** Adds one frame to the plots. */
  frame(reading: Reading, cost: Readonly<FrameCost>): void {
    if (this.plots === null) return;
    const values = { wind: reading.wind, answer: reading.answer, cost: cost.update + cost.draw };
    for (const name of ['wind', 'answer', 'cost'] as const) this.plots[name].push(values[name]);
    this.frames += 1;
    if (!this.open || this.frames % PLOT_EVERY !== 0) return;
    for (const name of ['wind', 'answer', 'cost'] as const) {
      this.plots[name].draw();
      const mean = this.plots[name].mean(name === 'cost' ? 60 : 4);
      const output = this.outputs[name];
      if (output !== undefined) output.value = name === 'cost' ? `${mean.toFixed(2)} ms` : mean.toFixed(2);
    }
  }

  private livePlots(shown: Shown): HTMLElement {
    const section = element('section', {}, element('h3', {}, 'Live'));
    const add = (name: 'wind' | 'answer' | 'cost', words: string, colour: Ink, least: readonly [number, number]): Plot => {
      const canvas = element('canvas', { class: 'plot', 'aria-hidden': 'true' });
      const output = element('output');
      this.outputs[name] = output;
      section.append(element('div', { class: 'plot-line' }, element('span', {}, words), output), canvas);
      return new Plot(canvas, colour, least);
    };
    this.plots = {
      wind: add('wind', 'Wind in', ['#7fc4ff', '#1767a8'], [-0.2, 1]),
      answer: add('answer', `Out: ${shown.answerName}`, ['#ffb35c', '#b25a00'], [-0.3, 0.3]),
      cost: add('cost', 'Our time a frame', ['#9fd8a4', '#2c7a3a'], [0, 4]),
    };
    const driven = shown.model.view === 'outline' && shown.model.inputs.length > 0;
    if (driven) section.append(element('div', { class: 'actions' }, telling('Which one was filmed?', 'viewing', 'One moment…', () => this.events.viewing())));
    return section;
  }

  private knobs(settings: Readonly<Settings>): HTMLElement {
    const section = element('section', {}, element('h3', {}, 'Change it'));
    section.append(this.noise(settings.noise));
    const again = element('button', { type: 'button', class: 'tool' }, 'Other chance');
    again.addEventListener('click', () => this.events.change({ seed: 1 + Math.floor(Math.random() * 1e6) }));
    const senses = element('button', { type: 'button', class: 'tool', 'data-knob': 'senses' }, 'Tilt and touch');
    senses.setAttribute('aria-pressed', String(this.sensesOn));
    senses.addEventListener('click', () => this.events.senses());
    section.append(element('div', { class: 'actions' }, again, senses));
    return section;
  }

  private noise(now: number): HTMLElement {
    const said = (value: number): string => `${Math.round(100 * value)} %`;
    const input = element('input', { type: 'range', id: 'knob-noise', min: 0, max: 2, step: 0.05, value: now, 'data-knob': 'noise' });
    const output = element('output', {}, said(now));
    input.addEventListener('input', () => {
      output.value = said(input.valueAsNumber);
      this.events.change({ noise: input.valueAsNumber });
    });
    return element('label', { class: 'knob', for: 'knob-noise' }, element('span', {}, 'Learned noise'), output, input);
  }

  private files(shown: Shown): HTMLElement {
    if (this.address !== null) URL.revokeObjectURL(this.address);
    this.address = URL.createObjectURL(new Blob([shown.bytes.slice()], { type: 'application/octet-stream' }));
    const save = element('a', { class: 'tool', href: this.address, download: shown.file, 'data-file': 'save' }, 'Save this model');
    const chosen = element('input', { type: 'file', accept: '.wisp', hidden: true, 'data-file': 'open' });
    const send = element('button', { type: 'button', class: 'tool', 'data-file': 'card' }, 'Send it…');
    send.addEventListener('click', () => this.events.send());
    const open = element('button', { type: 'button', class: 'tool' }, 'Open a model…');
    open.addEventListener('click', () => chosen.click());
    chosen.addEventListener('change', () => {
      const file = chosen.files?.[0];
      if (file !== undefined) this.events.open(file);
      chosen.value = '';
    });
    return element(
      'section',
      {},
      element('h3', {}, 'The file'),
      element('p', {}, 'A .wisp file can be dropped anywhere on this page to play it.'),
      element('div', { class: 'actions' }, save, open, chosen, send),
    );
  }
}
