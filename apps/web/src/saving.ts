// What is to be kept of the picture: a still, or some seconds in which it is blown out and lit again, as a film or as a
// GIF. Made here; nothing is sent anywhere.

import { fetchPart } from './part.js';
import type { Stage } from '@wisp/player/parts/stage/stage';

const FRAMES = 30;
const SLICE_MS = 100;
/** Seconds in which the first picture must be encoded. */
const PATIENCE = 10;
/** Kinds of film that browsers record, the one that most programs show first. */
const KINDS = ['video/mp4;codecs=avc1', 'video/webm;codecs=vp9', 'video/webm'];

const after = (seconds: number): Promise<unknown> => new Promise((resolve) => setTimeout(resolve, 1000 * seconds));

/** Gives a file to whoever sits here. */
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

/** What happens while it is filmed: so many seconds of it, and what is done at which of them. */
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

/** Saves what a canvas shows meanwhile, as a GIF. */
export async function saveGif(canvas: HTMLCanvasElement, happening: Happening): Promise<string> {
  const { gifOf } = await fetchPart(() => import('./gif.js'));
  void happen(happening);
  saveFile(await gifOf(canvas, happening.seconds), 'wisp.gif');
  return 'Saved';
}

/** Saves what a canvas shows meanwhile, as a film. */
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
  // A busy machine takes its time until it encodes anything.
  await Promise.race([begun, after(PATIENCE)]);
  await happen(happening);
  recorder.stop();
  await ended;
  if (parts.every(({ size }) => size === 0)) return 'No picture came: try again';
  saveFile(new Blob(parts, { type: kind }), kind.startsWith('video/mp4') ? 'wisp.mp4' : 'wisp.webm');
  return 'Saved';
}
