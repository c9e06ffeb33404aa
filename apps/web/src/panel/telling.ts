// A button that reports the result of its action.

import { element } from './element.js';

const STAYS = 4000;

/** `name`: accessible name; `meanwhile`: text during the action, '' for no change; `act` returns the final text. */
export function telling(words: string, name: string, meanwhile: string, act: () => Promise<string>): HTMLButtonElement {
  const button = element('button', { type: 'button', class: 'tool', 'data-file': name }, words);
  button.addEventListener('click', () => {
    if (meanwhile !== '') button.textContent = meanwhile;
    void act()
      .catch((error: unknown) => (error instanceof Error ? error.message : String(error)))
      .then((said) => {
        button.textContent = said;
        setTimeout(() => (button.textContent = words), STAYS);
      });
  });
  return button;
}
