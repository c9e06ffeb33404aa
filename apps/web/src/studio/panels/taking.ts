// Taking it away: the model, what it was learned from, a link, a tag for a page, a few seconds of film.

import { MOST_PACKED_BYTES, packModel } from '../../model_link.js';
import { element } from '../../panel/element.js';
import { telling } from '../../panel/telling.js';
import { saveFile } from '../../saving.js';
import { sessionName, type Session } from '../session.js';

async function copy(text: string): Promise<string> {
  await navigator.clipboard.writeText(text);
  return 'Copied';
}

/** Pictures that move. */
export type Moving = 'film' | 'gif';

/** The buttons. `film` saves three seconds of it burning in the page's room; null: it is no flame. */
export function takingOf(session: Session, film: ((kind: Moving) => Promise<string>) | null): HTMLElement {
  const { learned, takes } = session;
  if (learned === null) return element('div');
  const name = sessionName(session);
  const { model } = learned;
  const save = telling('The model', 'wisp', '', () => {
    saveFile(new Blob([model.slice()], { type: 'application/octet-stream' }), `${name}.wisp`);
    return Promise.resolve('Saved');
  });
  const recordings = telling(takes.length > 1 ? 'The recordings' : 'The recording', 'recording', '', () => {
    for (const take of takes) saveFile(new Blob([take.captured.csv.slice()], { type: 'text/csv' }), `${take.name.replace(/\.[^.]*$/, '')}.csv`);
    return Promise.resolve('Saved');
  });
  const link = telling('A link', 'link', '', async () => {
    if (model.length > MOST_PACKED_BYTES) return 'Too large: learn it light';
    const address = new URL(location.href);
    address.hash = new URLSearchParams({ scene: 'candle', seed: '1', model: await packModel(model) }).toString();
    return copy(address.href);
  });
  const tag = telling('A tag for a page', 'tag', '', () =>
    copy(`<script type="module" src="node_modules/@wisp/player/dist/candle/element.js"></script>\n<wisp-candle src="${name}.wisp" wind="mic"></wisp-candle>`),
  );
  const made = film === null ? [save, recordings] : [save, recordings, link, tag, telling('Three seconds', 'loop', 'Recording…', () => film('film')), telling('As a GIF', 'gif', 'Recording…', () => film('gif'))];
  return element(
    'section',
    { class: 'taking' },
    element('h3', {}, 'Take it away'),
    element('div', { class: 'actions' }, ...made),
    element('p', { class: 'quiet' }, `${Math.round(model.length / 100) / 10} kB. The model plays in games, on pages and on microcontrollers; the recording can be learned from again.`),
  );
}
