// Films for the studio's tests: from the candle rig, so that no recording of anybody is needed.

import { execFileSync } from 'node:child_process';
import { existsSync } from 'node:fs';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';

const program = process.env.WISP_PROGRAM ?? fileURLToPath(new URL('../../../build/release/bin/wisp', import.meta.url));

function runs(command) {
  try {
    execFileSync(command, ['-version'], { stdio: 'ignore' });
    return true;
  } catch {
    return false;
  }
}

/** Why there are no films here, or false. */
export const noFilms = !existsSync(program) && 'build/release/bin/wisp is not built';
/** Why nothing can be made of them, or false. */
export const noConverter = noFilms || (!runs('ffmpeg') && 'there is no ffmpeg here');

const convert = (...values) => execFileSync('ffmpeg', ['-v', 'error', '-y', ...values]);

/** Ten seconds of a candle in gusts, blown out near the end, with the sound of the wind. */
export function candleFilm(folder) {
  const film = join(folder, 'candle.mp4');
  execFileSync(program, ['simulate', 'candle', '-o', film, '--seconds', '10', '--rate', '30', '--wind', 'gusts', '--blow-out', '8', '--seed', '5', '--quiet']);
  return film;
}

/** Some falls of a leaf. */
export function recordedFalls(folder) {
  const falls = join(folder, 'falls.csv');
  execFileSync(program, ['simulate', 'leaf', '-o', falls, '--drops', '12', '--seconds', '8', '--seed', '7', '--quiet']);
  return falls;
}

/** The same, to be shown turned by a quarter. */
export function turnedFilm(film, folder) {
  const turned = join(folder, 'turned.mp4');
  convert('-i', film, '-t', '3', '-c', 'copy', '-metadata:s:v:0', 'rotate=90', turned);
  return turned;
}

/** The recording that the program captures. */
export function capturedByProgram(film, folder) {
  const recording = join(folder, 'recording.csv');
  execFileSync(program, ['capture', 'flame', film, '-o', recording, '--quiet'], { stdio: 'ignore' });
  return recording;
}

/** The falls that the program finds in a film. */
export function fallsByProgram(film, metres, folder) {
  const recording = join(folder, 'program_falls.csv');
  execFileSync(program, ['capture', 'fall', film, '--height', String(metres), '-o', recording, '--quiet'], { stdio: 'ignore' });
  return recording;
}

/** The same as what a camera and a microphone give, again and again. */
export function asDevices(film, folder) {
  const [picture, sound] = [join(folder, 'camera.mjpeg'), join(folder, 'microphone.wav')];
  convert('-i', film, '-an', '-t', '8', '-c:v', 'mjpeg', '-q:v', '3', picture);
  convert('-i', film, '-vn', '-t', '8', '-ac', '1', '-ar', '48000', sound);
  return { picture, sound };
}

/** Three seconds of a grey wall. */
export function wallFilm(folder) {
  const film = join(folder, 'wall.mp4');
  convert('-f', 'lavfi', '-i', 'color=c=0x303030:s=320x240:r=30:d=3', '-pix_fmt', 'yuv420p', film);
  return film;
}
