// Rates: of pictures, and of a table's rows.

import { element } from '../../panel/element.js';
import { button, panelOf } from './verdict.js';

/** Usual rate of cameras, Hz. */
const USUAL = 30;
const MOST = 1000;

/** Creates a field for a positive number, with its label. */
export function rateField(id: string, words: string, value: number | ''): { input: HTMLInputElement; label: HTMLElement } {
  const input = element('input', { type: 'number', min: '0.001', max: '1000000', step: 'any', value, id, inputmode: 'decimal' });
  return { input, label: element('label', { class: 'rate', for: id }, words, input) };
}

/** A field for the height of the wall in the picture, as positions are in metres and films have no scale. */
export function wallField(now: number, chosen: (metres: number) => void): HTMLElement {
  const { input, label } = rateField('wall-height', 'Metres of wall that the picture shows, top to bottom', now);
  input.addEventListener('change', () => { if (input.valueAsNumber >= 0.01 && input.valueAsNumber <= 100) chosen(input.valueAsNumber); });
  return label;
}

/** The footer of a panel with buttons to continue or go back. */
export const goOrBack = (go: HTMLButtonElement, back: () => void): HTMLElement => element('div', { class: 'actions' }, go, button('Back', 'back', back));

/** The panel that asks for the rate of numbered pictures; `go` receives it, Hz. */
export function ratePanel(name: string, pictures: number, go: (rate: number) => void, back: () => void): HTMLElement {
  const { input: rate, label } = rateField('pictures-rate', 'Pictures a second', USUAL);
  const look = button('Look at them', 'look', () => go(rate.valueAsNumber), true);
  const length = element('p', { class: 'quiet', role: 'status' });
  const check = (): void => {
    const good = rate.validity.valid && rate.valueAsNumber <= MOST && rate.valueAsNumber >= 1;
    look.disabled = !good;
    length.textContent = good ? `They last ${(pictures / rate.valueAsNumber).toFixed(1)} s.` : `Say a number from 1 to ${MOST}.`;
  };
  rate.addEventListener('input', check);
  check();
  const words = element('p', {}, `${name}: ${pictures.toLocaleString('en')} pictures. They do not say how fast they follow each other.`);
  return panelOf('How many pictures a second?', words, label, length, goOrBack(look, back));
}
