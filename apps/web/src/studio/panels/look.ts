// Findings in a film: verdict, decisions, and possible next actions.

import type { Seen } from '@wisp/studio';
import { definitions, element } from '../../panel/element.js';
import { wallField } from './rate.js';
import { button, choice, list, verdictHead } from './verdict.js';
import type { Room } from '../room.js';
import { shownIn, type Take } from '../session.js';
import { adviceOf, figure, foundIn, sentence, within } from '../words.js';

const COLOURS: Readonly<Record<string, string>> = { luma: 'all colours', red: 'red', green: 'green', blue: 'blue' };

type Fact = readonly [string, string];

/** Returns names and values of what is found so far in a film. */
export function partOfSeen({ threshold, channel, flames, frame, state, moving }: Seen, falls: boolean): Fact[] {
  if (falls) return [['Picture', frame.toLocaleString('en')], ['Moves', moving === null ? 'nothing' : 'something']];
  const facts: Fact[] = [['Picture', frame.toLocaleString('en')], ['Flame', state === 'waiting' ? 'not found yet' : state === 'gone' ? 'not in this picture' : 'followed']];
  if (threshold !== null && channel !== null) facts.push(['Its edge', `${Math.round(threshold)} of 255 in ${COLOURS[channel] ?? channel}`]);
  if (flames !== null && flames > 1) facts.push(['Flames', String(flames)]);
  return facts;
}

function factsOf({ captured }: Take): Fact[] {
  const { report, rows, rate } = captured;
  const facts: Fact[] = [['Length', `${(rows / rate).toFixed(1)} s, ${Math.round(rate * 100) / 100} frames a second`]];
  const [falls, whole, missed] = [figure(report, 'falls'), figure(report, 'whole'), figure(report, 'missed')];
  if (falls !== null) {
    facts.push(['Falls', `${falls}${whole === null || whole === falls ? '' : `, ${whole} of them whole`}${missed ? `, and ${missed} that could not be followed` : ''}`]);
    facts.push(['Tilt', String(within(report, 'tilt_reason') ?? '')]);
  }
  const [tracked, frames, threshold] = [figure(report, 'tracked'), figure(report, 'frames'), figure(report, 'threshold')];
  if (tracked !== null && frames !== null) facts.push(['Outline', `in ${tracked.toLocaleString('en')} of ${frames.toLocaleString('en')} pictures`]);
  const channel = within(report, 'channel');
  if (threshold !== null && typeof channel === 'string') facts.push(['Its edge', `${Math.round(threshold)} of 255 in ${COLOURS[channel] ?? channel}`]);
  const wind = within(report, 'wind', 'reason');
  if (typeof wind === 'string') facts.push(['Wind', wind]);
  return facts;
}

export function lookPanel(take: Take, takes: readonly Take[], room: Room): HTMLElement {
  const { captured, settings } = take;
  const { report } = captured;
  const falls = shownIn(take) === 'fall';
  const { good, title, reason } = foundIn(captured, falls ? 'fall' : 'flame');
  const panel = element(
    'div',
    { class: 'panel' },
    verdictHead(good, title, reason),
    element('div', { class: 'actions' }, button(takes.length > 1 ? `Learn from ${takes.length} films` : 'Learn it', 'learn', () => void room.learn(), good), button('Film more', 'more', () => room.gather(), !good)),
    element('dl', { class: 'found' }, ...definitions(factsOf(take))),
  );
  const flames = within(report, 'flames');
  if (falls && take.again !== null) panel.append(wallField(settings.height ?? 1, (height) => room.lookAgain({ ...settings, height, looks_for: 'falls' })));
  if (typeof flames === 'number' && flames > 1 && take.again !== null) panel.append(flameChoice(flames, settings.flame ?? 1, (flame) => room.lookAgain({ ...settings, flame })));
  const warnings = [...(report.warnings ?? []).filter((line) => !falls || !line.includes('--height')).map(sentence), ...(falls ? [] : adviceOf([captured], null))];
  panel.append(
    ...list('Better next time', [...new Set(warnings)], 'warnings'),
    ...(take.again === null ? [] : [element('p', { class: 'quiet' }, 'Not the right one? Drag a box over the picture to say where to look.')]),
    element(
      'div',
      { class: 'actions' },
      ...(take.again === null ? [] : [button(falls ? 'It is a flame' : 'It is something that falls', 'other', () => room.lookAgain({ ...settings, looks_for: falls ? 'flame' : 'falls' }))]),
      button('Leave this film out', 'leave-out', () => room.leaveOut(take)),
    ),
  );
  return panel;
}

/** `choose` receives the index of the flame by size, from 1. */
function flameChoice(flames: number, now: number, choose: (which: number) => void): HTMLElement {
  const all = Array.from({ length: Math.min(flames, 6) }, (_, k) => k + 1);
  return choice('Which flame', all.map((which) => [which === 1 ? 'largest' : String(which), { 'aria-pressed': String(which === now), click: () => choose(which) }]));
}
