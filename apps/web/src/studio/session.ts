// Gathered and learned data. They are stored nowhere else, and closing the page discards them.

import type { Captured, Learned, PictureSettings, Recipe, Watch } from '@wisp/studio';
import type { Outlines } from './outlines.js';
import type { Reel } from './reel.js';
import { recipeOfFalls } from './table_head.js';
import type { Thing } from './words.js';

/** A film being analysed. */
export interface Looked {
  name: string;
  reel: Reel;
  /** the film's file; null for pictures, tables and the camera */
  film: File | null;
  settings: PictureSettings;
  /** analyses the film again with other settings; null: the camera's film was not kept */
  again: ((settings: PictureSettings, watch: Watch) => Promise<Captured>) | null;
}

/** An analysed film with its result. */
export interface Take extends Looked {
  captured: Captured;
  /** null: not a recording of an outline */
  outlines: Outlines | null;
}

export interface Session { takes: Take[]; recipe: Recipe; learned: Learned | null }

/** Kind of object in a film. */
export const shownIn = ({ captured }: Take): Thing => (captured.series.some(({ name }) => name === 'pos.x') ? 'fall' : 'flame');

/** Odd number of rows over which velocities of filmed falls are taken, about 1/6 s, as positions in films are
 * accurate to some thousandths of the height. */
const smoothRows = (rate: number): number => Math.max(5, 2 * Math.round(rate / 12) + 1);

/** Kind of object of a session. */
export const thingOf = ({ recipe }: Session): Thing => (recipe.kind === 'arx' ? 'table' : recipe.kind === 'leaf' || recipe.kind === 'chain' ? 'fall' : 'flame');

/** Names of a session's outputs. */
export const outputsOf = ({ takes }: Session): string[] => (takes[0]?.captured.series ?? []).filter(({ role }) => role === 'output').map(({ name }) => name);

export const newSession = (): Session => ({ takes: [], recipe: { kind: 'flame' }, learned: null });

/** Name of files and model. */
export function sessionName({ takes, recipe }: Session): string {
  const name = recipe.name ?? takes[0]?.name.replace(/\.[^.]*$/, '') ?? 'flame';
  return name.replace(/[^\p{L}\p{N} _-]+/gu, '-').trim() || 'flame';
}

/** Releases a session's pictures and returns a new session. */
export function emptied({ takes }: Session): Session {
  for (const { reel } of takes) reel.close();
  return newSession();
}

/** Adds a take, in place of an earlier version of its film, or at the end. Takes of another kind are dropped first. */
export function withTake(session: Session, take: Take): Session {
  const thing = shownIn(take);
  const made = thingOf(session) === thing ? session : emptied(session);
  const before = made.takes.findIndex(({ again }) => again !== null && again === take.again);
  made.takes[before]?.reel.close();
  made.takes.splice(before < 0 ? made.takes.length : before, before < 0 ? 0 : 1, take);
  const recipe = thing === 'fall' ? { ...recipeOfFalls(made.takes.map(({ captured }) => captured)), smooth_rows: smoothRows(take.captured.rate) } : made.recipe;
  return { ...made, recipe, learned: null };
}
