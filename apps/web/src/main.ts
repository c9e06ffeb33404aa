// Entry point of the page.

import { loadLibrary } from '@wisp/player/parts/library';
import { App } from './app.js';
import { DEFAULTS, isOverlay, settingsFromLink } from './link.js';

/** For visitors who prefer reduced motion: a calmer flame, fewer leaves. Not part of links. */
const CALM = { noise: 0.3, leaves: 25 };

/** Registers the service worker, so that the page opens without a network. */
function keepForOffline(): void {
  if (!import.meta.env.PROD || !('serviceWorker' in navigator)) return;
  // Registration is refused where storage is disabled, as in private windows: the page then needs a network.
  navigator.serviceWorker.register('./sw.js').catch(() => undefined);
}

function say(words: string): void {
  const place = document.getElementById('absent');
  if (place === null) return;
  place.textContent = words;
  place.hidden = false;
}

async function start(): Promise<void> {
  if (typeof WebAssembly === 'undefined') return say('This browser runs no WebAssembly, which the flame is computed with.');
  const overlay = isOverlay(location.hash);
  document.body.classList.toggle('overlay', overlay);
  const calm = window.matchMedia('(prefers-reduced-motion: reduce)').matches;
  document.body.classList.toggle('calm', calm);
  const own = { ...DEFAULTS, ...(calm ? CALM : {}) };
  const app = new App(await loadLibrary(), settingsFromLink(location.hash, own), own, overlay);
  await app.start();
  keepForOffline();
}

start().catch((error: unknown) => say(`The page could not start: ${error instanceof Error ? error.message : String(error)}`));
