// A table: which columns go in, which come out, how often a row comes.

import type { TableSettings } from '@wisp/studio';
import { element } from '../../panel/element.js';
import { goOrBack, rateField } from './rate.js';
import { rolesOf, type TableHead } from '../table_head.js';

const ROLES = ['input', 'output', 'ignored'] as const;
const WORDS = { input: 'goes in', output: 'comes out', ignored: 'ignored' } as const;

/** The panel. `learn` is called with what was chosen. */
export function tablePanel(name: string, head: TableHead, learn: (settings: TableSettings) => void, back: () => void): HTMLElement {
  const roles = rolesOf(head);
  const rows = element('div', { class: 'columns' });
  const { input: rate, label } = rateField('table-rate', 'Rows a second', head.rate ?? 1);
  const go = element('button', { type: 'button', class: 'tool main', 'data-act': 'learn' }, 'Learn it');
  const trouble = element('p', { class: 'quiet', role: 'status' });
  const unsaid = head.rate === null ? [element('p', { class: 'quiet' }, 'The table does not say how often a row comes. At 1 a second, time is counted in rows.')] : [];
  const check = (): void => {
    const missing = !roles.includes('output') ? 'Say which column comes out.' : !(rate.valueAsNumber > 0) ? 'Say how many rows a second there are.' : '';
    go.disabled = missing !== '';
    trouble.textContent = missing;
  };
  head.names.forEach((column, k) => {
    const group = element('div', { class: 'choice', role: 'group', 'aria-label': column }, element('span', {}, column));
    for (const role of ROLES) {
      const made = element('button', { type: 'button', 'aria-pressed': String(roles[k] === role), 'data-column': `${column} ${role}` }, WORDS[role]);
      made.disabled = head.numeric[k] !== true && role !== 'ignored';
      made.addEventListener('click', () => {
        roles[k] = role;
        for (const one of group.querySelectorAll('button')) one.setAttribute('aria-pressed', String(one === made));
        check();
      });
      group.append(made);
    }
    rows.append(group);
  });
  rate.addEventListener('input', check);
  go.addEventListener('click', () => {
    const named = (role: (typeof ROLES)[number]): string[] => head.names.filter((_, k) => roles[k] === role);
    learn({ rate: rate.valueAsNumber, inputs: named('input'), outputs: named('output') });
  });
  check();
  return element(
    'div',
    { class: 'panel' },
    element('h2', { tabindex: '-1' }, 'What goes in, what comes out?'),
    element('p', {}, `${name}: say what each column is. What comes out is learned from its own past and from what went in.`),
    rows,
    label,
    ...unsaid,
    trouble,
    goOrBack(go, back),
  );
}
