// Instructions for filming: the next action, and problems of the picture.

import type { Seen } from '@wisp/studio';

/** Actions, in order. */
type Act = 'still' | 'blow' | 'out' | 'drop' | 'done';

/** Subject: a flame with or without sound, or falling objects. */
type Filmed = 'flame' | 'mute flame' | 'falls';

/** Actions of each subject, with their words and maximum seconds. Without sound, blowing is left out. */
const PLANS: Readonly<Record<Filmed, readonly (readonly [act: Act, words: string, seconds: number])[]>> = {
  falls: [['drop', 'Drop it, let it land, and again', 60]],
  'mute flame': [['still', 'Hold still, let it flicker', 20]],
  flame: [['still', 'Hold still, let it burn alone', 4], ['blow', 'Blow softly from the side, with pauses', 16], ['out', 'Blow it out', 9]],
};

/** Seconds without a flame, during blowing out, after which it counts as extinguished. */
const IS_OUT = 1.2;
/** Seconds of a breath with its rest, and the part that is breath. */
const ROUND = 4;
const BREATH = 2;

const BREATHS = ['Blow softly, from the side', 'Softly again', 'A little harder', 'Softly once more'];

export class Guide {
  readonly plan: (typeof PLANS)[Filmed];
  private gone = 0;
  private last = 0;

  constructor(private readonly filmed: Filmed) { this.plan = PLANS[filmed]; }

  /**
   * Returns the action at a number of seconds after the start, and the finished share of the filming, 0 to 1. `falls`:
   * number of falls seen so far.
   */
  at(seconds: number, state: Seen['state'] | null, falls: number): { act: Act; words: string; share: number } {
    const passed = seconds - this.last;
    this.last = seconds;
    let act: Act = 'still';
    let [begun, end] = [0, 0];
    for (const [name, , lasts] of this.plan) {
      if (seconds >= end) [act, begun] = [name, end];
      end += lasts;
    }
    this.gone = act === 'out' && state === 'gone' ? this.gone + passed : 0;
    const done = this.gone >= IS_OUT || seconds >= end;
    return { act: done ? 'done' : act, words: this.wordsOf(act, seconds - begun, falls), share: Math.min(1, seconds / end) };
  }

  /** Returns the words for an action that began some seconds ago. */
  private wordsOf(act: Act, seconds: number, falls: number): string {
    if (act === 'drop') return wordsOfFalls(falls);
    if (act === 'out') return 'Now blow it out!';
    if (act === 'still') return this.filmed === 'flame' ? 'Hold still. Let it burn alone' : 'Hold still. Let it flicker';
    return seconds % ROUND < BREATH ? (BREATHS[Math.floor(seconds / ROUND) % BREATHS.length] as string) : 'And let it stand up again';
  }
}

/** Minimum number of falls for learning. */
const ENOUGH_FALLS = 12;

function wordsOfFalls(falls: number): string {
  if (falls === 0) return 'Drop it before the wall';
  return `${falls === 1 ? '1 fall' : `${falls} falls`}. ${falls < ENOUGH_FALLS ? 'And again' : 'Enough, or a few more'}`;
}

/** A fall: minimum descent as a share of the picture's height, and seconds without motion that end it. */
const FALLEN = 0.35;
const LANDED = 0.25;

/** Counts falls during filming, for display; the capture detects them again at the end. */
export class FallCount {
  falls = 0;
  private from: number | null = null;
  private to = 0;
  private last = 0;

  /** Takes the findings at a number of seconds after the start. */
  see({ moving, height }: Seen, seconds: number): void {
    if (moving !== null) {
      const middle = moving.y + moving.height / 2;
      this.from ??= middle;
      this.to = Math.max(this.to, middle);
      this.last = seconds;
    } else if (this.from !== null && seconds - this.last > LANDED) {
      if (this.to - this.from > FALLEN * height) this.falls += 1;
      this.from = null;
      this.to = 0;
    }
  }
}

/** Share of the picture above which a moving region means that the camera moves. */
const SHAKEN = 0.4;

/** Problem of a picture in which something should fall; '' if none. */
export const hintOfFalls = ({ moving, width, height }: Seen): string =>
  moving !== null && moving.width * moving.height > SHAKEN * width * height ? 'Almost all of the picture moves. Let the camera lie still, before a plain wall.' : '';

/** Shares of the picture: minimum distance to its border, minimum height; maximum saturated share of the flame. */
const BORDER = 0.015;
const SMALL = 0.12;
const WHITE = 0.5;

/** Problem of the picture; '' if none. */
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
