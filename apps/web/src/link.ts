// The part of a link after its #: scene, seed and settings, which are stored nowhere else.

import { MAX_CANDLES } from '@wisp/player/parts/candle/room';
import { MAX_LEAVES } from '@wisp/player/parts/leaves/limits';

export type SceneName = 'candle' | 'leaves';

export const DEFAULTS = {
  scene: 'candle' as SceneName,
  /** seed of all random streams */
  seed: 1,
  /** scale of the learned noise, 0 to 2 */
  noise: 1,
  candles: 1,
  leaves: 400,
  /** drawn pixels per CSS pixel, up to 2; 0: as many as stay smooth */
  detail: 0,
  /** model in place of the shipped one: an address of this origin, or the packed model (model_link.ts); '': shipped */
  model: '',
  /** age shown on the cake as digit candles; 0: ordinary candles */
  age: 0,
  /** recipient and sender of the cake, and text written by smoke when all candles are out */
  name: '',
  from: '',
  wish: '',
  /** 1: offers a tune */
  tune: 0,
};

export type Settings = typeof DEFAULTS;

export { MAX_CANDLES, MAX_LEAVES };
/** Maximum number of letters of each text. */
export const LETTERS = { name: 24, from: 24, wish: 80 } as const;

const RANGES: Readonly<Record<Exclude<keyof Settings, 'scene' | 'model' | keyof typeof LETTERS>, readonly [number, number, boolean]>> = {
  seed: [0, 2 ** 32 - 1, true],
  noise: [0, 2, false],
  candles: [1, MAX_CANDLES, true],
  age: [0, 999, true],
  tune: [0, 1, true],
  leaves: [1, MAX_LEAVES, true],
  detail: [0, 2, false],
};

/** Returns a text in one line, cut to `most` letters. */
export const shortened = (words: string, most: number): string => [...words.replace(/\s+/g, ' ').trim()].slice(0, most).join('');

/** Reads settings from a link's hash. Missing, unknown or out-of-range values are those of `otherwise`. */
export function settingsFromLink(hash: string, otherwise: Readonly<Settings> = DEFAULTS): Settings {
  const given = new URLSearchParams(hash.replace(/^#/, ''));
  const settings: Settings = { ...otherwise };
  const scene = given.get('scene');
  if (scene === 'candle' || scene === 'leaves') settings.scene = scene;
  settings.model = given.get('model') ?? otherwise.model;
  for (const [name, most] of Object.entries(LETTERS) as [keyof typeof LETTERS, number][]) settings[name] = shortened(given.get(name) ?? otherwise[name], most);
  for (const [name, [low, high, whole]] of Object.entries(RANGES)) {
    const text = given.get(name);
    const value = text === null || text.trim() === '' ? NaN : Number(text);
    if (!(value >= low && value <= high) || (whole && !Number.isInteger(value))) continue;
    settings[name as keyof typeof RANGES] = value;
  }
  return settings;
}

/** Whether a transparent overlay is requested, to lie over a film or stream. */
export const isOverlay = (hash: string): boolean => new URLSearchParams(hash.replace(/^#/, '')).has('overlay');

/**
 * Returns the shortest link to these settings, from its # on. `own`: this visitor's initial settings, which are left
 * out as personal preferences.
 */
export function linkOf(settings: Readonly<Settings>, own: Readonly<Settings> = DEFAULTS): string {
  const given = new URLSearchParams();
  for (const [name, value] of Object.entries(settings) as [keyof Settings, unknown][]) {
    if (value !== DEFAULTS[name] && value !== own[name]) given.set(name, String(value));
  }
  // Scene and seed are always included, since they are the purpose of the link.
  given.set('scene', settings.scene);
  given.set('seed', String(settings.seed));
  return `#${given.toString()}`;
}
