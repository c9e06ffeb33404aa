// The viewing test: a filmed and a played flame side by side, twenty times; which was filmed? Guessing is right half of the time.

import { FlameShape } from '@wisp/player/parts/candle/flame_shape';
import { button, closeButton, element } from '../panel/element.js';
import { telling } from '../panel/telling.js';
import { saveFile } from '../saving.js';
import { paintFlame } from '../studio/pictures/flame_paint.js';
import { surfaceOf } from '../studio/pictures/surface.js';
import type { Clip, Pair } from './pairs.js';

export { filmPairs, rigPairs } from './pairs.js';

export const ANSWERS = 20;
const SIDES = ['left', 'right'] as const;
type Side = (typeof SIDES)[number];

/** Share of right answers with its 95 % interval (Wilson, 1927). */
function shareOf(right: number, of: number): { share: number; low: number; high: number } {
  const z = 1.96;
  const share = right / of;
  const middle = (share + z ** 2 / (2 * of)) / (1 + z ** 2 / of);
  const half = (z * Math.sqrt((share * (1 - share)) / of + z ** 2 / (4 * of ** 2))) / (1 + z ** 2 / of);
  return { share, low: Math.max(0, middle - half), high: Math.min(1, middle + half) };
}

/** Meaning of the result for the model. */
function meaningOf(right: number, of: number): string {
  const { low, high } = shareOf(right, of);
  const spread = `${Math.round(100 * low)} to ${Math.round(100 * high)} %`;
  if (low > 0.5) return `You see a difference: with chance alone so many are right less than once in twenty tests. What lies between is ${spread}.`;
  if (high < 0.5) return `You see a difference, and took the played flame for the filmed one: ${spread}.`;
  return `You may as well have tossed a coin: in these two seconds the played flame passes for the filmed one. ${of < 60 ? `Twenty answers leave ${spread}; a class of five narrows it to a few per cent.` : `What is left is ${spread}.`}`;
}

/** A clip repeated on a canvas. */
class Screen {
  readonly canvas = element('canvas', { role: 'img' });
  clip: Clip | null = null;
  private readonly shape = new FlameShape();

  constructor(side: Side) {
    this.canvas.setAttribute('aria-label', `A flame, ${side}`);
  }

  draw(seconds: number): void {
    const surface = surfaceOf(this.canvas);
    const { clip } = this;
    if (surface === null || clip === null) return;
    const { context, width, height } = surface;
    const many = clip.outlines.length;
    const at = (seconds * clip.rate) % many;
    // Filmed and played outlines are processed alike: rounded at the base, then painted.
    this.shape.update(clip.outlines[Math.floor(at)] as Float32Array, 1);
    const unit = 0.56 * height;
    const line = this.shape.placed(unit, width / 2, 0.86 * height);
    // The clip repeats, fading out at its end and in at its beginning.
    context.globalAlpha = Math.min(1, at / 5, (many - at) / 5);
    paintFlame(context, line, unit);
    context.globalAlpha = 1;
  }
}

export class Viewing {
  private readonly dialog = element('dialog', { class: 'help viewing', 'aria-labelledby': 'viewing-title', close: () => void this.dialog.remove(), keydown: (event) => this.key(event as KeyboardEvent) });
  private readonly title = element('h2', { id: 'viewing-title', tabindex: '-1' });
  private readonly words = element('p', { 'aria-live': 'polite' });
  private readonly screens = { left: new Screen('left'), right: new Screen('right') };
  private readonly stage = element('div', { class: 'both' }, this.screens.left.canvas, this.screens.right.canvas);
  private readonly actions = element('div', { class: 'actions' });
  private readonly answers: { pair: string; filmed: Side; answered: Side; right: boolean; seconds: number }[] = [];
  private since = 0;
  private filmed: Side = 'left';

  /** `of`: name of the played model and source of the films, for the saved answers. */
  constructor(private readonly pairs: readonly Pair[], private readonly of: { model: string; from: string }) {
    this.dialog.append(element('header', {}, this.title, closeButton(() => this.dialog.close())), this.stage, this.words, this.actions);
    document.body.append(this.dialog);
    this.dialog.showModal();
    this.ask();
    const frame = (now: number): void => {
      if (!this.dialog.isConnected) return;
      if (this.since === 0) this.since = now;
      for (const screen of Object.values(this.screens)) screen.draw((now - this.since) / 1000);
      requestAnimationFrame(frame);
    };
    requestAnimationFrame(frame);
  }

  private ask(): void {
    const pair = this.pairs[this.answers.length];
    if (pair === undefined) return this.end();
    this.filmed = SIDES[Math.random() < 0.5 ? 0 : 1];
    this.screens[this.filmed].clip = pair.filmed;
    this.screens[this.filmed === 'left' ? 'right' : 'left'].clip = pair.played;
    this.since = 0;
    // The pressed button is gone, so the focus moves here for the arrow keys.
    this.title.focus();
    this.title.textContent = `Which one was filmed? ${this.answers.length + 1} of ${this.pairs.length}`;
    this.words.textContent = 'One of them was filmed. The other was worked out by the model, in the same wind, and nobody drew it.';
    this.actions.replaceChildren(
      ...SIDES.map((side) => button(side === 'left' ? '← This one' : 'This one →', () => this.take(side), { class: 'tool main', 'data-side': side })),
    );
  }

  private key(event: KeyboardEvent): void {
    event.stopPropagation();
    const side = event.key === 'ArrowLeft' ? 'left' : event.key === 'ArrowRight' ? 'right' : null;
    if (side !== null && this.answers.length < this.pairs.length) this.take(side);
  }

  private take(answered: Side): void {
    const pair = this.pairs[this.answers.length] as Pair;
    const seconds = Number(((performance.now() - this.since) / 1000).toFixed(2));
    this.answers.push({ pair: pair.name, filmed: this.filmed, answered, right: answered === this.filmed, seconds });
    this.ask();
  }

  private end(): void {
    const of = this.answers.length;
    const right = this.answers.filter((answer) => answer.right).length;
    const { share, low, high } = shareOf(right, of);
    this.title.textContent = `${right} of ${of} were right`;
    this.stage.hidden = true;
    this.words.textContent = meaningOf(right, of);
    const file = { test: 'wisp viewing test 1', ...this.of, right, of, share, interval_95: [low, high], answers: this.answers };
    this.actions.replaceChildren(
      telling('Take the answers away', 'answers', '', () => saveFile(new Blob([`${JSON.stringify(file, null, 1)}\n`], { type: 'application/json' }), 'wisp-viewing.json')),
    );
  }
}
