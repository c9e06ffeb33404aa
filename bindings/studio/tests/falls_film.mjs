// A film of a dark slip of paper that swings as it sinks before a light wall, again and again.

import { execFileSync } from 'node:child_process';

const WIDTH = 160;
const HEIGHT = 240;
const RATE = 30;
const FRAMES_A_FALL = 48;

/** Position of the slip in a frame, pixels; every fall begins at another phase of the swing. */
export function slipAt(frame) {
  const [fall, seconds] = [Math.floor(frame / FRAMES_A_FALL), (frame % FRAMES_A_FALL) / RATE];
  const phase = 0.7 * fall;
  return { x: 80 + 25 * (Math.sin(8 * seconds + phase) - Math.sin(phase)), y: 30 + 170 * seconds };
}

function picture(frame) {
  const { x, y } = slipAt(frame);
  const grey = Buffer.alloc(WIDTH * HEIGHT);
  for (let v = 0; v < HEIGHT; ++v) {
    for (let u = 0; u < WIDTH; ++u) {
      const depth = Math.min(12 - Math.abs(u - x), 4 - Math.abs(v - y));
      grey[v * WIDTH + u] = Math.round(210 - 130 * Math.max(0, Math.min(1, depth + 0.5)));
    }
  }
  return grey;
}

/** Writes the film with a number of falls. Returns its path. */
export function fallsFilm(film, falls) {
  const input = Buffer.concat(Array.from({ length: falls * FRAMES_A_FALL }, (_, frame) => picture(frame)));
  const raw = ['-f', 'rawvideo', '-pix_fmt', 'gray', '-s', `${WIDTH}x${HEIGHT}`, '-r', String(RATE), '-i', '-'];
  execFileSync('ffmpeg', ['-v', 'error', '-y', ...raw, '-c:v', 'libx264', '-preset', 'ultrafast', '-crf', '18', '-pix_fmt', 'yuv420p', film], { input });
  return film;
}
