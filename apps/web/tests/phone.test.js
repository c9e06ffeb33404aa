// The page by touch on a small, upright screen, in Chromium's emulation of a phone.

import assert from 'node:assert/strict';
import { describe, it } from 'node:test';
import { allLit, noneLit, onPage, openCard, skip, until } from './browser.js';

const phone = { viewport: { width: 390, height: 844 }, deviceScaleFactor: 2, isMobile: true, hasTouch: true };

describe('on a phone', { skip }, () => {
  let opened, page, session;
  onPage('#scene=candle&seed=3&noise=0&detail=0.2', async (...made) => {
    [page, opened] = made;
    session = await page.context().newCDPSession(page);
  }, phone);
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

  it('a phone that is tilted blows it aside or away; turned, it goes round the candle, also where it stands upright', async () => {
    const held = (alpha, beta, gamma) => session.send('DeviceOrientation.setDeviceOrientationOverride', { alpha, beta, gamma });
    const sees = (...how) => until(page, ...how);
    await page.evaluate(() => (DeviceOrientationEvent.requestPermission = async () => (window.asked = navigator.userActivation.isActive) && 'granted'));
    await held(10, 88, 0);
    await page.keyboard.press('a');
    await sees('it has asked, in a press', () => window.asked === true && document.querySelector('[data-knob=senses]').ariaPressed === 'true');
    // The first event, which a busy machine delivers late, sets the rest position. Browsers report changes only.
    await page.evaluate(() => addEventListener('deviceorientation', () => (window.turned = true)));
    await held(10, 88.1, 0);
    await sees('nothing blows', () => window.turned && Math.abs(window.wisp.wind) < 0.02);
    await page.evaluate(() => setInterval(() => (window.far = [Math.min(window.far?.[0] ?? 0, window.wisp.answer), Math.max(window.far?.[1] ?? 0, window.wisp.answer)]), 20));
    await held(100, 60, -89.9);  // upright and rolled: 30 degrees down on the left
    await sees('it leans to the left', () => window.far?.[0] < -0.1);  // the extremes are kept, as a busy machine may look late
    await held(10, 88, 0);
    await sees('it is still', () => Math.abs(window.wisp.wind) < 0.1 && (window.far = [0, 0]));
    await held(10, 60, 0);
    await sees('it leans away', () => window.far[1] > 0.1);
    assert.equal(await page.evaluate(() => window.wisp.azimuth), 0);
    for (const alpha of [30, 50, 70]) {
      await held(alpha, 60, 0);
      await sees('the eye has gone with it', (degrees) => Math.abs(window.wisp.azimuth - (degrees * Math.PI) / 180) < 0.01, alpha - 10);
    }
    await page.$eval('[data-knob=senses]', (knob) => knob.click());
    assert.equal(await page.getAttribute('[data-knob=senses]', 'aria-pressed'), 'false');
    await sees('nothing blows', () => Math.abs(window.wisp.wind) < 0.02);
  });

  it('hands the link on with a picture of this flame', async () => {
    await page.evaluate(() => {
      navigator.canShare = () => true;
      navigator.share = async ({ url, files: [{ type, size }] }) => (window.shared = { url, type, size });
    });
    await openCard(page);
    await page.click('[data-file=send]');
    await until(page, 'it is handed on', () => window.shared !== undefined);
    const { url, type, size } = await page.evaluate(() => window.shared);
    assert.ok(url.includes('seed=3') && type === 'image/png' && size > 5000, `${url} with ${size} bytes of ${type}`);
    await page.keyboard.press('Escape');
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
      assert.ok(box.width >= 44 && box.height >= 44, `${name}: ${box.width} x ${box.height}`);
      assert.ok(box.left >= 0 && box.right <= phone.viewport.width, `${name} is at ${box.left}`);
      assert.ok(box.top >= 0 && box.bottom <= phone.viewport.height, `${name} is at ${box.top}`);
    }
  });

  for (const width of [320, 390]) {
    it(`nothing is cut or lies under another at ${width} pixels, by day, with words from somebody`, async () => {
      const narrow = await opened.page('#scene=candle&candles=3&name=Maximiliane&from=Bartholomew&wish=May+all+of+it+come+true&tune=1&detail=0.1', { ...phone, viewport: { width, height: 568 }, reducedMotion: 'reduce' });
      await until(narrow, 'all is here', () => document.querySelector('#card button') !== null && document.querySelectorAll('#scenes button').length === 3);
      const look = () =>
        narrow.evaluate(() => {
          const boxes = [...document.querySelectorAll('button, label.count, #greeting')]
            .filter((at) => at.getClientRects().length > 0 && at.closest('#card, #drawer') === null && at.textContent !== '')
            .map((at) => [at.id || at.textContent, at.getBoundingClientRect().toJSON(), at.scrollWidth > at.clientWidth + 1]);
          const wrong = boxes.filter(([, box, cut]) => cut || box.left < 0 || box.right > innerWidth || box.top < 0 || box.bottom > innerHeight).map(([name]) => `${name} is cut`);
          boxes.forEach(([name, a], k) =>
            boxes.slice(k + 1).forEach(([other, b]) => {
              if (a.left < b.right - 1 && b.left < a.right - 1 && a.top < b.bottom - 1 && b.top < a.bottom - 1) wrong.push(`${name} lies under ${other}`);
            }),
          );
          return [boxes.length, wrong];
        });
      const [many, wrong] = await look();
      assert.ok(many >= 9, `${many}`);
      assert.deepEqual(wrong, []);
      await openCard(narrow);
      assert.ok(await narrow.$eval('#card', (card) => card.scrollWidth <= card.clientWidth));
      await narrow.close();
    });
  }

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
});
