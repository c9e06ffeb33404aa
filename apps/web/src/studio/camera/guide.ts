// What to say to somebody who films: what to do next, and what is wrong with the picture.

import type { Seen } from '@wisp/studio';

/** What is done, one after another. */
export type Act = 'still' | 'blow' | 'out' | 'done';

/** Seconds of each. Without sound there is nothing to blow for. */
const STILL = 4;
const BLOW = 16;
const OUT = 9;
const STILL_ALONE = 20;
/** Seconds without a flame, once it is to be blown out, until it counts as out. */
const IS_OUT = 1.2;
/** A breath and a rest, seconds, and how much of it is breath. */
const ROUND = 4;
const BREATH = 2;

const BREATHS = ['Blow softly, from the side', 'Softly again', 'A little harder', 'Softly once more'];

export interface Moment {
  act: Act;
  words: string;
  /** of all that is filmed, 0 to 1 */
  share: number;
}

export class Guide {
  private gone = 0;
  private last = 0;

  /** `hears`: there is a microphone */
  constructor(private readonly hears: boolean) {}

  /** All that will be done, and how many seconds each takes at most. */
  get plan(): readonly (readonly [Act, string, number])[] {
    if (!this.hears) return [['still', 'Hold still, let it flicker', STILL_ALONE]];
    return [
      ['still', 'Hold still, let it burn alone', STILL],
      ['blow', 'Blow softly from the side, with pauses', BLOW],
      ['out', 'Blow it out', OUT],
    ];
  }

  /** What is to be done so many seconds after filming began. */
  at(seconds: number, state: Seen['state'] | null): Moment {
    const passed = seconds - this.last;
    this.last = seconds;
    if (!this.hears) {
      const done = seconds >= STILL_ALONE;
      return { act: done ? 'done' : 'still', words: 'Hold still. Let it flicker', share: Math.min(1, seconds / STILL_ALONE) };
    }
    const share = Math.min(1, seconds / (STILL + BLOW + OUT));
    if (seconds < STILL) return { act: 'still', words: 'Hold still. Let it burn alone', share };
    if (seconds < STILL + BLOW) {
      const on = seconds - STILL;
      const breath = BREATHS[Math.floor(on / ROUND) % BREATHS.length] as string;
      return { act: 'blow', words: on % ROUND < BREATH ? breath : 'And let it stand up again', share };
    }
    this.gone = state === 'gone' ? this.gone + passed : 0;
    const done = this.gone >= IS_OUT || seconds >= STILL + BLOW + OUT;
    return { act: done ? 'done' : 'out', words: 'Now blow it out!', share };
  }
}

/** Shares of the picture: nearer to its border is too near, lower than this is too small. */
const BORDER = 0.015;
const SMALL = 0.12;
const WHITE = 0.5;

/** What is wrong with the picture; '' nothing. */
export function hintOf(seen: Seen): string {
  const { box, width, height } = seen;
  if (box === null) return 'No flame is found yet. One flame before something dark, large in the picture.';
  if (seen.state === 'gone') return '';
  if ((seen.clipped ?? 0) > WHITE) return 'Too bright: the flame is white all over. Lower the exposure.';
  const near = Math.min(box.x / width, (width - box.x - box.width) / width, box.y / height);
  if (near < BORDER) return 'Too near the edge. Move the flame to the middle.';
  if (box.height / height < SMALL) return 'Go nearer: the flame is small in the picture.';
  if ((seen.flames ?? 1) > 1) return `There are ${seen.flames} flames. Drag a box around the one that you mean.`;
  return '';
}
