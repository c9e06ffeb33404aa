// The studio under difficulties: unusual films, devices that disappear, a worker that stops. Each ends in a model or
// in a sentence, and what was gathered before is kept.

import assert from 'node:assert/strict';
import { readFileSync, truncateSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { describe, it } from 'node:test';
import { chooses, drop, dropAll, enterStudio, filmsWith, loud, onPage, painted, panel, saved, says, seen, skip as noChromium, step, temporaryFolder, toLearn, until } from './browser.js';
import { fallsFilm } from '../../../bindings/studio/tests/falls_film.mjs';
import { asDevices, assertSame, brokenOff, candleFilm, capturedByProgram, hugeFile, hugePicture, noConverter, shortFilm, soundAlone, unevenFilm, wallFilm, webFilm } from './films.js';

const skip = noChromium || noConverter;
const folder = temporaryFolder();
let made;
const film = () => (made ??= candleFilm(folder));

const looked = (page) => until(page, 'it has looked', () => document.querySelector('[data-act=learn], .verdict.bad') !== null);
const inStudio = (ready, options = {}) =>
  onPage('#scene=candle&detail=0.1', (page) => enterStudio(page).then(() => ready(page)), { viewport: { width: 1000, height: 700 }, ...options });

/** Chooses a file by its path: its bytes do not pass through the test. */
const choose = (page, kind, path) => page.setInputFiles(`[data-choose=${kind}]`, path);

describe('a film out of the ordinary', { skip }, () => {
  let page;
  inStudio((made) => (page = made));
  const anew = async () => {
    await page.click('[data-act=choose], [data-act=leave-out]');
    await chooses(page);
  };

  it('of 2 GB is read where its frames are', async () => {
    await choose(page, 'film', hugeFile(film(), folder));
    await looked(page);
    assert.match(await page.textContent(panel), /The flame is found/);
    await anew();
  });

  it('that nobody can read is named, and what to do about it', async () => {
    const strangers = {
      'diary.mp4': [Buffer.from('Today I lit a candle.'), 'diary.mp4 is not a film that can be read here.*convert it to MP4'],
      'broken_off.mp4': [readFileSync(brokenOff(film(), folder)), 'broken_off.mp4 is cut off.*copy the whole film'],
      'sound.mp4': [readFileSync(soundAlone(film(), folder)), 'sound.mp4 has sound and no picture'],
    };
    for (const [name, [bytes, words]] of Object.entries(strangers)) {
      await drop(page, name, bytes);
      await says(page, `${panel} .verdict.bad`, words);
      // Without a picture there is none to analyse in another way.
      assert.doesNotMatch(await page.textContent(panel), /The picture stays|something that falls/);
      await anew();
    }
    await drop(page, 'films.zip', Buffer.from('PK'));
    await says(page, '#notices', 'films.zip is no film.*unpack an archive first');
    await drop(page, 'diary.txt', Buffer.from('Dear diary,\ntoday I lit a candle.\n'));
    await says(page, '#notices', 'diary.txt has no column of numbers');
    await dropAll(page, { 'empty.csv': Buffer.from(''), 'other.csv': Buffer.from('') });
    await says(page, '#notices', 'Of the tables, empty.csv alone is read');
  });

  it('that nobody can read, among others, is named; the others, and one that comes meanwhile, are looked at', async () => {
    const short = readFileSync(shortFilm(film(), folder));
    await dropAll(page, { 'first.mp4': short, 'diary.mp4': Buffer.from('Today I lit a candle.'), 'last.mp4': short, 'notes.csv': Buffer.from('u,y\n1,2\n') });
    await says(page, '#notices', 'the films alone are looked at');
    await drop(page, 'more.mp4', short);
    await drop(page, 'late.csv', Buffer.from('u,y\n1,2\n'));
    await says(page, '#notices', 'give pictures or a table when that is done');
    await says(page, '#notices', 'diary.mp4 is not a film');
    await says(page, panel, 'Learn from 3 films');
    // What is shown beside its findings is its own, also after a film in which nothing was found.
    await drop(page, 'wall.mp4', readFileSync(wallFilm(folder)));
    await says(page, `${panel} .verdict.bad`, 'flame|outline|nothing');
    await drop(page, 'late.csv', Buffer.from('u,y\n1,2\n'));
    await says(page, panel, 'What goes in');
    await page.getByRole('button', { name: 'Back' }).click();
    await seen('the last film and its outline', async () => (await painted(page, '.viewer .over', 'blue'))[0] > 20);
    await page.click('[data-act=leave-out]');
    await seen('the film before it', async () => (await painted(page, '.viewer .over', 'bright'))[0] > 20);
    await page.click('[data-act=leave-out]');
    await page.click('[data-act=leave-out]');
    await chooses(page);
  });

  it('in WebM with VP9 is followed as any other, and a press without a drag does not begin anew', async () => {
    await drop(page, 'web.webm', readFileSync(webFilm(film(), folder)));
    await looked(page);
    assert.match(await page.textContent(panel), /The flame is found.*in (59|60|61) of (59|60|61) pictures/s);
    for (const key of [...Array(20).fill('Shift+ArrowRight'), ...Array(20).fill('Shift+ArrowDown'), 'Enter']) await page.press('.viewer .over', key);
    await looked(page);
    await page.click('.viewer .over');
    assert.notEqual(await page.$('[data-act=learn]'), null);
    await page.click('[data-act=leave-out]');
  });

  it('of one second is told to be too short', async () => {
    await drop(page, 'short.mp4', readFileSync(shortFilm(film(), folder)));
    await looked(page);
    const learn = await page.$('[data-act=learn]');
    if (learn !== null) {
      await learn.click();
      await until(page, 'it says what came of it', () => document.querySelector('.verdict.bad, .result') !== null || document.getElementById('notices').textContent !== '');
    }
    const words = (await page.textContent(panel)) + (await page.textContent('#notices'));
    assert.match(words, /short|frames|not enough|rows|seconds/i);
    // A notice about an earlier film may be shown while this one is still being learned from.
    await page.locator('[data-act=choose], [data-act=leave-out], [data-act=anew]').first().click();
    await chooses(page);
  });

  it('is looked at to its end though the page draws nothing meanwhile', async () => {
    await page.evaluate(() => {
      window.drawsAgain = window.requestAnimationFrame;
      window.requestAnimationFrame = () => 0;
    });
    await drop(page, 'unseen.mp4', readFileSync(shortFilm(film(), folder)));
    await looked(page);
    await page.evaluate(() => (window.requestAnimationFrame = window.drawsAgain));
    assert.match(await page.textContent(panel), /in \d+ of 35 pictures/);
    await anew();
  });

  it('whose frames come unevenly has its rows where the program has them', async () => {
    const uneven = unevenFilm(film(), folder);
    await drop(page, 'uneven.mp4', readFileSync(uneven));
    await looked(page);
    await page.click('[data-act=learn]');
    await step(page, 'blow');
    const recording = await saved(page, '[data-file=recording]');
    assertSame(readFileSync(await recording.path(), 'utf8'), readFileSync(capturedByProgram(uneven, folder), 'utf8'));
    await page.click('[data-act=anew]');
  });

  it('of 8K is looked at, or it is said why not', async () => {
    await choose(page, 'film', hugePicture(film(), folder));
    await looked(page);
    assert.match(await page.textContent(panel), /The flame is found|cannot decode|not enough memory|too short|not seen well/);
    await anew();
  });

  it('or a table of a logger: semicolons, commas in its numbers, milliseconds, a unit, a role, a name in quotes that tells nothing', async () => {
    const rows = Array.from({ length: 40 }, (_, k) => `${k * 50};${k % 7 < 3 ? '1,5' : '0,0'};${(20 + Math.sin(k)).toFixed(3).replace('.', ',')}`);
    await drop(page, 'logger.csv', Buffer.from(`time_ms;"pwm; duty[%]";y:temp\r\n${rows.join('\r\n')}\r\n`));
    await says(page, panel, 'What goes in, what comes out');
    await says(page, panel, '40 rows, 20 a second.*has only 40 rows');
    assert.equal(await page.inputValue('#table-rate'), '20');
    const pressed = (column) => page.getAttribute(`[data-column="${column}"]`, 'aria-pressed');
    assert.deepEqual(await Promise.all(['time_ms ignored', 'pwm; duty[%] input', 'y:temp output'].map(pressed)), ['true', 'true', 'true']);
    assert.equal(await page.locator('.plots .curves').count(), 2, 'time itself is not plotted');
    await page.getByRole('button', { name: 'Back' }).click();
  });

  it('is no table of 300 MB', async () => {
    const table = join(folder, 'long.csv');
    writeFileSync(table, 'time,u,y\n');
    truncateSync(table, 300e6);
    await choose(page, 'table', table);
    await says(page, '#notices', 'long.csv has 300 MB');
  });

  it('or a model, which is played where models play', async () => {
    await drop(page, 'flame-2.wisp', readFileSync(new URL('../public/models/flame-2.wisp', import.meta.url)));
    await says(page, '#notices', 'Playing flame-2.wisp');
    await until(page, 'the candle is seen', () => document.getElementById('studio').hidden && window.wisp.burning?.lit === 1);
    await page.click('[data-scene=yours]');
  });

  it('that is captured beside another has its own pictures alone', async () => {
    await page.evaluate(() => {
      const post = Worker.prototype.postMessage;
      Worker.prototype.postMessage = function (message, ...rest) {
        // The answers to the other have a number that nobody waits for.
        if (message.task?.do === 'film') post.call(this, { ...message, of: -1 });
        post.call(this, message, ...rest);
      };
    });
    await drop(page, 'twice.mp4', readFileSync(shortFilm(film(), folder)));
    await says(page, panel, 'in \\d+ of 35 pictures');
    await anew();
  });

  it('whose sound is damaged is captured by its picture, and says so', async () => {
    await page.workers()[0].evaluate(() => (AudioDecoder.prototype.decode = () => { throw new Error('no sound'); }));
    await drop(page, 'deaf.mp4', readFileSync(shortFilm(film(), folder)));
    await says(page, panel, 'in \\d+ of 35 pictures.*Deaf.mp4: its sound is damaged \\(no sound\\)');
  });
});

describe('a worker that stops', { skip }, () => {
  let page;
  inStudio(async (made) => {
    page = made;
    await drop(page, 'first.mp4', readFileSync(film()));
    await looked(page);
  });

  // Each happens in the worker while it analyses a film.
  for (const [what, happens, words] of [
    ['is said to have stopped, and the first film is still there', () => setTimeout(() => { throw new Error('struck'); }), 'worker that learns stopped.*what was gathered is kept'],
    ['for want of memory says so, and what to give it', () => (Uint8Array.prototype.set = () => { throw new RangeError('Array buffer allocation failed'); }), 'not enough memory.*shorter film'],
    ['by a fault of its own says that', () => (Uint8Array.prototype.set = () => { throw new WebAssembly.RuntimeError('unreachable'); }), 'a fault of its own'],
  ]) {
    it(what, async () => {
      await page.click('[data-act=more]');
      await drop(page, 'second.mp4', readFileSync(film()));
      await says(page, panel, 'Picture\\d');
      await page.workers()[0].evaluate(happens);
      await says(page, `${panel} .verdict.bad`, words);
      await page.click('[data-act=choose]');
      await says(page, panel, 'One film is kept');
      await page.getByRole('button', { name: 'Back' }).click();
      await toLearn(page);
    });
  }

  it('is followed by another, which learns from what was gathered', async () => {
    await page.click('[data-act=learn]');
    await step(page, 'blow');
    assert.match(await page.textContent(`${panel} h2`), /It learned your flame/);
  });
});

describe('devices that are taken away', { skip }, () => {
  let page;
  // Runs in the page: a drawn flame in place of the camera, and a silent microphone.
  function stubDevices() {
    window.deaf = false;
    navigator.mediaDevices.getUserMedia = async (wanted) => {
      if (window.late) await new Promise((resolve) => (window.allow = resolve));
      if (window.deaf && wanted.audio) throw new DOMException('no', 'NotAllowedError');
      const canvas = (window.canvas = document.createElement('canvas'));
      [canvas.width, canvas.height] = [160, 240];
      const context = canvas.getContext('2d');
      window.drawing = setInterval(() => {
        context.fillStyle = '#000';
        context.fillRect(0, 0, 160, 240);
        context.fillStyle = '#ffd080';
        context.beginPath();
        context.ellipse(80 + 4 * Math.sin(performance.now() / 90), 130, 22, 70 + 6 * Math.sin(performance.now() / 70), 0, 0, 7);
        context.fill();
      }, 30);
      const stream = canvas.captureStream(30);
      stream.getVideoTracks()[0].getSettings = () => ({ frameRate: 0 }); // as some virtual cameras state
      if (wanted.audio) {
        const sound = new AudioContext().createMediaStreamDestination();
        stream.addTrack(sound.stream.getAudioTracks()[0]);
      }
      window.stream = stream;
      return stream;
    };
  }
  inStudio((made) => (page = made), { before: stubDevices, flags: () => [loud] });
  const filming = async () => {
    await page.click('[data-gather=camera]');
    await says(page, panel, 'Film your flame');
    await until(page, 'a flame is found', () => document.querySelector('.filming [role=status]')?.textContent === '');
    await page.click('.record');
    await says(page, '.caption', 'Hold still');
  };

  it('the microphone before filming: the camera alone films', async () => {
    await page.evaluate(() => (window.deaf = true));
    await page.click('[data-gather=camera]');
    await says(page, panel, 'The microphone was not allowed: the flicker can be learned');
    await page.getByRole('button', { name: 'Back' }).click();
    await page.evaluate(() => (window.deaf = false));
  });

  it('the camera until it is allowed: a film that is chosen meanwhile is looked at to its end', async () => {
    await page.evaluate(() => (window.late = true));
    await page.click('[data-gather=camera]');
    await until(page, 'the camera is asked for', () => window.allow !== undefined);
    await drop(page, 'short.mp4', readFileSync(shortFilm(film(), folder)));
    await says(page, panel, 'Picture\\d');
    await page.evaluate(() => window.allow((window.late = false)));
    await says(page, panel, 'in \\d+ of 35 pictures');
    await page.click('[data-act=leave-out]');
  });

  it('the camera by Back, while what was filmed is looked over: it is abandoned, and disturbs no film that is chosen then', async () => {
    await filming();
    await page.waitForTimeout(2500);
    await page.evaluate(() => ['.record', '.filming > .actions button'].forEach((one) => document.querySelector(one).click()));
    await drop(page, 'short.mp4', readFileSync(shortFilm(film(), folder)));
    await says(page, panel, 'in \\d+ of 35 pictures');
    await says(page, '[data-act=learn]', '^Learn it$');
    await page.click('[data-act=leave-out]');
  });

  it('the microphone while it films: it is said, and filming goes on', async () => {
    await filming();
    await page.evaluate(() => window.stream.getAudioTracks()[0].dispatchEvent(new Event('ended')));
    await says(page, '#notices', 'microphone is gone: from here on');
    assert.equal(await page.textContent('.record'), 'Stop');
  });

  it('the camera while it films: what was filmed till then is looked at', async () => {
    await page.waitForTimeout(2500);
    await page.evaluate(() => window.stream.getVideoTracks()[0].dispatchEvent(new Event('ended')));
    await says(page, '#notices', 'camera is gone; what was filmed till then is kept');
    await looked(page);
    assert.match(await page.textContent(panel), /The flame is|Nothing was learned/);
  });

  it('the phone is turned while it films: what was filmed till then is looked at', async () => {
    await page.$eval('[data-act=more], [data-act=choose]', (button) => button.click());
    await filming();
    await page.waitForTimeout(2500);
    await page.evaluate(() => ([window.canvas.width, window.canvas.height] = [240, 160]));
    await page.waitForTimeout(500);
    await page.click('.record');
    await says(page, panel, '240 x 160 pixels.*the rest is used|too short|at least');
  });

  it('the worker while it films: it is said at once', async () => {
    await page.$eval('[data-act=more], [data-act=choose]', (button) => button.click());
    await chooses(page);
    await filming();
    await page.workers()[0].evaluate(() => setTimeout(() => { throw new Error('struck'); }));
    await says(page, panel, 'worker that learns stopped');
  });
});

describe('falls before a camera', { skip }, () => {
  let page;
  const devices = () => asDevices(fallsFilm(join(folder, 'paper.mp4'), 10), folder, { silent: true, seconds: 16 });
  inStudio((made) => (page = made), { viewport: { width: 390, height: 844 }, flags: () => filmsWith(devices()) });

  it('are counted while they are filmed, and learned from', async () => {
    await page.click('[data-gather=falls]');
    await says(page, panel, 'Film how it falls');
    assert.deepEqual(await page.evaluate(() => document.querySelector('.viewer video').srcObject.getAudioTracks().length), 0, 'no microphone is wanted');
    await page.fill('#wall-height', '2.4');
    await page.dispatchEvent('#wall-height', 'change');
    await until(page, 'the camera shows', () => document.querySelector('.viewer video').videoWidth > 0);
    await page.click('.record');
    await says(page, '.caption', '[4-9] falls');
    assert.ok(await page.isDisabled('#wall-height'), 'the capture has its height already');
    await page.click('.record');
    await looked(page);
    assert.match(await page.textContent(panel), /The falls are|Falls\d/);
    assert.match(await page.textContent(panel), /Falls[3-9]/);
    assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth), 'nothing sticks out sideways');
    await page.click('[data-act=learn]');
    await until(page, 'it says what came of it', () => document.querySelector('.result .verdict h2') !== null || document.getElementById('notices').textContent !== '');
  });
});
