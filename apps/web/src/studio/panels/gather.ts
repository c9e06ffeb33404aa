// The first panel: sources to learn from.

import { drawing, element, type Attributes } from '../../panel/element.js';
import type { Room } from '../room.js';
import type { Thing } from '../words.js';
import { button, panelOf } from './verdict.js';

const ICONS = {
  camera: 'M4 8h3l2-3h6l2 3h3v11H4zM12 10a3.5 3.5 0 1 0 0 7 3.5 3.5 0 0 0 0-7z',
  film: 'M4 5h16v14H4zM8 5v14M16 5v14M4 9.700h4M4 14.300h4M16 9.700h4M16 14.300h4',
  falls: 'M5 4h14M12 7c5 2 5 7 0 11-5-4-5-9 0-11zM12 10v11',
  pictures: 'M3 7h13v12H3zM7 7V4h14v12h-5M3 16l4-4 3 3 2-2 4 4',
  table: 'M4 5h16v14H4zM4 10h16M10 10v9M15 10v9M4 14.500h16',
} as const;

function choice(name: keyof typeof ICONS, title: string, words: string, act: () => void): HTMLElement {
  const icon = drawing('svg', { viewBox: '0 0 24 24', 'aria-hidden': 'true' }, drawing('path', { d: ICONS[name] }));
  return element('button', { type: 'button', class: 'choice-card', 'data-gather': name, click: act }, icon, element('span', {}, element('b', {}, title), element('small', {}, words)));
}

/** `more`: sources gathered earlier, to be learned together with the new one; `back` returns to them. */
export function gatherPanel(room: Room, more: { count: number; thing: Thing; back: () => void } | null): HTMLElement {
  // A table is not learned together with anything.
  const first = more === null || more.thing === 'table';
  const chooser = (attributes: Attributes): HTMLInputElement => {
    const change = (): void => {
      const files = [...(input.files ?? [])];
      input.value = '';
      if (files.length > 0) room.files(files);
    };
    const input = element('input', { type: 'file', hidden: true, tabindex: '-1', change, ...attributes });
    return input;
  };
  const film = chooser({ accept: 'video/*,.mkv', multiple: true, 'data-choose': 'film' });
  const pictures = chooser({ webkitdirectory: true, multiple: true, 'data-choose': 'pictures' });
  const table = chooser({ accept: '.csv,.tsv,.txt,.dat,.asc,text/csv', 'data-choose': 'table' });
  const choices = element(
    'div',
    { class: 'choices' },
    choice('camera', 'Film a candle', 'with this camera and microphone, in half a minute', () => void room.film(false)),
    choice('film', 'Choose a film', 'of a flame or of something that falls, from your phone or disk', () => film.click()),
    choice('falls', 'Film something that falls', 'a slip of paper, a leaf: dropped before a plain wall, again and again', () => void room.film(true)),
    choice('pictures', 'Folder of pictures', 'numbered frames', () => pictures.click()),
    ...(first ? [choice('table', 'A table', 'CSV: what went in and what came out of anything', () => table.click())] : []),
    film,
    pictures,
    table,
  );
  const [title, words] = first ? ['Film a flame, then blow it out', BEGIN] : ['Film more', wordsOfMore(more.count, more.thing)];
  const last = more === null ? element('p', { class: 'quiet' }, HERE) : element('div', { class: 'actions' }, button('Back', 'back', () => more.back()));
  return panelOf(title, element('p', {}, words), choices, last);
}

const BEGIN =
  'Half a minute of a real candle is enough. Its outline is found in every picture, what the wind does to it is learned, and the flame that learned it is yours to blow at.';
const HERE = 'Or drop any of these here. All of it happens on this device: nothing is sent, and closing the page forgets it.';

const wordsOfMore = (count: number, thing: Thing): string =>
  `${count === 1 ? 'One film is' : `${count} films are`} kept. Another is learned together with ${count === 1 ? 'it' : 'them'}${thing === 'fall' ? ', if it is of the same thing falling.' : ': soft breaths in one, blowing out in the next.'}`;
