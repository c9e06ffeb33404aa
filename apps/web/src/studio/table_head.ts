// First lines of a table: separator, names of columns, and which of them are numeric.

import type { Captured, Curve, Recipe, TableSettings } from '@wisp/studio';

/** Number of bytes examined. */
const LOOKED_AT = 64_000;
const ROWS = 400;

export interface TableHead {
  names: string[];
  numeric: boolean[];
  /** whether it is a Wisp recording, whose roles are known */
  recording: boolean;
  /** for a table without a header: its bytes with added names; else null */
  named: Uint8Array | null;
  /** numeric columns, row by row, of the examined lines */
  preview: Curve[];
}

const separatorOf = (line: string): RegExp => [/\t/, /;/, /,/].find((one) => one.test(line)) ?? /\s+/;

const cell = (text: string): string => text.trim().replace(/^"(.*)"$/, '$1');
/** Cells of a line. A separator within quotes, which an odd number of quotes follows, separates nothing. */
function cellsOf(line: string, separator: RegExp): string[] {
  const whole = separator.source === '\\s+' ? line.trim() : line.trimEnd();
  return whole.split(line.includes('"') ? new RegExp(`${separator.source}(?=(?:[^"]*"[^"]*")*[^"]*$)`) : separator).map(cell);
}
/** Value of a cell with decimal comma or point, and Fortran's exponents; NaN where it is no number. */
const numberOf = (text: string): number => (text === '' ? NaN : Number(text.replace(',', '.').replace(/d/i, 'e')));
const isNumber = (text: string): boolean => text === '' || /^(nan|na|n\/a)$/i.test(text) || Number.isFinite(numberOf(text));
/** Whether a cell is a date, a time of day, or both. */
const isDate = (text: string): boolean => /^\d{1,4}[-./]\d{1,2}[-./]\d{1,4}([ T]\d{1,2}:\d\d.*)?$|^\d{1,2}:\d\d(:\d\d.*)?$/.test(text);

/** Name of a column without role and unit, as the reader of tables splits it (src/record/csv_head.cpp). */
export const nameOf = (column: string): string => column.replace(/^(u|y|m|flag):/, '').replace(/\[.*\]$/, '').trim();

/** Whether a name suggests a column of times. */
const isTime = (name: string): boolean => /^(t|time|seconds?|sec|zeit|millis|ms)(?![a-z])/i.test(name);

export function headOf(bytes: Uint8Array): TableHead {
  const text = new TextDecoder().decode(bytes.subarray(0, LOOKED_AT)).replace(/^\uFEFF/, '');
  const all = text.split(/\r?\n/).filter((line) => line.trim() !== '' && !/^sep=/i.test(line));
  if (bytes.length > LOOKED_AT && all.length > 1) all.pop(); // the last line is cut off
  const comments = all.filter((line) => /^[#%]/.test(line));
  const lines = all.filter((line) => !/^[#%]/.test(line)).slice(0, ROWS);
  const separator = separatorOf((lines[0] ?? '').replace(/"[^"]*"/g, ''));
  const cells = lines.map((line) => cellsOf(line, separator));
  const first = cells[0] ?? [];
  const unnamed = first.some((name) => Number.isFinite(numberOf(name))) && first.every((name) => name !== '' && (isNumber(name) || isDate(name)));
  const names = unnamed ? first.map((text, k) => (!isDate(text) ? `c${k + 1}` : text.includes(':') ? 'time' : 'date')) : first;
  const rows = (unnamed ? cells : cells.slice(1)).filter((row) => row.length >= names.length);
  // The first row may contain units, so it may be non-numeric.
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
  const rows = bytes.subarray(bytes[0] === 0xef ? 3 : 0); // without a byte order mark
  const made = new Uint8Array(head.length + rows.length);
  made.set(head);
  made.set(rows, head.length);
  return made;
}

const POSITION = ['pos.x', 'pos.y', 'pos.z'];
const ORIENTATION = ['q.w', 'q.x', 'q.y', 'q.z'];

/** Recipe for films of falls: a leaf model if all films have orientations, else a chain of positions. */
export function recipeOfFalls(captured: readonly Captured[]): Recipe {
  const tilt = captured.every(({ series }) => ORIENTATION.every((name) => series.some((one) => one.name === name)));
  return { kind: tilt ? 'leaf' : 'chain' };
}

/** Recipe for a table: falling motion where it has positions, else an ARX model from inputs to outputs. */
export function recipeOfTable({ series }: Captured, { inputs, outputs }: TableSettings = {}): Recipe {
  const has = (name: string): boolean => series.some((one) => one.name === name && one.role === 'output');
  if (POSITION.every(has)) return { kind: ORIENTATION.every(has) ? 'leaf' : 'chain' };
  return { kind: 'arx', ...(inputs === undefined ? {} : { inputs }), ...(outputs === undefined ? {} : { outputs }) };
}

type Role = 'input' | 'output' | 'ignored';

/** Role of a column suggested by its name; null: none. */
function suggested(name: string, numeric: boolean): Role | null {
  if (!numeric || isTime(name) || /^$|^(date|index|n|k)\b/i.test(name)) return 'ignored';
  if (/^(u|in|input|x|power|heat|voltage|wind|force|steam|fuel|valve)/i.test(name)) return 'input';
  if ([...POSITION, ...ORIENTATION].includes(name)) return 'output';
  return /^(y|out|output|temp|level|speed|angle|pos|v)/i.test(name) ? 'output' : null;
}

/** Roles of columns. Where only outputs or only inputs have telling names, the other columns get the other role,
 * unless there are positions of a falling object. */
export function rolesOf({ names, numeric }: TableHead): Role[] {
  const roles = names.map((name, k) => suggested(name, numeric[k] === true));
  const [goesIn, comesOut] = [roles.includes('input'), roles.includes('output')];
  const rest = goesIn === comesOut || POSITION.every((name) => names.map(nameOf).includes(name)) ? 'ignored' : goesIn ? 'output' : 'input';
  return roles.map((role) => role ?? rest);
}
