// What panels with a verdict share: its sentence in a colour, and buttons for what can be done about it.

import { element } from '../../panel/element.js';

export function button(words: string, name: string, act: () => void, main = false): HTMLButtonElement {
  const made = element('button', { type: 'button', class: main ? 'tool main' : 'tool', 'data-act': name }, words);
  made.addEventListener('click', act);
  return made;
}

export const verdictHead = (good: boolean, title: string, reason: string): HTMLElement =>
  element('div', { class: good ? 'verdict good' : 'verdict bad' }, element('h2', { tabindex: '-1' }, title), element('p', {}, reason));
