// Keeps the files of the page, so that the page works without a network after the first visit.
// The build sets VERSION and FILES.

const NAME = `pfaff-${VERSION}`;

self.addEventListener("install", (event) => {
  event.waitUntil(caches.open(NAME).then((cache) => cache.addAll(FILES)).then(() => self.skipWaiting()));
});

self.addEventListener("activate", (event) => {
  const drop = async () => {
    const old = (await caches.keys()).filter((name) => name.startsWith("pfaff-") && name !== NAME);
    await Promise.all(old.map((name) => caches.delete(name)));
    await self.clients.claim();
  };
  event.waitUntil(drop());
});

self.addEventListener("fetch", (event) => {
  if (event.request.method !== "GET") return;
  const find = () => caches.match(event.request, { ignoreSearch: true, cacheName: NAME });
  event.respondWith(find().then((kept) => kept ?? fetch(event.request)));
});
