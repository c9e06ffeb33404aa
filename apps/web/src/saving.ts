// Saves a still picture, or a film or GIF of some seconds in which the flame is blown out and lit again. Made locally;
// nothing is sent.

import { fetchPart } from './part.js';
import type { Stage } from '@wisp/player/parts/stage/stage';

const FRAMES = 30;
const SLICE_MS = 100;
/** Maximum seconds until the first picture is encoded. */
const PATIENCE = 10;
/** Formats of browser recordings, the most widely supported first. */
const KINDS = ['video/mp4;codecs=avc1', 'video/webm;codecs=vp9', 'video/webm'];

const after = (seconds: number): Promise<unknown> => new Promise((resolve) => setTimeout(resolve, 1000 * seconds));

/** Saves a file on the user's device. */
export function saveFile(blob: Blob, name: string): void {
  const address = URL.createObjectURL(blob);
  const link = document.createElement('a');
  link.href = address;
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(address), 60_000);
}

/** Saves the next picture. */
export async function savePicture(stage: Stage): Promise<string> {
  saveFile(await stage.snapshot(), 'wisp.png');
  return 'Saved';
}

/** Events during a recording: its duration in seconds, and actions at given seconds. */
export interface Happening {
  seconds: number;
  acts: readonly (readonly [at: number, act: () => void])[];
}

async function happen({ seconds, acts }: Happening): Promise<void> {
  let passed = 0;
  for (const [at, act] of [...acts, [seconds, () => undefined] as const]) {
    await after(at - passed);
    passed = at;
    act();
  }
}

/** Records a canvas during these events as a GIF. */
export async function saveGif(canvas: HTMLCanvasElement, happening: Happening): Promise<string> {
  const { gifOf } = await fetchPart(() => import('./gif.js'));
  void happen(happening);
  saveFile(await gifOf(canvas, happening.seconds), 'wisp.gif');
  return 'Saved';
}

/** Records a canvas during these events as a film. */
export async function saveLoop(canvas: HTMLCanvasElement, happening: Happening): Promise<string> {
  const kind = typeof MediaRecorder === 'undefined' ? undefined : KINDS.find((name) => MediaRecorder.isTypeSupported(name));
  if (kind === undefined) return 'This browser records no films';
  const recorder = new MediaRecorder(canvas.captureStream(FRAMES), { mimeType: kind, videoBitsPerSecond: 8e6 });
  const parts: Blob[] = [];
  const begun = new Promise((resolve) => {
    recorder.addEventListener('dataavailable', ({ data }) => {
      parts.push(data);
      if (data.size > 0) resolve(null);
    });
  });
  const ended = new Promise((resolve) => recorder.addEventListener('stop', resolve, { once: true }));
  recorder.start(SLICE_MS);
  // A busy machine takes time until it encodes anything.
  await Promise.race([begun, after(PATIENCE)]);
  await happen(happening);
  recorder.stop();
  await ended;
  if (parts.every(({ size }) => size === 0)) return 'No picture came: try again';
  saveFile(new Blob(parts, { type: kind }), kind.startsWith('video/mp4') ? 'wisp.mp4' : 'wisp.webm');
  return 'Saved';
}
