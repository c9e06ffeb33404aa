// The first lines of a table: its separator, the names of its columns, which of them are numbers.

import type { Captured, Curve, Recipe, TableSettings } from '@wisp/studio';

/** Bytes that are looked at. */
const LOOKED_AT = 64_000;
const ROWS = 400;

export interface TableHead {
  names: string[];
  /** whether its cells are numbers, by column */
  numeric: boolean[];
  /** a recording in Wisp's own form: its roles are known */
  recording: boolean;
  /** nothing names its columns: these are its bytes with names */
  named: Uint8Array | null;
  /** the columns of numbers, row by row, as far as they were looked at */
  preview: Curve[];
}

function separatorOf(line: string): RegExp {
  if (line.includes('\t')) return /\t/;
  if (line.includes(';')) return /;/;
  if (line.includes(',')) return /,/;
  return /\s+/;
}

const cell = (text: string): string => text.trim().replace(/^"(.*)"$/, '$1');
/** What a cell says, with a comma or a point, and with exponents as Fortran writes them; NaN where it is no number. */
const numberOf = (text: string): number => (text === '' ? NaN : Number(text.replace(',', '.').replace(/d/i, 'e')));
const isNumber = (text: string): boolean => text === '' || /^(nan|na|n\/a)$/i.test(text) || Number.isFinite(numberOf(text));

/** A column of times, as its name says. */
const isTime = (name: string): boolean => /^(t|time|seconds?|sec|zeit|millis|ms)(?![a-z])/i.test(name);

/** Looks at the first lines. */
export function headOf(bytes: Uint8Array): TableHead {
  const text = new TextDecoder().decode(bytes.subarray(0, LOOKED_AT)).replace(/^\uFEFF/, '');
  const all = text.split(/\r?\n/).filter((line) => line.trim() !== '' && !/^sep=/i.test(line));
  const comments = all.filter((line) => /^[#%]/.test(line));
  const lines = all.filter((line) => !/^[#%]/.test(line)).slice(0, ROWS);
  const separator = separatorOf(lines[0] ?? '');
  const cells = lines.map((line) => line.trim().split(separator).map(cell));
  const first = cells[0] ?? [];
  const unnamed = first.length > 0 && first.every((name) => name !== '' && isNumber(name));
  const names = unnamed ? first.map((_, k) => `c${k + 1}`) : first;
  const rows = (unnamed ? cells : cells.slice(1)).filter((row) => row.length >= names.length);
  // The first row may say units.
  const numeric = names.map((_, k) => rows.some((row) => Number.isFinite(numberOf(row[k] ?? ''))) && rows.slice(1).every((row) => isNumber(row[k] ?? '')));
  return {
    names,
    numeric,
    recording: comments.some((line) => line.startsWith('# wisp-recording')),
    named: unnamed ? withNames(bytes, names, separator) : null,
    preview: names.flatMap((name, k) => (numeric[k] === true && !isTime(name) ? [columnOf(name, rows.map((row) => row[k] ?? ''))] : [])),
  };
}

function columnOf(name: string, cells: readonly string[]): Curve {
  const y = cells.map(numberOf);
  return { id: `column ${name}`, label: name, x_label: 'row', y_label: '', x: y.map((_, row) => row), y };
}

function withNames(bytes: Uint8Array, names: readonly string[], separator: RegExp): Uint8Array {
  const between = separator.source === '\\t' ? '\t' : separator.source === '\\s+' ? ' ' : separator.source;
  const head = new TextEncoder().encode(`${names.join(between)}\n`);
  const made = new Uint8Array(head.length + bytes.length);
  made.set(head);
  made.set(bytes, head.length);
  return made;
}

const POSITION = ['pos.x', 'pos.y', 'pos.z'];
const ORIENTATION = ['q.w', 'q.x', 'q.y', 'q.z'];

/** How to learn from films of falls: tilt counts where all of them have it. */
export function recipeOfFalls(captured: readonly Captured[]): Recipe {
  const tilt = captured.every(({ series }) => ORIENTATION.every((name) => series.some((one) => one.name === name)));
  return { kind: tilt ? 'leaf' : 'chain' };
}

/** How to learn from a table: as something that falls where it tells of that, else as what comes out of what goes in. */
export function recipeOfTable({ series }: Captured, { inputs, outputs }: TableSettings = {}): Recipe {
  const has = (name: string): boolean => series.some((one) => one.name === name && one.role === 'output');
  if (POSITION.every(has)) return { kind: ORIENTATION.every(has) ? 'leaf' : 'chain' };
  return { kind: 'arx', ...(inputs === undefined ? {} : { inputs }), ...(outputs === undefined ? {} : { outputs }) };
}

export type Role = 'input' | 'output' | 'ignored';

/** What a column is for, as its name suggests; null: it suggests nothing. */
function suggested(name: string, numeric: boolean): Role | null {
  if (!numeric || isTime(name) || /^(date|index|n|k)\b/i.test(name)) return 'ignored';
  if (/^(u|in|input|x|power|heat|voltage|wind|force|steam|fuel|valve)/i.test(name)) return 'input';
  if ([...POSITION, ...ORIENTATION].includes(name)) return 'output';
  return /^(y|out|output|temp|level|speed|angle|pos|v)/i.test(name) ? 'output' : null;
}

/** What the columns are for. Where some come out and none goes in, or the other way round, those without a telling name are the
 * others; but beside positions of something that falls. */
export function rolesOf({ names, numeric }: TableHead): Role[] {
  const roles = names.map((name, k) => suggested(name, numeric[k] === true));
  const [goesIn, comesOut] = [roles.includes('input'), roles.includes('output')];
  const rest = goesIn === comesOut || POSITION.every((name) => names.includes(name)) ? 'ignored' : goesIn ? 'output' : 'input';
  return roles.map((role) => role ?? rest);
}
