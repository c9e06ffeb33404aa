// Steps of the studio, with their texts.

import type { PictureSettings } from '@wisp/studio';
import type { Thing } from './words.js';

export type Step = 'gather' | 'look' | 'learn' | 'blow';

export const STEPS: readonly Step[] = ['gather', 'look', 'learn', 'blow'];
export const STEP_WORDS: Readonly<Record<Thing, Readonly<Record<Step, string>>>> = {
  flame: { gather: 'Film', look: 'Look', learn: 'Learn', blow: 'Blow' },
  table: { gather: 'Table', look: 'Columns', learn: 'Learn', blow: 'See' },
  fall: { gather: 'Film', look: 'Look', learn: 'Learn', blow: 'See' },
};
export const LEARNING: Readonly<Record<Thing, string>> = {
  flame: 'What each point of the outline does next is fitted to what it did before, and to the wind. Some seconds are kept back, to judge by.',
  table: 'What comes out is fitted to its own past and to what went in: once without the last rows, to judge by them, and once from all.',
  fall: 'The motion is cut where it stalls, its pieces are sorted, and which follows which is counted. Some falls are kept back, to judge by.',
};

/** Texts shown during analysis of a film. */
export const LOOKING: Readonly<Record<NonNullable<PictureSettings['looks_for']>, { title: string; words: string; thing: Thing | 'either' }>> = {
  flame: { title: 'Looking for the flame', words: 'What is brightest and moves is followed by its edge. Is it another flame that you mean? Drag a box around it.', thing: 'flame' },
  falls: {
    title: 'Looking for falls',
    words: 'What moves before the wall is watched. What of it falls is decided when the film is over: the wall is what most pictures show.',
    thing: 'fall',
  },
  either: {
    title: 'Looking at the film',
    words: 'A flame is followed by its edge; if it is another that you mean, drag a box around it. What falls is found when the film is over.',
    thing: 'either',
  },
};
