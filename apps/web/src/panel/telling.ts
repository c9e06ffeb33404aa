// A button that reports the result of its action.

import { button } from './element.js';

const STAYS = 4000;

/** `name`: data-file attribute; `meanwhile`: text during the action, '' for no change; `act` returns the final text. */
export function telling(words: string, name: string, meanwhile: string, act: () => string | Promise<string>): HTMLButtonElement {
  const tell = async (): Promise<void> => {
    if (meanwhile !== '') told.textContent = meanwhile;
    try {
      told.textContent = await act();
    } catch (error) {
      told.textContent = error instanceof Error ? error.message : String(error);
    }
    setTimeout(() => (told.textContent = words), STAYS);
  };
  const told = button(words, tell, { 'data-file': name });
  return told;
}
