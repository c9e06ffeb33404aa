// Caches the page's own files, so that it opens without a network. The list is made at build time. A new version
// replaces the old one as a whole, once no open page may still need a file of it.

const cacheName = 'wisp-' + 'VERSION';
const files = ['FILES'];

// Large files used by few visitors, or late: cached when first used.
const onDemand = /\/assets\/studio\/|\/models\/(leaf|filmed)/;

// The WebAssembly module that this browser does not run is not cached. The probe is that of native.ts.
const simd = WebAssembly.validate(
  new Uint8Array([
    0, 97, 115, 109, 1, 0, 0, 0, 1, 5, 1, 96, 0, 1, 123, 3, 2, 1, 0, 10, 10, 1, 8, 0, 65, 0, 253, 15, 253, 98, 11,
  ]),
);
const wanted = (name) => !onDemand.test(`/${name}`) && (!name.endsWith('.wasm') || name.includes('-simd-') === simd);

async function keep() {
  const cache = await caches.open(cacheName);
  await cache.addAll(files.filter(wanted));
  await self.skipWaiting();
}

self.addEventListener('install', (event) => event.waitUntil(keep()));

async function dropOthers() {
  const open = await self.clients.matchAll({ type: 'window', includeUncontrolled: true });
  if (open.length > 0) return;
  const names = await caches.keys();
  await Promise.all(names.filter((name) => name.startsWith('wisp-') && name !== cacheName).map((name) => caches.delete(name)));
}

self.addEventListener('activate', (event) => event.waitUntil(self.clients.claim().then(dropOthers)));

async function answer(request) {
  const kept = await caches.match(request, { ignoreSearch: true, cacheName });
  if (kept !== undefined) return kept;
  // A page opened before this version requests files of its own version.
  const before = request.mode === 'navigate' ? undefined : await caches.match(request);
  if (before !== undefined) return before;
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
  if (request.mode === 'navigate') event.waitUntil(dropOthers());
  event.respondWith(answer(request));
});
