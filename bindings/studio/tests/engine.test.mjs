// Compares the modules with the program: the same frames and sound give the same recording, and the same recording the
// same model. ffmpeg decodes for both, since the program's decoder is FFmpeg's.

import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { existsSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, describe, test } from 'node:test';

import { Elsewhere, Engine, StudioError } from '../dist/engine.js';
import { Exporter } from '../dist/exporter.js';
import { fallsFilm } from './falls_film.mjs';

const module = new WebAssembly.Module(readFileSync(new URL('../dist/studio.wasm', import.meta.url)));
const ofChains = new WebAssembly.Module(readFileSync(new URL('../dist/chains.wasm', import.meta.url)));
const exporting = new WebAssembly.Module(readFileSync(new URL('../dist/export.wasm', import.meta.url)));
const shipped = (name) => readFileSync(new URL(`../../../apps/web/public/models/${name}.wisp`, import.meta.url));
const program = new URL('../../../build/release/bin/wisp', import.meta.url).pathname;

/** Passes a clip's decoded frames and sound to an engine. */
function capture(engine, clip, settings) {
  const decoded = (...how) => execFileSync('ffmpeg', ['-v', 'error', '-i', clip, ...how, '-'], { maxBuffer: 4e9 });
  const film = decoded('-f', 'rawvideo', '-pix_fmt', 'yuv420p');
  const sound = settings.silent ? Buffer.alloc(0) : decoded('-f', 'f32le');
  const [width, height, rate] = sizeOf(clip);
  const luma = width * height;
  const size = (3 * luma) / 2;
  const planes = [{ offset: 0, stride: width, step: 1 }, { offset: luma, stride: width / 2, step: 1 }, { offset: (5 * luma) / 4, stride: width / 2, step: 1 }];
  const picture = (k) => ({ layout: 'yuv', width, height, data: film.subarray(k * size, (k + 1) * size), planes, shiftX: 1, shiftY: 1, ...settings.colours });
  const frames = film.length / size;
  engine.begin({ name: clip, rate, ...settings });
  for (const k of settings.glimpses ?? []) engine.frame(picture(k), 0, true);
  for (let k = 0; k < frames; ++k) engine.frame(picture(k), k / rate);
  const samples = new Float32Array(sound.buffer, sound.byteOffset, sound.length / 4);
  if (!settings.silent) engine.sound(samples, settings.channels ?? 1, settings.sampleRate ?? 48000, 0);
  return engine;
}

const probe = (clip, kind, entries) => execFileSync('ffprobe', ['-v', 'error', '-select_streams', kind, '-show_entries', entries, '-of', 'csv=p=0', clip], { encoding: 'utf8' }).trim();

function sizeOf(clip) {
  const [width, height, rate] = probe(clip, 'v', 'stream=width,height,r_frame_rate').split(',');
  const [over, under] = rate.split('/').map(Number);
  return [Number(width), Number(height), over / under];
}

function soundOf(clip) {
  const [sampleRate, channels] = probe(clip, 'a', 'stream=sample_rate,channels').split(',').map(Number);
  return { sampleRate, channels };
}

/** Key frames that the program takes as glimpses: the last one before the end of each quarter. */
function glimpsesOf(clip) {
  const packets = probe(clip, 'v', 'packet=flags').split('\n');
  const keys = packets.flatMap((flags, k) => (flags.includes('K') ? [k] : []));
  const wanted = [1, 2, 3, 4].map((quarter) => keys.filter((key) => key <= ((packets.length - 1) * quarter) / 4).at(-1));
  return [...new Set(wanted)].filter((key) => key > 0);
}

/** Every number of a document, by its path. */
function numbersIn(value, path = '', found = new Map()) {
  if (typeof value === 'number') found.set(path, value);
  else if (value !== null && typeof value === 'object') for (const [key, part] of Object.entries(value)) numbersIn(part, `${path}.${key}`, found);
  return found;
}

const table = (rows) => {
  let [x, past, seed] = [0, 0, 1];
  const lines = ['time,heat,temperature'];
  for (let k = 0; k < rows; ++k) {
    seed = (seed * 48271) % 2147483647;
    const heat = seed / 1073741824 - 1;
    x = 0.8 * x + 0.3 * past;
    past = heat;
    lines.push(`${k * 0.1},${heat},${x}`);
  }
  return Buffer.from(`${lines.join('\n')}\n`);
};

describe('the modules that learn', () => {
  test('learns a table, and says how good it is', async () => {
    const engine = await Engine.start(module);
    const read = engine.table('dryer.csv', table(600), { inputs: ['heat'], outputs: ['temperature'], rate: 10 });
    assert.deepEqual(read.series.map(({ name, role }) => [name, role]), [['heat', 'input'], ['temperature', 'output']]);
    assert.equal(read.rows, 600);
    const stages = [];
    engine.onProgress = (stage) => stages.push(stage) > 0;
    const fit = engine.learn([read.csv], { kind: 'arx', inputs: ['heat'], outputs: ['temperature'], order: 1, nk: 1 });
    assert.equal(fit.report.usable.verdict, true, fit.report.usable.reason);
    assert.equal(Buffer.from(fit.model.subarray(1, 5)).toString(), 'WISP');
    assert.match(fit.text, /^usable/);
    const judged = engine.validate(fit.model, [read.csv]);
    assert.ok(judged.curves.length > 0);
  });

  test('says of a table what will spoil a model, and where its rate is from', async () => {
    const engine = await Engine.start(module);
    const hostile = Buffer.from(table(600).toString().replace(/^(.*),[^,\n]*$/gm, (line, rest, at) => (at % 61 === 7 ? `${rest},-999` : line)));
    const { report, why, rate } = engine.table('dryer.csv', hostile, { inputs: ['heat'], outputs: ['temperature'] }, 'advise');
    assert.match(report.remarks[0].cause, /^'temperature' is -999 in \d+ rows/);
    assert.equal(engine.table('dryer.csv', table(600), { inputs: ['heat'], outputs: ['temperature'], rate: 5 }, 'advise').report.remarks.length, 0);
    assert.ok(why !== '' && rate > 0, why);
  });

  test('reads a table that is not in UTF-8', async () => {
    const latin = Buffer.from('time,u,y\ns,W,\u00b0C\n0,1,2\n0.1,2,3\n0.2,3,4\n', 'latin1');
    assert.equal((await Engine.start(module)).table('latin.csv', latin, { inputs: ['u'], outputs: ['y'] }).series[1].unit, '\u00b0C');
  });

  test('judges a table on rows that were kept back', async () => {
    const engine = await Engine.start(module);
    const recipe = { kind: 'arx', inputs: ['heat'], outputs: ['temperature'], order: 1, nk: 1, kept_back: 0.25 };
    const { csv } = engine.table('dryer.csv', table(600), { inputs: ['heat'], outputs: ['temperature'], rate: 10 });
    const fit = engine.learn([csv], recipe);
    assert.ok(fit.judged.report.rows <= 150);
    assert.ok(fit.judged.report.channels[0].fit_percent.inf > 99);
    // The last outputs are unrelated to the input.
    const lines = table(600).toString().trim().split('\n');
    const broken = lines.map((line, k) => (k < 460 ? line : line.replace(/[^,]*$/, String(Math.sin(k * k)))));
    const odd = engine.table('odd.csv', Buffer.from(broken.join('\n')), { inputs: ['heat'], outputs: ['temperature'], rate: 10 });
    assert.ok(engine.learn([odd.csv], recipe).judged.report.channels[0].fit_percent.inf < 5);
    // Too short to keep anything back.
    const short = engine.table('short.csv', table(40), { inputs: ['heat'], outputs: ['temperature'], rate: 10 });
    assert.equal(engine.learn([short.csv], { ...recipe, kept_back: 0.95 }).judged, undefined);
  });

  test('refuses with sentences, and goes on', async () => {
    const engine = await Engine.start(module);
    const refused = (words) => (error) => error instanceof StudioError && words.test(error.message);
    assert.throws(() => engine.table('noise.csv', Buffer.from([0, 1, 2, 255])), refused(/noise\.csv/));
    assert.throws(() => engine.table('empty.csv', Buffer.alloc(0)), refused(/empty\.csv/));
    assert.throws(() => engine.learn([], { kind: 'arx', outputs: ['y'] }), refused(/record/));
    const { csv } = engine.table('t.csv', table(50), { rate: 10, outputs: ['temperature'] });
    assert.throws(() => engine.learn([csv], { kind: 'flame', sources: ['kettle.mp4'] }), refused(/kettle\.mp4/));
    assert.throws(() => engine.finish(), refused(/no capture/));
    assert.throws(() => engine.begin({ name: 'film', rate: 0 }), refused(/film.*rate/));
    assert.throws(() => engine.begin({ name: 'film', rate: 30, looks_for: 'falls', height: 1000 }), refused(/height is 1000 m/));
    engine.begin({ name: 'dark.mp4', rate: 30 });
    const dark = { layout: 'grey', width: 64, height: 48, data: new Uint8Array(64 * 48), planes: [{ offset: 0, stride: 64, step: 1 }] };
    assert.throws(() => {
      for (let k = 0; k < 90; ++k) engine.frame(dark, k / 30);
      engine.finish();
    }, refused(/dark\.mp4/));
    assert.equal(engine.table('t.csv', table(50), { rate: 10, outputs: ['temperature'] }).rows, 50);
  });

  test('ends where it is told not to go on', async () => {
    const engine = await Engine.start(module);
    engine.onProgress = () => false;
    const { csv } = engine.table('t.csv', table(600), { rate: 10, inputs: ['heat'], outputs: ['temperature'] });
    assert.throws(() => engine.learn([csv], { kind: 'arx', inputs: ['heat'], outputs: ['temperature'] }), /stopped/);
  });

  test('each module says what the other one learns', async () => {
    const [engine, chains] = await Promise.all([module, ofChains].map((one) => Engine.start(one)));
    const { csv } = engine.table('t.csv', table(600), { rate: 10, inputs: ['heat'], outputs: ['temperature'] });
    const arx = { kind: 'arx', inputs: ['heat'], outputs: ['temperature'] };
    const { model } = engine.learn([csv], arx);
    for (const work of [() => engine.learn([csv], { kind: 'leaf' }), () => chains.learn([csv], arx), () => chains.validate(model, [csv])]) {
      assert.throws(work, (error) => error instanceof Elsewhere && /chains\.wasm/.test(error.message));
    }
    assert.throws(() => chains.begin({ name: 'film', rate: 30 }), (error) => error instanceof Elsewhere && /studio\.wasm/.test(error.message));
  });
});

describe('the module that makes files for other tools', () => {
  test('says why there is no such file of a model', async () => {
    const exporter = await Exporter.start(exporting);
    const refused = (settings, words, model = shipped('flame-2')) => assert.throws(() => exporter.files(model, { name: 'x', ...settings }), (error) => error instanceof StudioError && words.test(error.message));
    refused({ format: 'c' }, /16 outputs/);
    refused({ format: 'json' }, /no outline/, shipped('leaf'));
    refused({ format: 'glb', loop: 1e9 }, /at most 3600 s/);
    refused({ format: 'glb' }, /model/, Buffer.from('no model'));
    assert.equal(exporter.files(shipped('flame-2'), { format: 'glb', name: 'x' })[0].name, 'x.glb');
  });
});

describe('against the program', { skip: existsSync(program) ? false : 'the program is not built: script/build' }, () => {
  const folder = mkdtempSync(join(tmpdir(), 'studio-'));
  const clip = join(folder, 'rig.mp4');
  const recording = join(folder, 'rig.csv');
  const wisp = (...words) => execFileSync(program, words, { encoding: 'utf8', maxBuffer: 1e8, stdio: ['ignore', 'pipe', 'pipe'] });
  let engine;

  before(async () => {
    wisp('simulate', 'candle', '-o', clip, '--seconds', '8', '--blow-out', '6', '--seed', '91');
    wisp('capture', 'flame', clip, '-o', recording, '--json');
    engine = await Engine.start(module);
  });
  after(() => rmSync(folder, { recursive: true }));

  test('the same frames and sound give the same recording', () => {
    capture(engine, clip, { flame: 1, glimpses: glimpsesOf(clip), colours: { fullRange: false, bt709: true }, ...soundOf(clip) });
    const seen = engine.seen();
    assert.ok(['following', 'gone'].includes(seen.state));
    assert.ok(seen.threshold > 0 && seen.box.width > 2);
    const ours = engine.finish();
    const theirs = engine.table('rig.csv', readFileSync(recording));
    assert.equal(ours.rows, theirs.rows);
    assert.deepEqual(ours.series.map(({ name }) => name), theirs.series.map(({ name }) => name));
    // Pixels and wind: sums are in the same order, and only the C library's functions differ in their last bit.
    let worst = 0;
    for (const [c, { name, samples }] of ours.series.entries()) {
      const other = theirs.series[c].samples;
      for (let k = 0; k < ours.rows; ++k) {
        assert.equal(Number.isNaN(samples[k]), Number.isNaN(other[k]), `${name} in row ${k}`);
        if (!Number.isNaN(samples[k])) worst = Math.max(worst, Math.abs(samples[k] - other[k]));
      }
    }
    assert.ok(worst < 1e-6, `${worst} apart`);
  });

  test('the same film of falls gives the same recording, whether or not it is said what falls', async () => {
    const paper = fallsFilm(join(folder, 'paper.mp4'), 8);
    const report = JSON.parse(wisp('capture', 'fall', paper, '--height', '2.4', '-o', join(folder, 'paper.csv'), '--json'));
    assert.deepEqual([report.falls, report.usable.verdict], [8, true]);
    const theirs = engine.table('paper.csv', readFileSync(join(folder, 'paper.csv')));
    for (const looks_for of ['falls', 'either']) {
      capture(engine, paper, { looks_for, height: 2.4, silent: true });
      if (looks_for === 'falls') assert.ok('moving' in engine.seen());
      const ours = engine.finish();
      assert.deepEqual(ours.report.usable, report.usable);
      assert.deepEqual([ours.rows, ours.episodes], [theirs.rows, theirs.episodes]);
      assert.deepEqual(ours.series.map(({ name }) => name), ['pos.x', 'pos.y', 'pos.z', 'q.w', 'q.x', 'q.y', 'q.z']);
      for (const [c, { samples }] of ours.series.entries()) samples.forEach((value, k) => assert.ok(Math.abs(value - theirs.series[c].samples[k]) < 1e-6));
    }
    const smooth = ['--smooth', '5'];
    const program = JSON.parse(wisp('learn', 'leaf', join(folder, 'paper.csv'), ...smooth, '-o', join(folder, 'paper.wisp'), '--json'));
    const fit = (await Engine.start(ofChains)).learn([readFileSync(join(folder, 'paper.csv'))], { kind: 'leaf', name: 'paper', smooth_rows: 5 });
    assert.deepEqual([fit.report.usable, fit.report.mode_sizes], [program.usable, program.mode_sizes]);
  });

  for (const [name, format, settings, flags] of [
    ['flame-4', 'glb', { loop: 4 }, ['--loop', '4']],
    ['flame-4', 'glb', { seconds: 2, instances: 3, wind: 0.2, seed: 9 }, ['--seconds', '2', '--instances', '3', '--wind', '0.2', '--seed', '9']],
    ['flame-4', 'json', { loop: 4, height: 300 }, ['--loop', '4', '--size', '300']],
    ['leaf', 'glb', { loop: 6, instances: 4 }, ['--loop', '6', '--instances', '4']],
    ['dryer', 'c', {}, []],
  ]) {
    test(`a ${format} of ${name} ${flags.join(' ')} is the program's, to the byte`, async () => {
      const exporter = await Exporter.start(exporting);
      const model = join(folder, `${name}.wisp`);
      if (name === 'dryer') {
        writeFileSync(join(folder, 'dryer.csv'), table(600));
        wisp('learn', 'arx', join(folder, 'dryer.csv'), '--inputs', 'heat', '--outputs', 'temperature', '--rate', '10', '-o', model, '--quiet');
      } else writeFileSync(model, shipped(name));
      const made = exporter.files(readFileSync(model), { format, name: 'made', ...settings });
      wisp('export', model, '-o', join(folder, `made.${format}`), ...flags, '--quiet');
      assert.deepEqual(made.map((file) => file.name), format === 'c' ? ['made.c', 'made.h'] : [`made.${format}`]);
      for (const file of made) assert.ok(readFileSync(join(folder, file.name)).equals(Buffer.from(file.bytes)), file.name);
    });
  }

  test('a film of a flame stays one where either is looked for', () => {
    capture(engine, clip, { looks_for: 'either', glimpses: glimpsesOf(clip), colours: { fullRange: false, bt709: true }, ...soundOf(clip) });
    assert.equal(engine.seen().moving, null);
    assert.ok(engine.finish().series.some(({ name }) => name === 'p0.x'));
  });

  test('the same falls give the same leaf, and the same chain of positions', async () => {
    const falls = join(folder, 'falls.csv');
    wisp('simulate', 'leaf', '-o', falls, '--drops', '8', '--seconds', '6', '--seed', '7');
    assert.deepEqual(engine.table('falls.csv', readFileSync(falls)).episodes, Array.from({ length: 8 }, (_, k) => 360 * k));
    const chains = await Engine.start(ofChains);
    for (const kind of ['leaf', 'chain']) {
      const report = JSON.parse(wisp('learn', kind, falls, '-o', join(folder, `${kind}.wisp`), '--json'));
      const fit = chains.learn([readFileSync(falls)], { kind, name: kind });
      assert.deepEqual(fit.report.usable, report.usable);
      assert.equal(fit.report.segments, report.segments);
      assert.deepEqual(fit.report.mode_sizes, report.mode_sizes);
      assert.ok(Math.abs(fit.report.mean_segment_seconds - report.mean_segment_seconds) < 1e-9);
      for (const part of ['position', 'rotation']) assert.ok(Math.abs(fit.report.join_defect[part].share_above - report.join_defect[part].share_above) < 1e-6);
    }
  });

  test('a recording that is read is written as it was, to the byte', () => {
    const bytes = readFileSync(recording);
    assert.ok(bytes.equals(engine.table('rig.csv', bytes).csv));
  });

  for (const paper of [0, 4]) {
    test(`the same recording gives the same ${paper ? 'point systems' : 'shape'}`, () => {
      const flags = paper ? ['--paper', '4'] : [];
      const report = JSON.parse(wisp('learn', 'flame', recording, ...flags, '-o', join(folder, 'rig.wisp'), '--json'));
      const fit = engine.learn([readFileSync(recording)], { kind: 'flame', name: 'rig', paper });
      assert.deepEqual(fit.report.usable, report.usable);
      const theirs = numbersIn(report);
      const ours = numbersIn(fit.report);
      // Sums are in the same order; exponentials and angles of C libraries differ in their last digit, and vectors of
      // other processors have other widths.
      for (const [path, value] of theirs) {
        if (path === '.seconds') continue;
        const other = ours.get(path);
        assert.ok(Math.abs(other - value) <= 1e-9 * Math.max(1, Math.abs(value)), `${path}: ${other} and ${value}`);
      }
    });
  }

  test('the same table gives the same model, to the byte', () => {
    const { csv } = engine.table('recording.csv', table(600), { inputs: ['heat'], outputs: ['temperature'], rate: 10 });
    writeFileSync(join(folder, 'recording.csv'), csv);
    wisp('learn', 'arx', join(folder, 'recording.csv'), '--inputs', 'heat', '--outputs', 'temperature', '--na', '2', '--nb', '2', '--nk', '1', '-o', join(folder, 'table.wisp'), '--quiet');
    const { model } = engine.learn([csv], { kind: 'arx', name: 'table', inputs: ['heat'], outputs: ['temperature'], order: 2, nk: 1 });
    // Equal where vectors have the same width: on every x86-64 that the program is built for.
    if (process.arch === 'x64') assert.ok(readFileSync(join(folder, 'table.wisp')).equals(Buffer.from(model)));
  });
});
