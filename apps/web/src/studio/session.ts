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

/** `aside`: films that are not learned from, as they show another kind of object, or as a table is */
export interface Session { takes: Take[]; aside: Take[]; recipe: Recipe; learned: Learned | null }

/** Kind of object in a film. */
export const shownIn = ({ captured }: Take): Thing => (captured.series.some(({ name }) => name === 'pos.x') ? 'fall' : 'flame');

/** Odd number of rows over which velocities of filmed falls are taken, about 1/6 s, as positions in films are
 * accurate to some thousandths of the height. */
const smoothRows = (rate: number): number => Math.max(5, 2 * Math.round(rate / 12) + 1);

/** Kind of object of a session. */
export const thingOf = ({ recipe }: Session): Thing => (recipe.kind === 'arx' ? 'table' : recipe.kind === 'leaf' || recipe.kind === 'chain' ? 'fall' : 'flame');

/** Names of a session's outputs. */
export const outputsOf = ({ takes }: Session): string[] => (takes[0]?.captured.series ?? []).filter(({ role }) => role === 'output').map(({ name }) => name);

export const newSession = (): Session => ({ takes: [], aside: [], recipe: { kind: 'flame' }, learned: null });

/** Name of files and model. */
export function sessionName({ takes, recipe }: Session): string {
  const name = recipe.name ?? takes[0]?.name.replace(/\.[^.]*$/, '') ?? 'flame';
  return name.replace(/[^\p{L}\p{N} _-]+/gu, '-').trim() || 'flame';
}

/** Releases a session's pictures and returns a new session. */
export function emptied({ takes, aside }: Session): Session {
  for (const { reel } of [...takes, ...aside]) reel.close();
  return newSession();
}

/** A session's films of both kinds. A table, which is learned alone, is none of them. */
export const filmsOf = (session: Session): Take[] => (thingOf(session) === 'table' ? [...session.aside] : [...session.aside, ...session.takes]);

/** A session that learns from the films of the kind of `last`. */
function sessionOf(films: readonly Take[], last: Take, { recipe }: Session): Session {
  const takes = films.filter((take) => shownIn(take) === shownIn(last));
  const falls = { ...recipeOfFalls(takes.map(({ captured }) => captured)), smooth_rows: smoothRows(last.captured.rate) };
  const flame = recipe.kind === 'flame' ? recipe : newSession().recipe;
  return { takes, aside: films.filter((take) => !takes.includes(take)), recipe: shownIn(last) === 'fall' ? falls : flame, learned: null };
}

/** Adds a take, in place of an earlier version of its film, or at the end. Takes of another kind are set aside. */
export function withTake(session: Session, take: Take): Session {
  const films = filmsOf(session);
  const before = films.findIndex(({ again }) => again !== null && again === take.again);
  films[before]?.reel.close();
  films.splice(before < 0 ? films.length : before, before < 0 ? 0 : 1, take);
  return sessionOf(films, take, session);
}

/** Leaves a take out. Where it was the last of its kind, those set aside return. */
export function withoutTake(session: Session, take: Take): Session {
  take.reel.close();
  const films = filmsOf(session).filter((one) => one !== take);
  const last = films.filter((one) => session.takes.includes(one)).at(-1) ?? films.at(-1);
  return last === undefined ? newSession() : sessionOf(films, last, session);
}
