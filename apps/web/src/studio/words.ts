// Reports in words: verdict, quality, and what to film for improvement.

import type { Captured, Learned, Report } from '@wisp/studio';

/** A value at a path in a report; undefined if missing. */
export function within(report: Report, ...path: string[]): unknown {
  let at: unknown = report;
  for (const name of path) at = typeof at === 'object' && at !== null ? (at as Record<string, unknown>)[name] : undefined;
  return at;
}

/** A finite number at a path in a report; null if missing. */
export const figure = (report: Report, ...path: string[]): number | null => {
  const value = within(report, ...path);
  return typeof value === 'number' && Number.isFinite(value) ? value : null;
};

/** Makes a sentence: a capital first (except in file names) and a full stop last. */
export function sentence(words: string): string {
  const said = words.trim();
  if (said === '') return '';
  const first = /^\S+\.\w{2,4}\b/.test(said) ? said[0] : said[0]?.toUpperCase();
  return `${first ?? ''}${said.slice(1)}${/[.!?]$/.test(said) ? '' : '.'}`;
}

/** A sentence of the program with its flags replaced by the page's terms. */
export const inPage = (words: string): string => sentence(words.replace('--rate HZ or --dt S', 'how many rows a second there are'));

/** Remedies by kind of remark, in place of the program's where those name its flags. */
const CURES: Readonly<Record<number, string>> = {
  8: 'Delays are found while it learns',
  9: 'Let the change from row to row be what comes out',
  10: 'Take the straight line off, add a column that tells what drifts, or give a part of the rows',
};

/** Defects of a table that will harm a model, each with its remedy. */
export function remarksOf({ report }: Captured): string[] {
  const remarks = report.remarks as { kind: number; cause: string; cure: string }[];
  return remarks.map(({ kind, cause, cure }) => `${sentence(cause)} ${inPage(CURES[kind] ?? cure)}`);
}

/** Length of a table, and source of its rate. */
export const rowsOf = ({ rows, rate, why }: Captured): string =>
  sentence(`${rows.toLocaleString('en')} rows, ${Number(rate.toPrecision(6))} a second${why === '' ? '' : ` (${why})`}`);

export interface Verdict {
  good: boolean;
  /** summary in a few words */
  title: string;
  reason: string;
}

/** Subject of learning: a flame, a table's outputs from its inputs, or a fall. */
export type Thing = 'flame' | 'table' | 'fall';

const LEARNED: Readonly<Record<Thing, string>> = { flame: 'It learned your flame', table: 'It learned how this behaves', fall: 'It learned how this falls' };

/** Whether a table's model has inputs. Without them its free play has a phase of its own, and does not follow the rows. */
const isDriven = (report: Report): boolean => within(report, 'operating_point', 'inputs', 'length') !== 0;

/** Percent: a table's model is refused if no output's fit on held-out rows is above this. */
const FOLLOWS = 5;

/** Verdict on a film or another recording. */
export function foundIn({ report }: Captured, thing: Thing): Verdict {
  const good = report.usable?.verdict !== false;
  const title = thing === 'fall' ? (good ? 'The falls are found' : 'The falls are not seen well') : good ? 'The flame is found' : 'The flame is not seen well';
  return { good, title, reason: sentence(report.usable?.reason ?? '') };
}

/** Reason and remedy of a refused flame model, by the report's code. */
const REFUSED: Readonly<Record<string, string>> = {
  short: 'The film is too short: flicker cannot be told from chance yet. Film half a minute.',
  noise: 'The outline jumps more than a flame does. Film it larger and sharper, before something dark.',
  clamped: 'Played freely it runs away from what was filmed. Film longer, with breaths and pauses.',
  still: 'Played freely it moves much less than your flame. Leave out what is not like the rest, or film once more.',
  wild: 'Played freely it moves much more than your flame. Film longer, so that calm has its share.',
  crossed: 'Played freely its outline crosses itself. Film the flame larger in the picture.',
  foreign: 'It plays shapes that your flame never had. Film longer.',
  unlike: 'It moves from shape to shape unlike your flame. Film longer, with the camera still.',
  deaf: 'It does not follow the wind that was heard. Blow close to the microphone, from the side, with pauses.',
  capture: 'A model is no better than its film, and the flame is not seen well in this one.',
};

/** Abilities of a usable flame model, in a sentence or two. */
function praiseOf(report: Report): string {
  const inputs = within(report, 'inputs');
  const tip = Array.isArray(inputs) && inputs.length > 0 ? (figure(report, 'tip', 'held_out_fit_percent', 'inf') ?? figure(report, 'tip', 'fit_percent', 'inf')) : null;
  const follows = tip === null ? 'It flickers as your flame did.' : `In the wind of your film it leans as your flame did (${Math.round(tip)} % of the tip’s way).`;
  const modes = within(report, 'extinction', 'modes');
  const own = (name: string): boolean => Array.isArray(modes) && (modes as Report[]).some((mode) => mode.name === name && mode.source === 'recorded');
  const lacks = [own('dying') ? '' : 'goes out', own('catching') ? '' : 'catches fire'].filter(Boolean).join(' and how it ');
  const borrowed = Array.isArray(modes) && lacks !== '' ? `How it ${lacks} was not filmed: that is borrowed from a simulated candle.` : '';
  return `${follows} ${borrowed}`.trim();
}

export function verdictOf({ report, judged }: Learned, thing: Thing): Verdict {
  const fits = judged === undefined ? [] : judgedFits(judged.report).map(({ free }) => free);
  const lost = thing === 'table' && isDriven(report) && fits.length > 0 && fits.every((fit) => !(fit > FOLLOWS));
  const good = report.usable?.verdict === true && !lost;
  const reason = lost && report.usable?.verdict === true ? 'it fits the rows that it was learned from, but on those that were kept back it follows nothing that comes out' : (report.usable?.reason ?? '');
  const own = thing !== 'flame' ? '' : good ? praiseOf(report) : (REFUSED[report.usable?.code ?? ''] ?? '');
  return { good, title: good ? LEARNED[thing] : 'This is not enough to learn from', reason: own === '' ? sentence(reason) : own };
}

/** Fit in percent of a table's outputs on held-out rows: one row ahead, and from inputs alone. */
function judgedFits(report: Report): { name: string; next: number; free: number }[] {
  const channels = within(report, 'channels');
  if (!Array.isArray(channels)) return [];
  const fit = (channel: Report, steps: string): number => figure(channel, 'fit_percent', steps) ?? NaN;
  return (channels as Report[]).map((one) => ({ name: String(one.name), next: fit(one, '1'), free: fit(one, 'inf') }));
}

/** A figure as a bar: its filled share, and the share from which it is good. */
export interface Meter { words: string; share: number; good: number; value: string }

/** Maximum number of a table's outputs with bars. */
const MAX_OUTPUTS = 4;

/** Quality figures, on held-out data where there are any. `outputs`: names of a table's outputs. */
export function metersOf({ report, judged }: Learned, thing: Thing, outputs: readonly string[]): Meter[] {
  const made: Meter[] = [];
  const add = (words: string, share: number | null, good: number): void => {
    if (share !== null && !Number.isNaN(share)) made.push({ words, share: Math.max(0, Math.min(1, share)), good, value: `${Math.round(100 * share)} %`.replace('-', '−') });
  };
  const percent = (...path: string[]): number | null => {
    const value = figure(report, ...path);
    return value === null ? null : value / 100;
  };
  if (thing === 'fall') {
    // 1: play and recording differ as the recording's two halves do; 0: as the recording and its rows in random order.
    const near = (...name: string[]): number | null => {
      const [value, floor, ceiling] = ['value', 'floor', 'ceiling'].map((one) => figure(report, 'fidelity', ...name, one));
      return value == null || floor == null || ceiling == null || !(ceiling > floor) ? null : 1 - Math.max(0, value - floor) / (ceiling - floor);
    };
    add('A moment of it is like the recorded ones', near('energy_distance'), 0.9);
    add('Two seconds are', near('two_seconds'), 0.9);
    add('It spreads as it did', near('spread'), 0.9);
    return made;
  }
  // Without wind, free play has its own phase and does not follow the film: only the next frame is judged.
  const inputs = within(report, 'inputs');
  if (Array.isArray(inputs) && inputs.length > 0) {
    add('The tip, a frame ahead', percent('tip', 'held_out_fit_percent', '1'), 0.5);
    add('The tip, played freely in the same wind', percent('tip', 'held_out_fit_percent', 'inf'), 0.5);
    add('Outlines that lie over each other', figure(report, 'overlap'), 0.85);
  } else add('Outlines that lie over each other, a frame ahead', figure(report, 'overlap_by_steps', '1'), 0.85);
  if (thing === 'flame') return made;
  const kept = judged === undefined ? [] : judgedFits(judged.report);
  const fit = (steps: string, k: number): number => figure(report, 'fit_percent', steps, String(k)) ?? NaN;
  const fits = kept.length > 0 ? kept : outputs.map((name, k) => ({ name, next: fit('1', k), free: fit('inf', k) }));
  for (const { name, next, free } of fits.slice(0, MAX_OUTPUTS)) {
    add(`${name}, a row ahead`, next / 100, 0.5);
    if (isDriven(report)) add(`${name}, played from what goes in alone`, free / 100, 0.4);
  }
  return made;
}

/** Whether data were held out for judging. */
export const isHeldOut = (report: Report): boolean => (figure(report, 'samples', 'held_out') ?? 0) > 0;

/** Minimum seconds of film; the guide's half minute is slightly less where a camera starts late. */
const ENOUGH = 25;

/** Suggestions of what to film for improvement: at most three, the most effective first. */
export function adviceOf(captured: readonly Captured[], report: Report | null): string[] {
  const seconds = captured.reduce((sum, { rows, rate }) => sum + rows / rate, 0);
  const windy = captured.some(({ series }) => series.some(({ role }) => role === 'input'));
  const heard = captured.some((one) => within(one.report, 'wind', 'heard') === true);
  const out = captured.some((one) => figure(one.report, 'out_at') !== null) || (report !== null && within(report, 'extinction', 'source') === 'learned');
  const white = captured.some((one) => (figure(one.report, 'clipped') ?? 0) > 0.5);
  const unseen = captured.some((one) => one.report.usable?.verdict === false);
  return [
    !windy && 'Film with sound, and blow close to the microphone: without it only the flicker can be learned, not what wind does.',
    windy && !heard && 'Hardly any wind was heard. Blow closer to the microphone, from the side, with pauses.',
    seconds < ENOUGH && `Only ${Math.round(seconds)} s were filmed. Forty, with a soft breath from the side now and then, make it surer.`,
    report !== null && windy && !out && 'It has not been seen to go out. Blow it out once or twice while you film, and light it again.',
    white && 'The flame is white all over. Lower the exposure until its edge has a colour.',
    unseen && 'Let the flame stand alone before something dark, large in the picture, and keep the camera still.',
  ].filter((words) => words !== false).slice(0, 3);
}

const CAPTURING: Readonly<Record<Thing | 'either', string>> = {
  flame: 'Following the edge of the flame, picture by picture.',
  fall: 'Watching what moves before the wall, picture by picture.',
  either: 'Watching what is bright and what moves, picture by picture.',
  table: 'Reading the table.',
};

const STAGES: Readonly<Record<string, string>> = {
  learning: 'Finding out what each point does next, and what the wind does to it.',
  'searching orders': 'Finding out how far back it has to remember.',
  'finding delays': 'Finding out how late it answers.',
  fitting: 'Fitting what each point of the outline does next.',
  simulating: 'Playing it freely, beside the film.',
  predicting: 'Predicting seconds that it has never seen.',
  'testing residuals': 'Looking whether anything is left that could be learned.',
};

export const stageInWords = (stage: string, thing: Thing | 'either' = 'flame'): string =>
  stage === 'capturing' ? CAPTURING[thing] : (STAGES[stage] ?? sentence(stage));
