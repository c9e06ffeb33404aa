// What was gathered and learned so far. Nothing of it is kept anywhere else, and closing the page forgets it.

import type { Captured, Learned, PictureSettings, Recipe, Watch } from '@wisp/studio';
import type { Outlines } from './outlines.js';
import type { Reel } from './reel.js';
import { recipeOfFalls } from './table_head.js';
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

/** A new one, in the place of a session that is done with. */
export function emptied({ takes }: Session): Session {
  for (const { reel } of takes) reel.close();
  return newSession();
}

/** With a take more: at the place of the one that was looked at again, else after the others. A flame and a leaf are not learned together. */
export function withTake(session: Session, take: Take): Session {
  const thing = shownIn(take);
  const made = session.takes.some((one) => shownIn(one) !== thing) ? emptied(session) : session;
  const before = made.takes.findIndex(({ name, film }) => name === take.name && film === take.film && film !== null);
  made.takes[before]?.reel.close();
  made.takes.splice(before < 0 ? made.takes.length : before, before < 0 ? 0 : 1, take);
  const recipe = thing === 'fall' ? { ...recipeOfFalls(made.takes.map(({ captured }) => captured)), smooth_rows: smoothRows(take.captured.rate) } : made.recipe;
  return { ...made, recipe, learned: null };
}
