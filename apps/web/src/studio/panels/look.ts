// Findings in a film: verdict, decisions, and possible next actions.

import type { Seen } from '@wisp/studio';
import { element } from '../../panel/element.js';
import { rateField } from './rate.js';
import { button, choice, list, verdictHead } from './verdict.js';
import { shownIn, type Take } from '../session.js';
import { adviceOf, foundIn, sentence, within } from '../words.js';

const COLOURS: Readonly<Record<string, string>> = { luma: 'all colours', red: 'red', green: 'green', blue: 'blue' };

type Fact = readonly [string, string];

/** Decisions made so far. */
export function partOfSeen({ threshold, channel, flames, frame, state, moving }: Seen, falls: boolean): Fact[] {
  if (falls) return [['Picture', frame.toLocaleString('en')], ['Moves', moving === null ? 'nothing' : 'something']];
  const facts: Fact[] = [['Picture', frame.toLocaleString('en')], ['Flame', state === 'waiting' ? 'not found yet' : state === 'gone' ? 'not in this picture' : 'followed']];
  if (threshold !== null && channel !== null) facts.push(['Its edge', `${Math.round(threshold)} of 255 in ${COLOURS[channel] ?? channel}`]);
  if (flames !== null && flames > 1) facts.push(['Flames', String(flames)]);
  return facts;
}

function factsOf({ captured }: Take): Fact[] {
  const { report, rows, rate } = captured;
  const number = (...path: string[]): number | null => {
    const value = within(report, ...path);
    return typeof value === 'number' ? value : null;
  };
  const facts: Fact[] = [['Length', `${(rows / rate).toFixed(1)} s, ${Math.round(rate * 100) / 100} frames a second`]];
  const [falls, whole, missed] = [number('falls'), number('whole'), number('missed')];
  if (falls !== null) {
    facts.push(['Falls', `${falls}${whole === null || whole === falls ? '' : `, ${whole} of them whole`}${missed ? `, and ${missed} that could not be followed` : ''}`]);
    facts.push(['Tilt', String(within(report, 'tilt_reason') ?? '')]);
  }
  const [tracked, frames, threshold] = [number('tracked'), number('frames'), number('threshold')];
  if (tracked !== null && frames !== null) facts.push(['Outline', `in ${tracked.toLocaleString('en')} of ${frames.toLocaleString('en')} pictures`]);
  const channel = within(report, 'channel');
  if (threshold !== null && typeof channel === 'string') facts.push(['Its edge', `${Math.round(threshold)} of 255 in ${COLOURS[channel] ?? channel}`]);
  const wind = within(report, 'wind', 'reason');
  if (typeof wind === 'string') facts.push(['Wind', wind]);
  return facts;
}

export interface LookEvents {
  learn(): void;
  more(): void;
  leaveOut(): void;
  /** index of the flame by size, from 1 */
  flame(which: number): void;
  /** switches between flame and falling object */
  other(): void;
  /** height of the wall in the picture, metres */
  height(metres: number): void;
}

/** The panel. */
export function lookPanel(take: Take, takes: readonly Take[], events: LookEvents): HTMLElement {
  const { captured, settings } = take;
  const { report } = captured;
  const falls = shownIn(take) === 'fall';
  const { good, title, reason } = foundIn(captured, falls ? 'fall' : 'flame');
  const facts = element('dl', { class: 'found' });
  for (const [name, value] of factsOf(take)) facts.append(element('dt', {}, name), element('dd', {}, value));
  const panel = element(
    'div',
    { class: 'panel' },
    verdictHead(good, title, reason),
    element('div', { class: 'actions' }, button(takes.length > 1 ? `Learn from ${takes.length} films` : 'Learn it', 'learn', events.learn, good), button('Film more', 'more', events.more, !good)),
    facts,
  );
  const flames = within(report, 'flames');
  if (falls && take.again !== null) panel.append(wallHeight(settings.height ?? 1, events));
  if (typeof flames === 'number' && flames > 1 && take.again !== null) panel.append(flameChoice(flames, settings.flame ?? 1, events));
  const warnings = [...(report.warnings ?? []).filter((line) => !falls || !line.includes('--height')).map(sentence), ...(falls ? [] : adviceOf([captured], null))];
  panel.append(
    ...list('Better next time', [...new Set(warnings)], 'warnings'),
    ...(take.again === null ? [] : [element('p', { class: 'quiet' }, 'Not the right one? Drag a box over the picture to say where to look.')]),
    element(
      'div',
      { class: 'actions' },
      ...(take.again === null ? [] : [button(falls ? 'It is a flame' : 'It is something that falls', 'other', events.other)]),
      button('Leave this film out', 'leave-out', events.leaveOut),
    ),
  );
  return panel;
}

/** Field for the wall's height, since positions are in metres and films have no scale. */
function wallHeight(now: number, events: LookEvents): HTMLElement {
  const { input, label } = rateField('wall-height', 'Metres of wall that the picture shows, top to bottom', now);
  input.addEventListener('change', () => {
    if (input.valueAsNumber >= 0.01 && input.valueAsNumber <= 100) events.height(input.valueAsNumber);
  });
  return label;
}

function flameChoice(flames: number, now: number, events: LookEvents): HTMLElement {
  const all = Array.from({ length: Math.min(flames, 6) }, (_, k) => k + 1);
  return choice('Which flame', all.map((which) => [which === 1 ? 'largest' : String(which), { 'aria-pressed': String(which === now) }, () => events.flame(which)]));
}
