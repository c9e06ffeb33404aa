// The studio, in Chromium: a film, a camera, a table go in, a flame comes out and is blown out; and bad days.

import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { describe, it } from 'node:test';
import { blowOut, chooses, complete, drop, dropAll, enterStudio, filmsWith, framesPass, onPage, openBrowser, painted, panel, saved, says, seen, skip, step, temporaryFolder, toLearn, until } from './browser.js';
import { fallsFilm } from '../../../bindings/studio/tests/falls_film.mjs';
import { asDevices, assertSame, candleFilm, capturedByProgram, fallsByProgram, noConverter, noFilms, recordedFalls, shortFilm, turnedFilm, untaggedFilm, wallFilm } from './films.js';

const folder = temporaryFolder();
const laptop = { viewport: { width: 1000, height: 700 } };
let made;
const film = () => (made ??= candleFilm(folder));

/** Response of a second-order system to steps, as a logger's table. */
function table() {
  const rows = ['time,power,temperature'];
  let [y, before] = [0, 0];
  for (let k = 0; k < 600; ++k) {
    const u = Math.sin(k * k * 0.013) > 0 ? 1 : -1;
    [y, before] = [1.5 * y - 0.56 * before + 0.06 * u, y];
    rows.push(`${(k * 0.1).toFixed(1)},${u},${y.toFixed(6)}`);
  }
  return Buffer.from(`${rows.join('\n')}\n`);
}

/** The table of table(), with −999 in place of some samples. */
const tableWithSentinel = () => Buffer.from(table().toString().split('\n').map((row, k) => (k % 97 === 50 ? row.replace(/[^,]*$/, '-999') : row)).join('\n'));

/** The table of table(), with outputs unrelated to the inputs in its last quarter. */
function tableThatBreaks() {
  const rows = table().toString().trim().split('\n');
  return Buffer.from(rows.map((row, k) => (k < 460 ? row : row.replace(/[^,]*$/, String(Math.sin(k * k))))).join('\n'));
}

describe('a film that is dropped', { skip: skip || noFilms }, () => {
  let page;
  const asked = [];
  onPage('#scene=candle&seed=3&detail=0.1', async (made) => {
    page = made;
    page.on('request', (request) => asked.push(new URL(request.url()).pathname));
    await complete(page);
    const early = await page.evaluate(() => performance.getEntriesByType('resource').filter(({ name }) => name.includes('studio')).map(({ name }) => name));
    assert.deepEqual(early, [], 'not a byte of the studio comes before somebody goes in');
    await drop(page, 'mine.mp4', readFileSync(film()));
    await step(page, 'look');
  }, laptop);

  it('brings the studio, and only then', () => assert.ok(asked.some((path) => path.includes('/assets/studio/'))));

  it('is followed by its edge, and says what was found', async () => {
    await toLearn(page);
    assert.match(await page.textContent(panel), /The flame is found.*(100|9\d) % of the frames/s);
    assert.match(await page.textContent(panel), /heard in/);
    await seen('the wind that was heard, drawn in place of what was traced', async () => (await painted(page, '.traces canvas', 'blue', 60, 0.5))[0] > 60);
  });

  it('is learned, and the verdict comes first', async () => {
    await page.click('[data-act=learn]');
    await step(page, 'blow');
    assert.match(await page.textContent(`${panel} h2`), /It learned your flame/);
    assert.match(await page.textContent(panel), /The tip, played freely in the same wind\d+ %/);
  });

  it('plays beside what it learned', () => seen('both flames', async () => (await painted(page, '.duet canvas', 'bright')).every((bright) => bright > 100)));

  it('is learned again in another way, unless that is stopped, and taken away', async () => {
    await page.evaluate(() => ['[data-knob="paper point by point, as in the paper"]', '[data-act=cancel]'].forEach((one) => document.querySelector(one).click()));
    await step(page, 'blow');
    assert.equal(await page.getAttribute('[data-knob="paper as a shape"]', 'aria-pressed'), 'true');
    await page.click('.more summary');
    await page.click('[data-knob="paper point by point, as in the paper"]');
    await step(page, 'blow');
    await until(page, 'it is learned point by point', () => document.querySelector('[data-knob="paper point by point, as in the paper"]')?.getAttribute('aria-pressed') === 'true');
    const model = await saved(page, '[data-file=wisp]');
    assert.equal(model.suggestedFilename(), 'mine.wisp');
    assert.deepEqual([...readFileSync(await model.path()).subarray(1, 5)], [...Buffer.from('WISP')]);
    const recording = await saved(page, '[data-file=recording]');
    assertSame(readFileSync(await recording.path(), 'utf8'), readFileSync(capturedByProgram(film(), folder), 'utf8'));
    await page.click('.more summary');
    await page.click('[data-knob="paper as a shape"]');
    await says(page, panel, 'It learned your flame');
  });

  it('is made small for a link once, also where the browser refuses a late copy', async () => {
    await page.evaluate(() => (navigator.clipboard.writeText = () => Promise.reject(new DOMException('late', 'NotAllowedError'))));
    await page.click('[data-file=link]');
    await says(page, '[data-file=link]', 'Press again to copy it');
    await page.evaluate(() => {
      window.post = Worker.prototype.postMessage;
      Worker.prototype.postMessage = () => { throw new Error('it is learned once more'); };
      navigator.clipboard.writeText = async () => undefined;
    });
    await page.click('[data-file=link]');
    await says(page, '[data-file=link]', 'Copied');
    await page.evaluate(() => (Worker.prototype.postMessage = window.post));
  });

  it('becomes files for other tools, and what makes them comes only then', async () => {
    const made = () => asked.some((path) => /studio\/export-.*\.wasm$/.test(path));
    assert.ok(!made());
    const gltf = await saved(page, '[data-file=glb]');
    assert.equal(gltf.suggestedFilename(), 'mine.glb');
    assert.equal(readFileSync(await gltf.path()).subarray(0, 4).toString(), 'glTF');
    const lottie = await saved(page, '[data-file=json]');
    const { layers, op, fr } = JSON.parse(readFileSync(await lottie.path(), 'utf8'));
    assert.deepEqual([layers.length, Math.round(op / fr)], [1, 4]);
    assert.ok(made());
    await page.$$eval('#studio [data-file=loop], #studio [data-file=gif]', (buttons) => buttons.forEach((button) => button.click()));
    await says(page, '#studio [data-file=gif]', 'another is being made');
    await says(page, '#studio [data-file=loop]', 'Saved|No picture came');
  });

  it('burns in the page, and goes out when somebody blows', async () => {
    await page.click('[data-act=blow]');
    await until(page, 'it burns', () => document.getElementById('studio').hidden && window.wisp.burning?.lit === 1);
    await framesPass(page);
    await blowOut(page);
  });

  it('is still there when somebody comes back', async () => {
    await page.click('[data-scene=yours]');
    await step(page, 'blow');
    assert.match(await page.textContent(`${panel} h2`), /It learned your flame/);
  });
});

describe('is captured as the program captures it:', { skip: skip || noConverter }, () => {
  for (const [what, made] of [['a film that lies on its side', turnedFilm], ['a film that states no colours', untaggedFilm]]) {
    it(what, async () => {
      const other = made(film(), folder);
      const opened = await openBrowser();
      const page = await opened.page('#scene=candle&detail=0.1', laptop);
      await complete(page);
      await drop(page, 'other.mp4', readFileSync(other));
      await step(page, 'look');
      await toLearn(page);
      await page.click('[data-act=learn]');
      await step(page, 'blow');
      const recording = await saved(page, '[data-file=recording]');
      assertSame(readFileSync(await recording.path(), 'utf8'), readFileSync(capturedByProgram(other, folder), 'utf8'));
      await opened.close();
    });
  }
});

describe('a camera', { skip: skip || noConverter }, () => {
  let page;
  onPage('#scene=candle&detail=0.1', (made) => complete((page = made)), { viewport: { width: 390, height: 844 }, flags: () => filmsWith(asDevices(film(), folder)) });

  it('is filmed with, learned from, and given back; by keyboard alone', async () => {
    await page.focus('#stage');
    await page.keyboard.press('3');
    await step(page, 'gather');
    await page.focus('[data-gather=camera]');
    await page.keyboard.press('Enter');
    await until(page, 'the camera is looked through', () => document.querySelector('.record') !== null);
    await until(page, 'a flame is found', () => document.querySelector('.filming [role=status]')?.textContent === '' && document.querySelector('.viewer video').videoWidth > 0);
    await page.focus('.record');
    await page.keyboard.press('Enter');
    await says(page, '.caption', 'softly');
    // Pixels to the right of the lines' names.
    const traced = async () => (await Promise.all(['blue', 'orange'].map((kind) => painted(page, '.traces canvas', kind, 60)))).flat();
    await seen('sound and tip, traced while it is filmed', async () => (await traced()).every((pixels) => pixels > 60));
    await page.waitForTimeout(4000);
    await page.keyboard.press('Enter');
    await toLearn(page);
    assert.equal(await page.evaluate(() => document.querySelector('.viewer video').srcObject), null);
    assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth), 'nothing sticks out sideways');
    const right = await page.$$eval('header.top button', (buttons) => Math.max(...buttons.map((button) => button.getBoundingClientRect().right)));
    assert.ok(right <= 390, `a button ends at ${right}`);
    await page.focus('[data-act=learn]');
    await page.keyboard.press('Enter');
    await until(page, 'it says what came of it', () => document.querySelector('.result .verdict h2') !== null);
  });
});

describe('a table', { skip }, () => {
  let page;
  onPage('#scene=candle&detail=0.1', (made) => (page = made), laptop);

  it('says what its columns are, and is learned', async () => {
    await drop(page, 'kettle.csv', table());
    await step(page, 'look');
    const pressed = (column) => page.getAttribute(`[data-column="${column}"]`, 'aria-pressed');
    assert.deepEqual(await Promise.all(['time ignored', 'power input', 'temperature output'].map(pressed)), ['true', 'true', 'true']);
    await says(page, panel, '600 rows, 10 a second \\(from column "time", in steps of 0.1 s\\)');
    assert.equal(await page.inputValue('#table-rate'), '10');
    assert.equal(await page.locator(`${panel} li`).count(), 0, 'nothing is wrong with it');
    await page.click('[data-act=learn]');
    await step(page, 'blow');
    assert.match(await page.textContent(`${panel} h2`), /It learned how this behaves/);
    await says(page, panel, 'On the last rows');
    assert.ok((await page.textContent(`${panel} .meter`)).includes('temperature'));
    const files = [];
    page.on('download', (download) => files.push(download.suggestedFilename()));
    // The browser reports downloads after the page has requested them.
    const both = page.waitForEvent('download', { predicate: () => files.length === 2 });
    await page.click('[data-file=c]');
    await until(page, 'it is saved', () => document.querySelector('[data-file=c]').textContent === 'Saved');
    await both;
    assert.deepEqual(files.sort(), ['kettle.c', 'kettle.h']);
    await drop(page, 'broken.csv', tableThatBreaks());
    await step(page, 'look');
    await page.click('[data-act=learn]');
    await says(page, '#notices', 'No delay is supported');
    await says(page, panel, 'Film a flame, then blow it out');
  });

  it('says what will spoil a model before it is learned, and the cure', async () => {
    await drop(page, 'words.csv', Buffer.from('u,y\n1,2\noff,3\n4,5\n'));
    await says(page, panel, 'u \\(not all of it is numbers\\)');
    await drop(page, 'dated.csv', Buffer.from('2024-05-01 10:00:00,1,2\n2024-05-01 10:00:02,2,3\n2024-05-01 10:00:04,1,4\n'));
    await page.click('[data-column="c3 output"]');
    await says(page, panel, '3 rows, 0.5 a second');
    // A table that is left while it is read is not learned.
    await drop(page, 'left.csv', table());
    await step(page, 'look');
    await page.evaluate(() => ['learn', 'back'].forEach((act) => document.querySelector(`[data-act=${act}]`).click()));
    await drop(page, 'logger.csv', tableWithSentinel());
    await says(page, panel, "'temperature' is -999 in 6 rows.*stands for a missing sample. Leave these cells empty");
    assert.equal(await page.getAttribute('#studio', 'data-step'), 'look');
    await page.click('[data-column="temperature ignored"]');
    await page.click('[data-column="time output"]');
    await page.fill('#table-rate', '20');
    await says(page, panel, '600 rows, 20 a second');
    assert.doesNotMatch(await page.textContent(panel), /-999/);
  });

  it('without inputs is judged a row ahead', async () => {
    let [y, before] = [0, 0];
    const rows = Array.from({ length: 900 }, (_, k) => ([y, before] = [1.6 * y - 0.8 * before + Math.sin(k * k), y])[0]);
    await drop(page, 'alone.csv', Buffer.from(`y\n${rows.join('\n')}\n`));
    await says(page, panel, 'alone.csv');
    await page.click('[data-act=learn]');
    await says(page, `${panel} h2`, 'It learned how this behaves');
    assert.doesNotMatch(await page.textContent(panel), /from what goes in alone/);
  });
});

describe('recorded falls', { skip: skip || noFilms }, () => {
  let page;
  onPage('#scene=candle&detail=0.1', (made) => (page = made), laptop);

  it('are learned, drawn though the first sample of each is missing, and fall in the page', async () => {
    await drop(page, 'falls.csv', Buffer.from(readFileSync(recordedFalls(folder), 'utf8').replace(/^(\d+,0,0,0),0,0,0,.*$/gm, '$1,,,,,,,')));
    await step(page, 'blow');
    await seen('those recorded', async () => (await painted(page, '.plots .falls canvas', 'blue'))[0] > 20);
    assert.match(await page.textContent(`${panel} h2`), /It learned how this falls/);
    await says(page, panel, 'Beside what was recorded');
    await page.click('[data-act=blow]');
    await until(page, 'it falls', () => document.getElementById('studio').hidden && document.querySelector('[data-scene=leaves]').getAttribute('aria-current') === 'true');
    await framesPass(page);
    assert.doesNotMatch(await page.textContent('#notices'), /borrowed|microphone/);
  });
});

describe('a film of something that falls', { skip: skip || noConverter }, () => {
  let page;
  onPage('#scene=candle&detail=0.1', async (made) => {
    page = made;
    await complete(page);
    await drop(page, 'paper.mp4', readFileSync(fallsFilm(join(folder, 'paper.mp4'), 24)));
    await step(page, 'look');
    await toLearn(page);
  }, { viewport: { width: 390, height: 844 } });

  it('is told from one of a flame, and says what was found', async () => {
    assert.match(await page.textContent(`${panel} .verdict.good`), /The falls are found24 falls/);
    assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth), 'nothing sticks out sideways');
  });

  it('shows the ways that they took', async () => {
    // The film is grey, so its blue pixels are drawn lines.
    const [drawn] = await painted(page, '.viewer .over', 'blue');
    assert.ok(drawn > 500, `${drawn} pixels`);
  });

  it('is set aside while a flame is looked at, and returns', async () => {
    await drop(page, 'flame.mp4', readFileSync(shortFilm(film(), folder)));
    await says(page, '#notices', 'learned apart');
    await says(page, panel, 'in \\d+ of 35 pictures');
    await page.click('[data-act=leave-out]');
    await says(page, `${panel} .verdict.good`, '24 falls');
  });

  it('is looked at again where it is said how much of the wall it shows', async () => {
    await page.fill('#wall-height', '2.4');
    await page.dispatchEvent('#wall-height', 'change');
    await until(page, 'it is looked at again', () => document.querySelector('#wall-height')?.value === '2.4');
  });

  it('is learned, falls in the page, and is taken away as the program would have it', async () => {
    await page.click('[data-act=learn]');
    await step(page, 'blow');
    assert.match(await page.textContent(`${panel} h2`), /It learned how this falls/);
    const recording = await saved(page, '[data-file=recording]');
    const theirs = fallsByProgram(join(folder, 'paper.mp4'), 2.4, folder);
    assertSame(readFileSync(await recording.path(), 'utf8'), readFileSync(theirs, 'utf8'), 1e-4, 'y:pos.x');
    await page.click('[data-act=blow]');
    await until(page, 'it falls', () => document.getElementById('studio').hidden && document.querySelector('[data-scene=leaves]').getAttribute('aria-current') === 'true');
  });
});

describe('a bad day in the studio', { skip }, () => {
  let page;
  // Runs in the page: a camera that is missing, refused, or taken away while it films.
  function stubCamera() {
    window.camera = 'NotFoundError';
    window.wanted = [];
    navigator.mediaDevices.getUserMedia = async (wanted) => {
      window.wanted.push(wanted);
      if (window.camera === 'mute' && wanted.audio) throw new DOMException('no', 'NotFoundError');
      if (window.camera !== 'mute' && window.camera !== 'there') throw new DOMException('no', window.camera);
      const canvas = document.createElement('canvas');
      const context = canvas.getContext('2d');
      window.drawing = setInterval(() => context.fillRect(0, 0, Math.random() * 9, 9), 30);
      window.stream = canvas.captureStream(30);
      return window.stream;
    };
  }
  onPage('#scene=candle&detail=0.1', (made) => enterStudio((page = made)), { ...laptop, before: stubCamera });

  const again = async () => {
    await page.click('[data-act=choose]');
    await chooses(page);
  };

  it('says that there is no camera, and requests unprocessed sound', async () => {
    await page.click('[data-gather=camera]');
    await says(page, panel, 'No camera was found');
    const { audio } = await page.evaluate(() => window.wanted[0]);
    assert.deepEqual([audio.echoCancellation, audio.noiseSuppression, audio.autoGainControl], [false, false, false]);
    await again();
  });

  it('says that the camera was not allowed', async () => {
    await page.evaluate(() => (window.camera = 'NotAllowedError'));
    await page.click('[data-gather=camera]');
    await says(page, panel, 'was not allowed');
    await again();
  });

  it('films without a microphone, and says what cannot be learned then', async () => {
    await page.evaluate(() => (window.camera = 'mute'));
    await page.click('[data-gather=camera]');
    await says(page, panel, 'no microphone: the flicker can be learned');
  });

  it('stops filming when the page is hidden, and says so', async () => {
    // The second press comes before filming has begun, and stops nothing.
    await page.$eval('.record', (button) => [0, 1].forEach(() => button.click()));
    await says(page, '.caption', 'Hold still');
    await page.evaluate(() => {
      Object.defineProperty(document, 'hidden', { configurable: true, get: () => true });
      document.dispatchEvent(new Event('visibilitychange'));
      delete document.hidden;
    });
    await says(page, '#notices', 'stopped when the page was hidden');
    await until(page, 'it ends', () => document.querySelector('[data-act=choose], [data-act=more]') !== null);
    assert.equal(await page.evaluate(() => window.stream.getVideoTracks()[0].readyState), 'ended');
    await page.click('[data-act=choose], [data-act=more]');
  });

  it('says that the camera is gone', async () => {
    await page.click('[data-gather=camera]');
    await says(page, panel, 'Film your flame');
    await page.evaluate(() => window.stream.getVideoTracks()[0].dispatchEvent(new Event('ended')));
    await says(page, panel, 'The camera is gone');
    await again();
  });

  it('says that a film cannot be read', async () => {
    await drop(page, 'broken.mp4', Buffer.from('this is no film'));
    await says(page, `${panel} .verdict.bad`, 'broken.mp4');
    await again();
  });

  it('says that there is no flame in a film', { skip: noConverter }, async () => {
    await drop(page, 'wall.mp4', readFileSync(wallFilm(folder)));
    await says(page, `${panel} .verdict.bad`, 'flame|outline|nothing');
    await again();
  });

  it('says that one picture does not move', async () => {
    await drop(page, 'one.png', Buffer.from('png'));
    await says(page, '#notices', 'One picture does not move');
  });

  it('asks how fast pictures follow each other', async () => {
    await dropAll(page, { 'f1.png': Buffer.from('png'), 'f2.png': Buffer.from('png'), '._f1.png': Buffer.from('of a Mac') });
    await says(page, panel, 'How many pictures a second');
    await page.fill('#pictures-rate', '0');
    assert.ok(await page.isDisabled('[data-act=look]'));
    await page.fill('#pictures-rate', '4');
    await says(page, panel, 'They last 0.5 s');
    await page.click('[data-act=look]');
    await says(page, `${panel} .verdict.bad`, 'f1.png');
    await again();
  });

  it('says that a table is empty', async () => {
    await drop(page, 'empty.csv', Buffer.from(''));
    await says(page, '#notices', 'empty.csv');
  });

  it('leaves by any other tab, and the page plays on', async () => {
    await page.click('[data-scene=candle]');
    await until(page, 'it is hidden', () => document.getElementById('studio').hidden);
    await framesPass(page);
  });
});
