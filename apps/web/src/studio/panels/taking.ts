// Export of results: model, recording, link, tag for a page, short film, files for other tools.

import type { ExportSettings, Learned } from '@wisp/studio';
import { MAX_PACKED_BYTES, packModel } from '../../model_link.js';
import { element } from '../../panel/element.js';
import { telling } from '../../panel/telling.js';
import { saveFile } from '../../saving.js';
import type { Room } from '../room.js';
import { outputsOf, sessionName, thingOf, type Session } from '../session.js';
import type { Thing } from '../words.js';

async function copy(text: string): Promise<string> {
  const { clipboard } = navigator as { clipboard?: Clipboard };
  return clipboard === undefined ? 'This browser does not let it be copied' : clipboard.writeText(text).then(() => 'Copied', () => 'Press again to copy it');
}

export type Moving = 'film' | 'gif';

/** Format of a file for other tools. */
export type Format = ExportSettings['format'];

/** Converts a name to an identifier valid in C. */
export const nameInC = (name: string): string => name.normalize('NFKD').replace(/\W+/g, '_').replace(/^(?=\d)|^_+/, 'wisp_');

export function takingOf(session: Session, { model }: Learned, room: Room): HTMLElement {
  const { takes } = session;
  const name = sessionName(session);
  const thing = thingOf(session);
  const outputs = outputsOf(session).length;
  const save = telling('The model', 'wisp', '', () => saveFile(new Blob([model.slice()], { type: 'application/octet-stream' }), `${name}.wisp`));
  const recordings = telling(takes.length > 1 ? 'The recordings' : 'The recording', 'recording', '', () => {
    for (const take of takes) saveFile(new Blob([take.captured.csv.slice()], { type: 'text/csv' }), `${take.name.replace(/\.[^.]*$/, '')}.csv`);
    return 'Saved';
  });
  const whole = model.length <= MAX_PACKED_BYTES;
  let small: Uint8Array | null = null; // kept, as browsers let only what follows a press at once be copied
  const link = telling('A link', 'link', whole ? '' : 'Making it small…', async () => {
    const sent = whole ? model : (small ??= await room.small());
    if (sent.length > MAX_PACKED_BYTES) return 'Too large for a link: send the model';
    const address = new URL(location.href);
    address.hash = new URLSearchParams({ scene: 'candle', seed: '1', model: await packModel(sent) }).toString();
    const said = await copy(address.href);
    return whole || said !== 'Copied' ? said : `${said}, of ${Math.round(sent.length / 1000)} kB`;
  });
  const tag = telling('A tag for a page', 'tag', '', () =>
    copy(`<script type="module" src="node_modules/@wisp/player/dist/candle/element.js"></script>\n<wisp-candle src="${name}.wisp" wind="mic"></wisp-candle>`),
  );
  const moving = (words: string, kind: Moving): HTMLButtonElement => telling(words, kind === 'film' ? 'loop' : kind, 'Recording…', () => room.record(model, kind));
  const file = (words: string, format: Format): HTMLButtonElement => telling(words, format, 'Making it…', () => room.make(format, model));
  const itself: Readonly<Record<Thing, readonly HTMLElement[]>> = { flame: [save, recordings, link, tag], fall: [save, recordings], table: [save, recordings] };
  const elsewhere: Readonly<Record<Thing, readonly HTMLElement[]>> = {
    flame: [moving('A film', 'film'), moving('As a GIF', 'gif'), file('glTF', 'glb'), file('Lottie', 'json')],
    fall: [file('glTF', 'glb')],
    table: outputs === 1 ? [file('C for a microcontroller', 'c')] : [],
  };
  const where = thing === 'table' ? 'programs and on pages' : 'games, on pages and in films';
  return element(
    'section',
    { class: 'taking' },
    element('h3', {}, 'Take it away'),
    element('div', { class: 'actions' }, ...itself[thing]),
    element('p', { class: 'quiet' }, `${Math.round(model.length / 100) / 10} kB. The model plays in ${where}. The recording can be learned from again.`),
    element('div', { class: 'actions' }, ...elsewhere[thing]),
    element('p', { class: 'quiet' }, thing === 'table' && outputs > 1 ? MANY_OUTPUTS : LOOPS[thing]),
  );
}

const LOOPS: Readonly<Record<Thing, string>> = {
  flame:
    'Loops of four seconds without a seam: glTF for Blender and engines, Lottie for apps; a sheet of pictures is made by the program (wisp export). ' +
    'C for a microcontroller is of one value, a lamp’s light: the program wisp makes it of this film (wisp capture brightness).',
  fall: 'Twenty that fall in a loop of six seconds, for Blender and engines.',
  table: 'C in whole numbers, without a library.',
};
const MANY_OUTPUTS = 'C for a microcontroller is made of models with one column that comes out: learn the table with one.';
