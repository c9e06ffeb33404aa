// Names, units and good ranges of the figures in a model's file.

/** `good`: range of good values; empty where none is better than another. */
interface Kind { words: string; unit: (value: number) => string; good: string }

/** Formats a number: integers in full, below 0.001 as two digits and a power of ten, others in `digits` digits. */
export function number(value: number, digits = 3): string {
  if (Number.isInteger(value)) return value.toLocaleString('en');
  const size = Math.abs(value);
  if (size > 0 && size < 1e-3) return value.toExponential(1).replace('e-', ' × 10⁻').replace(/⁻(\d+)/, (_, power: string) => `⁻${[...power].map((k) => '⁰¹²³⁴⁵⁶⁷⁸⁹'[Number(k)]).join('')}`);
  return value.toLocaleString('en', { maximumSignificantDigits: digits }).replace('-', '−');
}

const percent = (value: number): string => `${number(value)} %`;
const share = (value: number): string => percent(100 * value);
const seconds = (value: number): string => `${number(value)} s`;
const plain = (value: number): string => number(value);

const KINDS: Readonly<Record<string, Kind>> = {
  fpe: { words: 'Expected squared error of a step', unit: plain, good: 'small beside 1' },
  radius: { words: 'Largest pole', unit: plain, good: 'below 1: it calms down by itself' },
  rows_learned: { words: 'Frames learned from', unit: plain, good: 'a thousand or more' },
  rows_held_out: { words: 'Frames kept back to judge by', unit: plain, good: 'a few hundred or more' },
  held_share: { words: 'Steps clamped to the range seen', unit: share, good: 'below 1 %' },
  sd_ratio: { words: 'Movement played, of that recorded', unit: share, good: 'near 100 %' },
  crossed_share: { words: 'Outlines that cross themselves', unit: share, good: 'none' },
  outside_share: { words: 'Shapes that the recording has not', unit: share, good: 'at most 3 %' },
  pixels_per_unit: { words: 'Height of the flame in the film', unit: (value) => `${number(value)} px`, good: '100 px or more' },
  play_distance: { words: 'Energy distance of free play from the recording', unit: plain, good: 'well below that of shuffled frames' },
  'play_distance.shuffled': { words: 'Energy distance of shuffled frames', unit: plain, good: '' },
  segments: { words: 'Pieces of recorded motion', unit: plain, good: 'hundreds or more' },
  mean_segment_seconds: { words: 'Mean length of a piece', unit: seconds, good: '' },
  silhouette: { words: 'How distinct the kinds of motion are (silhouette)', unit: plain, good: 'above 0; 1 at most' },
  log_likelihood: { words: 'Log likelihood of what followed, a piece', unit: plain, good: 'nearer to 0' },
  energy_distance: { words: 'Energy distance from the recording', unit: plain, good: 'near that between two recordings' },
  energy_distance_floor: { words: 'Energy distance between two recordings', unit: plain, good: '' },
  descent_speed: { words: 'Speed of descent', unit: (value) => `${number(value)} m/s`, good: 'as recorded' },
  descent_speed_recorded: { words: 'Speed of descent, recorded', unit: (value) => `${number(value)} m/s`, good: '' },
  verbatim_seconds: { words: 'Longest stretch repeated word for word', unit: seconds, good: 'below a second' },
  gust_fit_percent: { words: 'Fit of the response to gusts', unit: percent, good: '50 % or more' },
  gust_direction_degrees: { words: 'Error of direction in gusts', unit: (value) => `${number(value)}°`, good: 'below 20°' },
};

/** Figures for several horizons: a full stop and the frames ahead, or inf, follow the name. */
const AHEAD: Readonly<Record<string, Kind>> = {
  fit: { words: 'Fit of the outline', unit: percent, good: '50 % or more; 0 % is its mean' },
  tip_fit: { words: 'Fit of the tip', unit: percent, good: '50 % or more; 0 % is its mean' },
  overlap: { words: 'Overlap of the outlines', unit: share, good: '85 % or more' },
};

function horizon(steps: string): string {
  if (steps === 'inf') return 'played freely in the same wind';
  return steps === '1' ? 'one frame ahead' : `${steps} frames ahead`;
}

/** Describes a figure; unknown ones keep their own name. */
export function inWords(name: string, value: number): Record<'words' | 'value' | 'good', string> {
  const [base, steps] = name.split('.') as [string, string | undefined];
  const kind = AHEAD[base] ?? KINDS[name];
  if (kind === undefined) return { words: name.replaceAll('_', ' ').replaceAll('.', ', '), value: number(value), good: '' };
  const words = base in AHEAD && steps !== undefined ? `${kind.words}, ${horizon(steps)}` : kind.words;
  return { words, value: kind.unit(value), good: kind.good };
}
