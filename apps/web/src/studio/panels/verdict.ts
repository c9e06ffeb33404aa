// Elements shared by panels: coloured verdict, lists, and action buttons.

import { button as tool, element, type Attributes } from '../../panel/element.js';

export const button = (words: string, name: string, act: () => void, main = false): HTMLButtonElement =>
  tool(words, act, { class: main ? 'tool main' : 'tool', 'data-act': name });

export const panelOf = (title: string, ...parts: HTMLElement[]): HTMLElement => element('div', { class: 'panel' }, element('h2', { tabindex: '-1' }, title), ...parts);

/** A choice among options: one button each, with its attributes. */
export function choice(words: string, options: readonly (readonly [string, Attributes])[]): HTMLElement {
  const made = options.map(([label, attributes]) => element('button', { type: 'button', ...attributes }, label));
  return element('div', { class: 'choice', role: 'group', 'aria-label': words }, element('span', {}, words), ...made);
}

/** A list with a heading; nothing where it is empty. */
export function list(title: string, lines: readonly string[], kind: string): HTMLElement[] {
  if (lines.length === 0) return [];
  return [element('section', { class: kind }, element('h3', {}, title), element('ul', {}, ...lines.map((line) => element('li', {}, line))))];
}

export const verdictHead = (good: boolean, title: string, reason: string): HTMLElement =>
  element('div', { class: good ? 'verdict good' : 'verdict bad' }, element('h2', { tabindex: '-1' }, title), element('p', {}, reason));
