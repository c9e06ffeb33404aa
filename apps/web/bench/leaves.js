// What leaves cost a frame, without a browser: processor milliseconds of all that the page does with them before they
// are handed to the graphics card (wind for each, the model's step, poses read and laid out, those that come and go).
//
//     node bench/leaves.js [FRAMES]        default 300 frames of 1/60 s, after as many to settle

import { readFileSync } from 'node:fs';
import { fileURLToPath } from 'node:url';
import { load } from '@wisp/player';
import { createServer } from 'vite';

const frames = Number(process.argv[2] ?? 300);
const root = fileURLToPath(new URL('..', import.meta.url));
const vite = await createServer({ root, server: { middlewareMode: true, hmr: false }, appType: 'custom', optimizeDeps: { noDiscovery: true }, logLevel: 'error' });
const { LeafFall } = await vite.ssrLoadModule('/src/leaves/fall.ts');
const { LeafCamera } = await vite.ssrLoadModule('/src/leaves/camera.ts');

const wisp = await load();
const model = wisp.model(readFileSync(new URL('../public/models/leaf.wisp', import.meta.url)));
const camera = new LeafCamera();
camera.frame(1280, 800);
const gust = { x: 0, z: 1, speedX: 1.5, speedZ: 0.2, everywhere: 0.4, kick: 0, kickX: 0, kickY: 0, kickReach: 1 };

console.log(`Node.js ${process.version}, SIMD ${wisp.simd ? 'on' : 'off'}`);
console.log(' leaves   ms a frame');
for (const many of [1, 100, 1000, 10_000]) {
  const bank = model.bank({ capacity: 10_000 });
  const fall = new LeafFall(bank, camera, 1);
  fall.want(many);
  while (fall.count < many) fall.update(1 / 60, gust);
  for (let k = 0; k < frames; ++k) fall.update(1 / 60, gust);
  const before = process.cpuUsage();
  for (let k = 0; k < frames; ++k) fall.update(1 / 60, gust);
  const { user, system } = process.cpuUsage(before);
  console.log(`${String(many).padStart(7)} ${((user + system) / 1000 / frames).toFixed(3).padStart(12)}`);
  bank.free();
}
await vite.close();
