// Result of learning: verdict, quality, the flame to blow at, and suggestions for improvement.

import type { Learned, Recipe } from '@wisp/studio';
import { element, type Attributes } from '../../panel/element.js';
import { telling } from '../../panel/telling.js';
import { plotsOf } from '../pictures/curves.js';
import type { Room } from '../room.js';
import { outputsOf, thingOf, type Session } from '../session.js';
import { takingOf } from './taking.js';
import { button, choice, list, verdictHead } from './verdict.js';
import { adviceOf, isHeldOut, metersOf, sentence, verdictOf, type Meter, type Thing } from '../words.js';

function meter({ words, share, good, value }: Meter): HTMLElement {
  const bar = element('div', { class: share >= good ? 'bar good' : 'bar', 'aria-hidden': 'true' }, element('i'), element('b'));
  (bar.firstElementChild as HTMLElement).style.width = `${100 * share}%`;
  (bar.lastElementChild as HTMLElement).style.left = `${100 * good}%`;
  return element('div', { class: 'meter' }, element('span', {}, words), element('output', {}, value), bar);
}

const TO_PLAY = { flame: ['Blow it out', 'Blow at it all the same'], fall: ['See it fall', 'See it fall all the same'] } as const;

/** Heading of a result's bars. */
function titleOfMeters(thing: Thing, learned: Learned): string {
  if (thing === 'fall') return 'Beside what was recorded';
  if (learned.judged !== undefined) return 'On the last rows, which a trial had not seen';
  return isHeldOut(learned.report) ? 'On seconds that it had not seen' : 'How well it fits what it was learned from';
}

export function resultPanel(session: Session, learned: Learned, room: Room): HTMLElement {
  const { takes, recipe } = session;
  const thing = thingOf(session);
  const flame = thing === 'flame';
  const { model, report, curves, text } = learned;
  const { good, title, reason } = verdictOf(learned, thing);
  const meters = metersOf(learned, thing, outputsOf(session));
  const panel = element('div', { class: 'panel result' }, verdictHead(good, title, reason));
  if (thing !== 'table') {
    const play = button(TO_PLAY[thing][good ? 0 : 1], 'blow', () => room.blow(model), good);
    const compare = flame ? [telling('Which one was filmed?', 'compare', 'One moment…', () => room.compare(model))] : [];
    panel.append(element('div', { class: 'actions' }, play, button('Film more', 'more', () => room.gather(), !good), ...compare));
  }
  if (meters.length > 0) panel.append(element('section', {}, element('h3', {}, titleOfMeters(thing, learned)), ...meters.map(meter)));
  panel.append(
    ...list('Take care', (report.warnings ?? []).map(sentence), 'warnings'),
    ...(flame ? list('To make it better', adviceOf(takes.map(({ captured }) => captured), report), 'advice') : []),
    takingOf(session, learned, room),
    moreOf(recipe, text, flame ? plotsOf(curves) : null, room),
    element('div', { class: 'actions' }, button('Begin anew', 'anew', () => room.anew())),
  );
  return panel;
}

type Option = readonly [string, Partial<Recipe>];

const FLAME_KNOBS: readonly (readonly [string, keyof Recipe, readonly Option[]])[] = [
  ['Moves', 'paper', [['as a shape', { paper: 0 }], ['point by point, as in the paper', { paper: 4 }]]],
];

const TABLE_KNOBS: typeof FLAME_KNOBS = [
  ['Remembers', 'order', [['as usual', { order: 0 }], ['1', { order: 1 }], ['2', { order: 2 }], ['4', { order: 4 }], ['8', { order: 8 }]]],
  ['Input lags', 'nb', [['as usual', {}], ['1', { nb: 1 }], ['2', { nb: 2 }], ['4', { nb: 4 }]]],
  ['Delay', 'nk', [['found', {}], ['0', { nk: 0 }], ['1', { nk: 1 }], ['3', { nk: 3 }]]],
];

function knobsOf({ kind }: Recipe): typeof FLAME_KNOBS {
  if (kind === 'arx') return TABLE_KNOBS;
  return kind === 'leaf' || kind === 'chain' ? [] : FLAME_KNOBS;
}

/** Controls for learning again, and the report as printed by the program. */
function moreOf(recipe: Recipe, text: string, plots: readonly HTMLElement[] | null, room: Room): HTMLElement {
  const details = element('details', { class: 'more' }, element('summary', {}, knobsOf(recipe).length > 0 ? 'More: learn it in another way' : 'More'));
  for (const [words, name, options] of knobsOf(recipe)) {
    const now = options.find(([, change]) => change[name] === recipe[name]) ?? options[0];
    const again = (change: Partial<Recipe>): void => room.learnAgain({ [name]: undefined, ...change } as Partial<Recipe>);
    const knob = (option: Option): Attributes => ({ 'aria-pressed': String(option === now), 'data-knob': `${name} ${option[0]}`, click: () => again(option[1]) });
    details.append(choice(words, options.map((option) => [option[0], knob(option)])));
  }
  if (plots !== null) details.append(element('div', { class: 'judged', 'data-plots': true }, ...plots));
  details.append(element('h3', {}, 'The report'), element('pre', { tabindex: '0', 'aria-label': 'The report' }, text));
  return details;
}
