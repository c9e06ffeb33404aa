// A button that says how it went.

import { element } from './element.js';

const STAYS = 4000;

/** `name`: for whom looks for it; `meanwhile`: what it says while it works, '' for nothing else; `act` says how it went. */
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
