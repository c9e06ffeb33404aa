// What was gathered and learned so far. Nothing of it is kept anywhere else, and closing the page forgets it.

import type { Captured, Learned, PictureSettings, Recipe, Watch } from '@wisp/studio';
import type { Outlines } from './outlines.js';
import type { Reel } from './reel.js';
import type { Thing } from './words.js';

/** A film that is looked at. */
export interface Looked {
  name: string;
  reel: Reel;
  /** the film itself, where it is a file that can be played */
  film: File | null;
  settings: PictureSettings;
  /** looks at it once more, in another way; null: the camera's film was not kept */
  again: ((settings: PictureSettings, watch: Watch) => Promise<Captured>) | null;
}

/** A film that was looked at, and what came of it. */
export interface Take extends Looked {
  captured: Captured;
  /** null: the recording is not of an outline */
  outlines: Outlines | null;
}

export interface Session {
  takes: Take[];
  recipe: Recipe;
  learned: Learned | null;
}

/** What a film shows. */
export const shownIn = ({ captured }: Take): Thing => (captured.series.some(({ name }) => name === 'pos.x') ? 'fall' : 'flame');

/** Odd: rows that velocities of filmed falls are taken over, about a sixth of a second, for a film shows positions to some
 * thousandths of its height. */
export const smoothRows = (rate: number): number => Math.max(5, 2 * Math.round(rate / 12) + 1);

/** What a session is about. */
export const thingOf = ({ recipe }: Session): Thing => (recipe.kind === 'arx' ? 'table' : recipe.kind === 'leaf' || recipe.kind === 'chain' ? 'fall' : 'flame');

/** Names of what comes out. */
export const outputsOf = ({ takes }: Session): string[] => (takes[0]?.captured.series ?? []).filter(({ role }) => role === 'output').map(({ name }) => name);

export const newSession = (): Session => ({ takes: [], recipe: { kind: 'flame' }, learned: null });

/** The name that files and the model get. */
export function sessionName({ takes, recipe }: Session): string {
  const name = recipe.name ?? takes[0]?.name.replace(/\.[^.]*$/, '') ?? 'flame';
  return name.replace(/[^\p{L}\p{N} _-]+/gu, '-').trim() || 'flame';
}
