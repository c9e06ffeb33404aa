// Keeps the page's own files, so that it opens without a network. What it keeps is listed at build time; a new version
// replaces the old one whole.

const cacheName = 'wisp-' + 'VERSION';
const files = ['FILES'];

self.addEventListener('install', (event) => {
  event.waitUntil(caches.open(cacheName).then((cache) => cache.addAll(files)).then(() => self.skipWaiting()));
});

async function dropOthers() {
  const names = await caches.keys();
  await Promise.all(names.filter((name) => name.startsWith('wisp-') && name !== cacheName).map((name) => caches.delete(name)));
  await self.clients.claim();
}

self.addEventListener('activate', (event) => event.waitUntil(dropOthers()));

async function answer(request) {
  const kept = await caches.match(request, { ignoreSearch: true, cacheName });
  if (kept !== undefined) return kept;
  const fetched = await fetch(request);
  // The studio is large, and few go in: it is kept for whoever did.
  if (fetched.ok && request.url.includes('/assets/studio/')) {
    const cache = await caches.open(cacheName);
    await cache.put(request, fetched.clone());
  }
  return fetched;
}

self.addEventListener('fetch', (event) => {
  const { request } = event;
  if (request.method !== 'GET' || new URL(request.url).origin !== self.location.origin) return;
  event.respondWith(answer(request));
});
