// What is to be kept of the picture: a still, or three seconds that move. Made here; nothing is sent anywhere.

import type { Stage } from '@wisp/player/parts/stage/stage';

const SECONDS = 3;
const FRAMES = 30;
/** Kinds of film that browsers record, the one that most programs show first. */
const KINDS = ['video/mp4;codecs=avc1', 'video/webm;codecs=vp9', 'video/webm'];

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

/** Saves what the next seconds of a canvas show, as a film. */
export async function saveLoop(canvas: HTMLCanvasElement): Promise<string> {
  const kind = typeof MediaRecorder === 'undefined' ? undefined : KINDS.find((name) => MediaRecorder.isTypeSupported(name));
  if (kind === undefined) return 'This browser records no films';
  const recorder = new MediaRecorder(canvas.captureStream(FRAMES), { mimeType: kind, videoBitsPerSecond: 8e6 });
  const parts: Blob[] = [];
  recorder.addEventListener('dataavailable', ({ data }) => parts.push(data));
  const ended = new Promise((resolve) => recorder.addEventListener('stop', resolve, { once: true }));
  recorder.start();
  await new Promise((resolve) => setTimeout(resolve, 1000 * SECONDS));
  recorder.stop();
  await ended;
  saveFile(new Blob(parts, { type: kind }), kind.startsWith('video/mp4') ? 'wisp.mp4' : 'wisp.webm');
  return 'Saved';
}
