// Renders the card that chat programs make of a link: title, description and og:image from the head of the page, in a
// mock conversation.
//
//     npm run card --workspace apps/web -- [ADDRESS] [PICTURE.png]      default: the built page, card.png

import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { openBrowser } from '../tests/browser.js';

const opened = await openBrowser();
const [address = `${opened.address}#scene=candle&age=36&name=Ada&from=Ben&wish=Happy+birthday`, picture = join(tmpdir(), 'card.png')] = process.argv.slice(2);
const html = await (await fetch(address)).text();
const told = Object.fromEntries([...html.matchAll(/<meta (?:property|name)="([^"]+)" content="([^"]*)"/g)].map(([, name, words]) => [name, words]));
const image = new URL(told['og:image'] ?? '', address);
const answer = await fetch(image);
if (!answer.ok) throw new Error(`${image} is not there (${answer.status})`);
const bytes = Buffer.from(await answer.arrayBuffer());
// Two of three chat programs accept absolute addresses only.
if (!/^https?:/.test(told['og:image'])) console.log('og:image is relative: build with WISP_ADDRESS=https://… before it is published');
const page = await opened.browser.newPage({ viewport: { width: 420, height: 520 } });
await page.setContent(`<style>
  body { margin: 0; padding: 24px; background: #e5ddd5; font: 15px/1.4 system-ui, sans-serif; }
  a { display: block; width: 330px; margin-left: auto; background: #d9fdd3; border-radius: 12px; padding: 5px; color: #111; text-decoration: none; box-shadow: 0 1px 1px #0002; }
  img { width: 100%; border-radius: 8px 8px 0 0; display: block; aspect-ratio: 1.91; object-fit: cover; }
  div { background: #cbeec3; padding: 8px 12px; border-radius: 0 0 8px 8px; } b { display: block; } small { color: #555; }
  p { margin: 6px 8px; color: #027eb5; overflow-wrap: anywhere; }
</style><a><img src="data:${answer.headers.get('content-type')};base64,${bytes.toString('base64')}"><div><b></b><span></span><br><small></small></div><p></p></a>`);
const words = [told['og:title'], told['og:description'], new URL(address).host, address];
await page.evaluate((texts) => ['b', 'span', 'small', 'p'].forEach((name, k) => (document.querySelector(name).textContent = texts[k])), words);
await page.screenshot({ path: picture });
console.log(`${words[0]} | ${words[1]} | ${image}, ${bytes.length} bytes → ${picture}`);
await opened.close();
