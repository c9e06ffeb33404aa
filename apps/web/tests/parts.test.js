// Every piece of the page that comes late is lost on its way once, and comes all the same.

import assert from 'node:assert/strict';
import { after, before, describe, it } from 'node:test';
import { openBrowser, skip, until } from './browser.js';

describe('a piece that is lost on its way', { skip }, () => {
  let opened;
  before(async () => (opened = await openBrowser()));
  after(() => opened?.close());

  const lost = async (page) => {
    const seen = new Set();
    await page.route(/assets\/.*\.js$/, (route) => {
      const url = route.request().url();
      if (seen.has(url)) return route.continue();
      seen.add(url);
      return route.abort();
    });
    return seen;
  };

  it('is asked for again: help, leaves and the studio open', async () => {
    const page = await opened.page('#scene=candle&detail=0.1');
    const seen = await lost(page);
    await page.focus('#stage');
    await page.keyboard.press('2');
    await until(page, 'leaves', () => document.querySelector('[data-scene=leaves]').getAttribute('aria-current') === 'true' && window.wisp.frames > 2);
    await page.keyboard.press('?');
    await until(page, 'help', () => document.querySelector('dialog[open]') !== null);
    await page.keyboard.press('Escape');
    await page.keyboard.press('3');
    await until(page, 'the studio', () => document.body.classList.contains('studying'));
    assert.ok(seen.size >= 2, [...seen].join());
  });
});
