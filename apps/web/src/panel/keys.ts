// Keys of the page. Keys that blow act while held; others act once.

import { KeyBreath } from '@wisp/player/parts/air/keys';

/** Whether the focused element handles the pressed key itself. */
function keeps(target: EventTarget | null, event: KeyboardEvent): boolean {
  if (!(target instanceof HTMLElement)) return false;
  if (target.closest('dialog') !== null) return true;
  if (target instanceof HTMLInputElement || target instanceof HTMLSelectElement) {
    return event.code.startsWith('Arrow') || event.key.length === 1;
  }
  return (target instanceof HTMLButtonElement || target instanceof HTMLAnchorElement) && event.code === 'Space';
}

/** Listens to the keyboard while the page exists. `actions`: by KeyboardEvent.key, in lower case. */
export function listenToKeys({ held }: KeyBreath, actions: Readonly<Record<string, () => void>>, touched: () => void, single: () => boolean): void {
  window.addEventListener('keydown', (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || keeps(event.target, event)) return;
    if (KeyBreath.blows(event.code)) {
      event.preventDefault();
      held.add(event.code);
      return touched();
    }
    const action = actions[event.key.toLowerCase()];
    if (action === undefined || event.repeat || (event.key.length === 1 && !single())) return;
    event.preventDefault();
    action();
  });
  window.addEventListener('keyup', (event) => held.delete(event.code));
  window.addEventListener('blur', () => held.clear());
}
