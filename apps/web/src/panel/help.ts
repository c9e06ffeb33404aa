// The help with all gestures and keys.

import type { App } from '../app.js';
import { button, closeButton, element } from './element.js';

const GESTURES: readonly (readonly [string, string])[] = [
  ['Blow', 'press the round button, then blow at the microphone; press it again to switch it off'],
  ['Move past', 'a pointer or a finger that passes quickly makes wind'],
  ['Drag', 'the candle, the cake or the match; beside them, to go round the table'],
  ['Tap', 'a candle that is out, to light it; the ground, to kick leaves up'],
  ['Drop', 'a .wisp file anywhere, to play it; a film or a table, to learn from it'],
];

const KEYS: readonly (readonly [string[], string])[] = [
  [['←', '→'], 'blow from the right, from the left'],
  [['↑'], 'a gentle breath'],
  [['Space'], 'blow hard'],
  [['L'], 'carry the match to a candle; kick leaves up'],
  [['B'], 'microphone on and off'],
  [['T'], 'tune it to your breath: breathe gently, blow hard'],
  [['−', '+'], 'fewer, more'],
  [[',', '.'], 'round the candle'],
  [['1', '2', '3'], 'candle, leaves, a flame of your own'],
  [['I'], 'what was learned'],
  [['S'], 'send it: name, age, wish'],
  [['A'], 'tilt and vibration: tilting the phone makes wind, turning it turns the view round the candle, and it vibrates when the flame goes out'],
  [['N'], 'learned noise on and off'],
  [['P'], 'pause'],
  [['F'], 'full screen'],
  [['?'], 'this help'],
];

export function fillHelp(dialog: HTMLDialogElement, app: App): void {
  const row = (how: string, ...what: (string | HTMLElement)[]): HTMLElement => element('tr', {}, element('th', { scope: 'row' }, ...what), element('td', {}, how));
  const rows = [...GESTURES.map(([what, how]) => row(how, what)), ...KEYS.map(([keys, how]) => row(how, ...keys.flatMap((key) => [element('kbd', {}, key), ' '])))];
  const single = element('input', { type: 'checkbox', checked: true, 'data-knob': 'keys', input: () => void (app.singleKeys = single.checked) });
  const pause = button('Pause, or go on', () => app.pause(), { 'data-knob': 'pause' });
  const close = closeButton(() => dialog.close());
  close.autofocus = true;
  dialog.replaceChildren(
    element('header', {}, element('h2', {}, 'Blow on it'), close),
    element('table', {}, ...rows),
    element('div', { class: 'actions' }, element('label', { class: 'check' }, single, 'Single keys do this'), pause),
    element(
      'p',
      {},
      'Sound is turned into wind inside this page and then forgotten; what you film for a flame of your own is forgotten when the ' +
        'page is closed. Nothing leaves this device, and nothing is stored but the page itself, so that it works without a network.',
    ),
  );
  // A press outside closes the help.
  dialog.addEventListener('click', (event) => {
    if (event.target === dialog) dialog.close();
  });
}
