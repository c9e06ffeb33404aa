// The page under a finger on a small, upright screen, in Chromium's likeness of a phone.

import assert from 'node:assert/strict';
import { after, before, describe, it } from 'node:test';
import { chromiumPath, openBrowser, until } from './browser.js';

const skip = chromiumPath === undefined && 'there is no Chromium here';
const phone = { viewport: { width: 390, height: 844 }, deviceScaleFactor: 2, isMobile: true, hasTouch: true };

const allLit = () => window.wisp.burning?.lit === window.wisp.burning?.of;
const noneLit = () => window.wisp.burning?.lit === 0;

describe('on a phone', { skip }, () => {
  let opened, page, session;
  before(async () => {
    opened = await openBrowser();
    page = await opened.page('#scene=candle&seed=3&noise=0&detail=0.2', phone);
    session = await page.context().newCDPSession(page);
  });
  after(() => opened?.close());

  const touch = (type, ...touchPoints) => session.send('Input.dispatchTouchEvent', { type, touchPoints });
  const picture = () => page.evaluate(() => new Promise(requestAnimationFrame));
  const wick = async () => (await page.evaluate(() => window.wisp.places())).wick;

  /** A finger comes down beside a place, passes it in one picture, and lifts. */
  const swipePast = async ([x, y]) => {
    await touch('touchStart', { x: x - 150, y });
    await picture();
    await touch('touchMove', { x: x + 150, y });
    await picture();
    await touch('touchEnd');
  };

  it('a finger that passes quickly blows the flame out, and a tap lights it', async () => {
    const [x, y] = await wick();
    await swipePast([x, y - 30]);
    await until(page, 'it is out', noneLit);
    await page.touchscreen.tap(x, y);
    await until(page, 'it burns again', allLit);
  });

  it('a finger that rests stirs nothing', async () => {
    await until(page, 'the air is still', () => Math.abs(window.wisp.wind) < 0.02);
    await touch('touchStart', { x: 40, y: 300 });
    for (let look = 0; look < 10; ++look) {
      await picture();
      assert.ok(Math.abs(await page.evaluate(() => window.wisp.wind)) < 0.02);
    }
    await touch('touchEnd');
  });

  it('every button can be hit with a thumb and lies on the screen', async () => {
    const boxes = await page.$$eval('button', (buttons) =>
      buttons
        .filter((button) => button.offsetParent !== null)
        .map((button) => [button.textContent.trim(), button.getBoundingClientRect().toJSON()]),
    );
    assert.ok(boxes.length >= 5, `${boxes.length} buttons`);
    for (const [name, box] of boxes) {
      // WCAG 2.2, 2.5.8: at least 24 CSS pixels each way.
      assert.ok(box.width >= 24 && box.height >= 24, `${name}: ${box.width} x ${box.height}`);
      assert.ok(box.left >= 0 && box.right <= phone.viewport.width, `${name} is at ${box.left}`);
      assert.ok(box.top >= 0 && box.bottom <= phone.viewport.height, `${name} is at ${box.top}`);
    }
  });

  it('the drawer fits the screen and can be scrolled to its end', async () => {
    await page.tap('#open-drawer');
    await until(page, 'the drawer is open', () => !document.getElementById('drawer').hidden);
    const sizes = await page.$eval('#drawer', (drawer) => {
      drawer.scrollTop = drawer.scrollHeight;
      const last = drawer.lastElementChild.getBoundingClientRect();
      return { width: drawer.scrollWidth - drawer.clientWidth, left: last.bottom - drawer.getBoundingClientRect().bottom };
    });
    assert.ok(sizes.width <= 0, 'nothing sticks out sideways');
    assert.ok(sizes.left <= 1, `its end is ${sizes.left} pixels below`);
    assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth));
    await page.tap('#drawer header button');
  });

  it('made no error', () => assert.deepEqual(page.errors, []));
});
