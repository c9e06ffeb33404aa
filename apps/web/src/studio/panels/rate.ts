// Pictures: how many a second.

import { element } from '../../panel/element.js';

/** What cameras mostly do. */
const USUAL = 30;

/** The panel. `go` is called with what was said. */
export function ratePanel(name: string, pictures: number, go: (rate: number) => void, back: () => void): HTMLElement {
  const rate = element('input', { type: 'number', min: '1', max: '1000', step: 'any', value: USUAL, id: 'pictures-rate', inputmode: 'decimal' });
  const look = element('button', { type: 'button', class: 'tool main', 'data-act': 'look' }, 'Look at them');
  const length = element('p', { class: 'quiet', role: 'status' });
  const check = (): void => {
    const good = rate.validity.valid && rate.valueAsNumber > 0;
    look.disabled = !good;
    length.textContent = good ? `They last ${(pictures / rate.valueAsNumber).toFixed(1)} s.` : 'Say a number from 1 to 1000.';
  };
  rate.addEventListener('input', check);
  look.addEventListener('click', () => go(rate.valueAsNumber));
  const returns = element('button', { type: 'button', class: 'tool' }, 'Back');
  returns.addEventListener('click', back);
  check();
  return element(
    'div',
    { class: 'panel' },
    element('h2', { tabindex: '-1' }, 'How many pictures a second?'),
    element('p', {}, `${name}: ${pictures.toLocaleString('en')} pictures. They do not say how fast they follow each other.`),
    element('label', { class: 'rate', for: 'pictures-rate' }, 'Pictures a second', rate),
    length,
    element('div', { class: 'actions' }, look, returns),
  );
}
