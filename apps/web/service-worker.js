// Keeps the page's own files, so that it opens without a network. What it keeps is listed at build time; a new version
// replaces the old one whole.

const cacheName = 'wisp-' + 'VERSION';
const files = ['FILES'];

// Large, and few ask for it, or not at once: kept for whoever did.
const onDemand = /\/assets\/studio\/|\/models\/leaf/;

// The module that this browser does not run is not kept either. The probe is native.ts's.
const simd = WebAssembly.validate(
  new Uint8Array([
    0, 97, 115, 109, 1, 0, 0, 0, 1, 5, 1, 96, 0, 1, 123, 3, 2, 1, 0, 10, 10, 1, 8, 0, 65, 0, 253, 15, 253, 98, 11,
  ]),
);
const wanted = (name) => !onDemand.test(`/${name}`) && (!name.endsWith('.wasm') || name.includes('-simd-') === simd);

self.addEventListener('install', (event) => {
  event.waitUntil(
    caches
      .open(cacheName)
      .then((cache) => cache.addAll(files.filter(wanted)))
      .then(() => self.skipWaiting()),
  );
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
  if (fetched.ok && onDemand.test(request.url)) {
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
