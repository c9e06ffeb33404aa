// Sound for the fake microphone: a room, a breath, speech, a strong breath, as 16-bit mono at 44.1 kHz.

import { execFileSync } from 'node:child_process';
import { existsSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { wavOf } from '../../../bindings/npm/tests/chromium.mjs';
import { hears, openBrowser, until } from './browser.js';

export const rate = 44_100;

const data = process.env.WISP_DATA ?? fileURLToPath(new URL('../../../../shared/data/', import.meta.url));

// Pseudo-random numbers from −1 to 1.
function noise(seed) {
  let word = seed >>> 0;
  return () => {
    word = (Math.imul(word, 1664525) + 1013904223) >>> 0;
    return word / 2 ** 31 - 1;
  };
}

function rms(samples) {
  let sum = 0;
  for (const value of samples) sum += value * value;
  return Math.sqrt(sum / samples.length);
}

/** Scales samples to a level (RMS) and fades their ends. */
function loud(samples, level, fade = 0.15) {
  const gain = level / Math.max(1e-9, rms(samples));
  const ends = Math.round(fade * rate);
  return samples.map((value, k) => value * gain * Math.min(1, k / ends, (samples.length - 1 - k) / ends));
}

export function room(seconds, level = 0.0008) {
  const next = noise(7);
  let low = 0;
  const samples = Float32Array.from({ length: seconds * rate }, () => {
    low += 0.02 * (next() - low);
    return low + 0.1 * next();
  });
  return loud(samples, level, 0);
}

// Synthetic breath: low-frequency noise whose loudness varies.
function madeBreath(seconds) {
  const next = noise(23);
  let deep = 0;
  let deeper = 0;
  return Float32Array.from({ length: seconds * rate }, (_, k) => {
    deep += 0.05 * (next() - deep);
    deeper += 0.012 * (next() - deeper);
    return (deep + 2 * deeper) * (1 + 0.3 * Math.sin((k / rate) * 9));
  });
}

/** Blowing at a microphone that passes only a band of frequencies, Hz. */
export function hiss(seconds, level, band = [800, 3200]) {
  const next = noise(31);
  const [low, high] = band.map((hertz) => 1 - Math.exp((-2 * Math.PI * hertz) / rate));
  const state = new Float64Array(8);
  const passed = (value) => {
    for (let k = 0; k < 4; ++k) value -= state[k] += low * (value - state[k]);
    for (let k = 4; k < 8; ++k) value = state[k] += high * (value - state[k]);
    return value;
  };
  return loud(Float32Array.from({ length: Math.round(seconds * rate) }, () => passed(next())), level);
}

function samplesOf(path) {
  const bytes = readFileSync(path);
  let at = 12;
  while (bytes.toString('latin1', at, at + 4) !== 'data') at += 8 + bytes.readUInt32LE(at + 4);
  const from = at + 8;
  const count = Math.min(bytes.readUInt32LE(at + 4), bytes.length - from) >> 1;
  return Float32Array.from({ length: count }, (_, k) => bytes.readInt16LE(from + 2 * k) / 32768);
}

/** Returns the loudest part of the samples that lasts `seconds`. */
function loudest(samples, seconds) {
  const length = Math.round(seconds * rate);
  let best = 0;
  let most = -1;
  for (let from = 0; from + length <= samples.length; from += rate >> 3) {
    const level = rms(samples.subarray(from, from + length));
    if (level > most) [most, best] = [level, from];
  }
  return samples.slice(best, best + length);
}

/** Recorded breath where there is a recording, else synthetic. */
export function breath(seconds, level) {
  const recorded = join(data, 'sound/breath_normal.wav');
  return loud(existsSync(recorded) ? loudest(samplesOf(recorded), seconds) : madeBreath(seconds), level);
}

/** A spoken sentence; null without espeak-ng. */
export function speech(seconds, level) {
  const folder = mkdtempSync(join(tmpdir(), 'wisp-speech-'));
  const path = join(folder, 'speech.wav');
  const words = 'This candle listens to everything I say, but talking to it politely does not put it out at all.';
  try {
    execFileSync('espeak-ng', ['-w', path, '-s', '150', words], { stdio: 'ignore' });
  } catch {
    return null;
  }
  const slow = samplesOf(path);
  rmSync(folder, { recursive: true });
  // espeak-ng speaks at 22.05 kHz: a sample half way between each two doubles the rate.
  const spoken = Float32Array.from({ length: Math.min(2 * slow.length, seconds * rate) }, (_, k) =>
    k % 2 === 0 ? slow[k >> 1] : 0.5 * (slow[k >> 1] + (slow[(k >> 1) + 1] ?? 0)),
  );
  return loud(spoken, level, 0.02);
}

/** Writes pieces one after another to a WAV file, with the room's noise added. */
export function writeSound(path, pieces) {
  const length = pieces.reduce((sum, piece) => sum + piece.length, 0);
  const background = room(Math.ceil(length / rate) + 1);
  const samples = new Int16Array(length);
  let at = 0;
  for (const piece of pieces) {
    samples.set(piece.map((value, k) => Math.round(32767 * Math.max(-1, Math.min(1, value + background[at + k])))), at);
    at += piece.length;
  }
  writeFileSync(path, wavOf(samples, rate));
}

/**
 * Opens a page whose microphone plays these pieces of sound, one after another, once it is opened. Keeps the page's
 * figures every 33 ms, with the seconds since the sound began.
 */
export async function hearing(folder, pieces, { detail = 0.2, ...options } = {}) {
  const file = join(folder, `${Math.random()}.wav`);
  writeSound(file, pieces);
  const opened = await openBrowser(hears(file));
  const page = await opened.page(`#scene=candle&seed=1&noise=0.5&detail=${detail}`, options);
  await page.evaluate(() => {
    let began = 0;
    window.course = [];
    setInterval(() => {
      const { hearing, wind, answer, burning, smoking, sound, frames } = window.wisp;
      if (began === 0 && hearing === 'listening') began = performance.now();
      window.soundTime = began === 0 ? 0 : (performance.now() - began) / 1000;
      window.course.push({ time: window.soundTime, hearing, wind, answer, lit: burning.lit, smoking, frames, ...sound });
    }, 33);
  });
  const at = (seconds) => until(page, `${seconds} s of sound`, (time) => window.soundTime > time, seconds);
  const between = (from, to) => page.evaluate(([low, high]) => window.course.filter(({ time }) => time > low && time < high), [from, to]);
  return { opened, page, at, between };
}
