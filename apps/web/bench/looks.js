// What it costs to look at a film and to learn from it: seconds, pictures that the page draws meanwhile, and memory of the
// tab (its renderer process, worker and page together) and of the process that draws for it.
//
//     npm run looks --workspace apps/web -- FILM…
//
// Of memory there are three figures, MB, sampled ten times a second: what is resident in the process (with the browser's own
// code, which all its processes share), its proportional share of that, and what it alone has.

import { readFileSync } from 'node:fs';
import { chromiumPath, openBrowser, until } from '../tests/browser.js';

const films = process.argv.slice(2);
if (films.length === 0) throw new Error('which films are looked at?');
if (chromiumPath === undefined) throw new Error('there is no Chromium here');

const MEGABYTE = 1024;
const SAMPLED_EVERY_MS = 100;

/** Memory of a process, MB: all that is in it, its share where others have it too, and what it alone has. */
function memoryOf(pid) {
  try {
    const text = readFileSync(`/proc/${pid}/smaps_rollup`, 'utf8');
    const sum = (name) => [...text.matchAll(new RegExp(`^${name}: +(\\d+)`, 'gm'))].reduce((all, [, value]) => all + Number(value), 0) / MEGABYTE;
    return { resident: sum('Rss'), share: sum('Pss'), own: sum('Private_(?:Clean|Dirty)') };
  } catch {
    return { resident: 0, share: 0, own: 0 };
  }
}

/** The most memory of the renderer that has the page, and of the process that draws, while something goes on. */
class Memory {
  constructor(processes) {
    this.processes = processes;
  }

  // A browser keeps a renderer in reserve: the page's is the larger.
  of(type) {
    const all = this.processes.filter((one) => one.type === type).map(({ id }) => memoryOf(id));
    return all.reduce((most, one) => (one.own > most.own ? one : most), memoryOf(0));
  }

  now() {
    return { tab: this.of('renderer'), drawing: this.of('GPU') };
  }

  start() {
    this.most = this.now();
    this.timer = setInterval(() => {
      for (const [process, now] of Object.entries(this.now())) {
        for (const [kind, value] of Object.entries(now)) this.most[process][kind] = Math.max(this.most[process][kind], value);
      }
    }, SAMPLED_EVERY_MS);
  }

  stop() {
    clearInterval(this.timer);
    return this.most;
  }
}

/** In the page: the times of the pictures that it draws. */
function countPictures() {
  window.drawn = [];
  const drawn = (now) => {
    window.drawn.push(now);
    requestAnimationFrame(drawn);
  };
  requestAnimationFrame(drawn);
}

const quantile = (values, share) => [...values].sort((a, b) => a - b)[Math.min(values.length - 1, Math.floor(share * values.length))] ?? NaN;

/** Does something; returns how long it took, and how the page and its memory did meanwhile. */
async function meanwhile(page, memory, work) {
  memory.start();
  const from = await page.evaluate(() => window.drawn.push(performance.now()));
  const begun = performance.now();
  await work();
  const seconds = (performance.now() - begun) / 1000;
  const times = (await page.evaluate((first) => window.drawn.slice(first - 1), from));
  const gaps = times.slice(1).map((time, k) => time - times[k]);
  return { seconds, rate: gaps.length / seconds, gap: quantile(gaps, 0.95), worst: Math.max(0, ...gaps), ...memory.stop() };
}

const megabytes = ({ resident, share, own }) => [resident, share, own].map((value) => value.toFixed(0).padStart(4)).join(' ');
const line = (name, { seconds, rate, gap, worst, tab, drawing }) =>
  console.log(
    `  ${name.padEnd(8)} ${seconds.toFixed(1).padStart(6)} s ${rate.toFixed(1).padStart(6)} pictures/s` +
      `   gaps: 95 % ${gap.toFixed(0).padStart(4)} ms, worst ${worst.toFixed(0).padStart(5)} ms   tab ${megabytes(tab)}   drawing ${megabytes(drawing)}`,
  );

for (const film of films) {
  const opened = await openBrowser();
  const page = await opened.page('#scene=candle&seed=1', { viewport: { width: 1280, height: 800 }, before: countPictures });
  await until(page, 'the page has all of its parts', () => document.querySelector('[data-scene=yours]') !== null);
  await page.click('[data-scene=yours]');
  await until(page, 'the studio', () => document.querySelector('[data-choose=film]') !== null);
  await page.waitForTimeout(3000);
  const session = await opened.browser.newBrowserCDPSession();
  const memory = new Memory((await session.send('SystemInfo.getProcessInfo')).processInfo);
  const { tab, drawing } = memory.now();
  console.log(`${film}\n  before   tab ${megabytes(tab)}   drawing ${megabytes(drawing)}   (resident, share, own)`);
  const looked = () => document.querySelector('[data-act=learn], .verdict.bad') !== null;
  line('look', await meanwhile(page, memory, async () => {
    await page.setInputFiles('[data-choose=film]', film);
    await until(page, 'it has looked', looked, null, 300_000);
  }));
  if ((await page.$('[data-act=learn]')) !== null) {
    line('learn', await meanwhile(page, memory, async () => {
      await page.click('[data-act=learn]');
      await until(page, 'it has learned', () => document.querySelector('.result .verdict h2, #notices .notice') !== null, null, 120_000);
    }));
  }
  console.log(`  says     ${await page.textContent('#studio .panel .verdict h2')}`);
  await opened.close();
}
