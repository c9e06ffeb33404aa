// Panel of a table: inputs, outputs, rate, and defects that will harm a model.

import type { TableSettings } from '@wisp/studio';
import { element } from '../../panel/element.js';
import { goOrBack, rateField } from './rate.js';
import type { Room } from '../room.js';
import { nameOf, rolesOf, type TableHead } from '../table_head.js';
import { inPage, remarksOf, rowsOf } from '../words.js';
import { button, choice, list, panelOf } from './verdict.js';

const ROLES = ['input', 'output', 'ignored'] as const;
const WORDS = { input: 'goes in', output: 'comes out', ignored: 'ignored' } as const;

/** Milliseconds after a choice until the table is examined again. */
const SETTLED_MS = 200;

export function tablePanel(name: string, bytes: Uint8Array, head: TableHead, room: Room): HTMLElement {
  const roles = rolesOf(head);
  const rows = element('div', { class: 'columns' });
  const { input: rate, label } = rateField('table-rate', 'Rows a second', '');
  const go = button('Learn it', 'learn', () => void room.tabled(name, bytes, chosen()), true);
  const trouble = element('p', { class: 'quiet', role: 'status' });
  const found = element('div', { 'data-advice': true, 'aria-live': 'polite' });
  let [said, looks, waiting] = [false, 0, 0];
  const chosen = (): TableSettings => {
    const named = (role: (typeof ROLES)[number]): string[] => head.names.filter((_, k) => roles[k] === role).map(nameOf);
    return { ...(said ? { rate: rate.valueAsNumber } : {}), inputs: named('input'), outputs: named('output') };
  };
  const look = async (): Promise<void> => {
    const turn = ++looks;
    const advice = await room.advise(name, bytes, chosen()).catch((error: unknown) => inPage(error instanceof Error ? error.message : String(error)));
    if (turn !== looks) return;
    if (typeof advice === 'string') return found.replaceChildren(element('p', { class: 'warning' }, advice));
    if (!said) rate.value = String(Number(advice.rate.toPrecision(6)));
    found.replaceChildren(element('p', { class: 'quiet' }, rowsOf(advice)), ...list('What will spoil a model', remarksOf(advice), 'warnings'));
  };
  const check = (): void => {
    const missing = !roles.includes('output') ? 'Say which column comes out.' : said && !(rate.valueAsNumber > 0) ? 'Say how many rows a second there are.' : '';
    go.disabled = missing !== '';
    trouble.textContent = missing;
    clearTimeout(waiting);
    if (missing === '') waiting = window.setTimeout(() => void look(), SETTLED_MS);
  };
  head.names.forEach((column, k) => {
    const take = (role: (typeof ROLES)[number]): void => {
      roles[k] = role;
      group.querySelectorAll('button').forEach((one, at) => one.setAttribute('aria-pressed', String(ROLES[at] === role)));
      check();
    };
    const barred = (role: string): boolean => head.numeric[k] !== true && role !== 'ignored';
    const words = head.numeric[k] === true ? column : `${column} (not all of it is numbers)`;
    const group = choice(words, ROLES.map((role) => {
      const pressed = String(roles[k] === role);
      return [WORDS[role], { 'aria-pressed': pressed, 'data-column': `${column} ${role}`, disabled: barred(role), click: () => take(role) }];
    }));
    rows.append(group);
  });
  rate.addEventListener('input', () => {
    said = true;
    check();
  });
  check();
  const words = element('p', {}, `${name}: say what each column is. What comes out is learned from its own past and from what went in.`);
  return panelOf('What goes in, what comes out?', words, rows, label, found, trouble, goOrBack(go, () => room.back()));
}
