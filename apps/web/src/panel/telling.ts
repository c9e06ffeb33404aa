// A button that reports the result of its action.

import { button } from './element.js';

const STAYS = 4000;

/** `name`: data-file attribute; `meanwhile`: text until `act` returns the final one, '' for no change. */
export function telling(words: string, name: string, meanwhile: string, act: () => string | Promise<string>): HTMLButtonElement {
  let back: number | null = 0; // timer of the return to `words`; null during the action, when presses are ignored
  const tell = async (): Promise<void> => {
    if (back === null) return;
    clearTimeout(back);
    back = null;
    if (meanwhile !== '') told.textContent = meanwhile;
    try {
      told.textContent = await act();
    } catch (error) {
      told.textContent = error instanceof Error ? error.message : String(error);
    }
    back = window.setTimeout(() => (told.textContent = words), STAYS);
  };
  const told = button(words, tell, { 'data-file': name });
  return told;
}
