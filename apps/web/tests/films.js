// Films for the studio's tests: from the candle rig, so that no recording of anybody is needed.

import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { appendFileSync, copyFileSync, existsSync, mkdirSync, renameSync, statSync, truncateSync } from 'node:fs';
import { dirname, join } from 'node:path';
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

/** Reason why films cannot be made, or false. */
export const noFilms = !existsSync(program) && 'build/release/bin/wisp is not built';
/** Reason why films cannot be converted, or false. */
export const noConverter = noFilms || (!runs('ffmpeg') && 'there is no ffmpeg here');

const convert = (...values) => execFileSync('ffmpeg', ['-v', 'error', '-y', ...values]);
/** Returns a function that converts a film to a file `name` in a folder. */
const another = (name, ...values) => (film, folder) => {
  const made = join(folder, name);
  convert('-i', film, ...values, made);
  return made;
};

/** Ten seconds of a candle in gusts, blown out near the end, with sound: made once per build of the program. */
export function candleFilm(folder) {
  const film = join(folder, 'candle.mp4');
  const kept = fileURLToPath(new URL('../../../node_modules/.cache/wisp/candle.mp4', import.meta.url));
  if (!existsSync(kept) || statSync(kept).mtimeMs < statSync(program).mtimeMs) {
    execFileSync(program, ['simulate', 'candle', '-o', film, '--seconds', '10', '--rate', '30', '--wind', 'gusts', '--blow-out', '8', '--seed', '5', '--quiet']);
    mkdirSync(dirname(kept), { recursive: true });
    // Renamed when complete, as another test may look for the film at the same time.
    copyFileSync(film, `${kept}.${process.pid}`);
    renameSync(`${kept}.${process.pid}`, kept);
  } else copyFileSync(kept, film);
  return film;
}

/** Writes a recording of twelve simulated falls of a leaf. */
export function recordedFalls(folder) {
  const falls = join(folder, 'falls.csv');
  execFileSync(program, ['simulate', 'leaf', '-o', falls, '--drops', '12', '--seconds', '8', '--seed', '7', '--quiet']);
  return falls;
}

/** Five seconds of a film, to be shown rotated by 90 degrees. */
export const turnedFilm = another('turned.mp4', '-t', '5', '-c', 'copy', '-metadata:s:v:0', 'rotate=90');

/** Five seconds of a film in a file that states no colour space. */
export const untaggedFilm = another('untagged.mp4', '-t', '5', '-vf', 'setparams=colorspace=unknown:color_primaries=unknown:color_trc=unknown', '-c:v', 'libx264', '-crf', '12', '-c:a', 'copy');

const byProgram = (recording, ...what) => {
  execFileSync(program, ['capture', ...what, '-o', recording, '--quiet'], { stdio: 'ignore' });
  return recording;
};
export const capturedByProgram = (film, folder) => byProgram(join(folder, 'recording.csv'), 'flame', film);
export const fallsByProgram = (film, metres, folder) => byProgram(join(folder, 'program_falls.csv'), 'fall', film, '--height', String(metres));

/** Converts a film to files for Chromium's fake camera and microphone. */
export function asDevices(film, folder, { silent = false, seconds = 8 } = {}) {
  const [picture, sound] = [join(folder, 'camera.mjpeg'), join(folder, 'microphone.wav')];
  convert('-i', film, '-an', '-t', String(seconds), '-c:v', 'mjpeg', '-q:v', '3', picture);
  if (!silent) convert('-i', film, '-vn', '-t', String(seconds), '-ac', '1', '-ar', '48000', sound);
  return { picture, sound };
}

/** Three seconds of a grey wall. */
export function wallFilm(folder) {
  const film = join(folder, 'wall.mp4');
  convert('-f', 'lavfi', '-i', 'color=c=0x303030:s=320x240:r=30:d=3', '-pix_fmt', 'yuv420p', film);
  return film;
}

/** Two seconds of a film as browsers record: VP9 and Opus in WebM. */
export const webFilm = another('web.webm', '-t', '2', '-c:v', 'libvpx-vp9', '-deadline', 'realtime', '-cpu-used', '8', '-crf', '20', '-b:v', '0', '-c:a', 'libopus');

/** A film's file with its sound alone. */
export const soundAlone = another('sound.mp4', '-t', '1', '-vn', '-c:a', 'copy');

/** Truncates a copy of a film's first second: the index at the end of the MP4 is missing. */
export function brokenOff(film, folder) {
  const whole = join(folder, 'broken_off.mp4');
  convert('-i', film, '-t', '1', '-c', 'copy', whole);
  truncateSync(whole, Math.round(0.6 * statSync(whole).size));
  return whole;
}

/** A film's first second. */
export const shortFilm = another('short.mp4', '-t', '1', '-c', 'copy');

/** Four seconds of a film without every seventh frame; the others keep their times. */
export const unevenFilm = another('uneven.mp4', '-t', '4', '-vf', "select='not(eq(mod(n,7),3))'", '-vsync', 'vfr', '-c:v', 'libx264', '-crf', '12', '-c:a', 'copy');

/** Two thirds of a second of a film at 7680 by 4320 pixels. */
export const hugePicture = another('huge.mp4', '-an', '-t', '0.67', '-r', '15', '-vf', 'scale=-2:4320:flags=fast_bilinear,pad=7680:4320:(ow-iw)/2:0', '-c:v', 'libx264', '-preset', 'ultrafast', '-crf', '26', '-pix_fmt', 'yuv420p');

/** A film in a sparse file of more than 2 GB. */
export function hugeFile(film, folder) {
  const huge = join(folder, 'gigabytes.mp4');
  const hole = 2_200_000_000;
  copyFileSync(film, huge);
  const header = Buffer.alloc(16);
  header.writeUInt32BE(1);
  header.write('free', 4);
  header.writeBigUInt64BE(BigInt(hole), 8);
  const { size } = statSync(huge);
  appendFileSync(huge, header);
  truncateSync(huge, size + hole);
  return huge;
}

/** Asserts that two recordings agree: wind to 0.001, other columns to `most`. Both must have the column `channel`. */
export function assertSame(ours, theirs, most = 0.01, channel = 'u:wind') {
  const rows = (text) => text.trim().split('\n').filter((line) => !line.startsWith('#')).map((line) => line.split(','));
  const [[head, ...found], [names, ...wanted]] = [rows(ours), rows(theirs)];
  assert.ok(names.some((name) => name.startsWith(channel)), names.join());
  assert.deepEqual([head, found.length], [names, wanted.length]);
  for (const [k, row] of wanted.entries()) {
    for (const [c, value] of row.entries()) {
      const place = `${names[c]} in row ${k}: ${found[k][c]} and ${value}`;
      assert.equal(found[k][c] === '', value === '', place);
      assert.ok(Math.abs(Number(found[k][c]) - Number(value)) <= (names[c].startsWith('u:wind') ? 0.001 : most), place);
    }
  }
}
