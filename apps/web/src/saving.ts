// Saves a still picture, or a film or GIF of some seconds in which the flame is blown out and lit again. Made locally; nothing is sent.

import type { App } from './app.js';
import { fetchPart } from './part.js';

const FRAMES = 30;
const SLICE_MS = 100;
/** Maximum seconds until the first picture is encoded. */
const PATIENCE = 10;
/** Formats of browser recordings, the most widely supported first. */
const KINDS = ['video/mp4;codecs=avc1', 'video/webm;codecs=vp9', 'video/webm'];

export const after = (seconds: number): Promise<unknown> => new Promise((resolve) => setTimeout(resolve, 1000 * seconds));

/** Saves a file on the user's device. Returns the words that say so. */
export function saveFile(blob: Blob, name: string): string {
  const address = URL.createObjectURL(blob);
  const link = document.createElement('a');
  link.href = address;
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(address), 60_000);
  return 'Saved';
}

export const savePicture = async ({ stage }: App): Promise<string> => saveFile(await stage.snapshot(), 'wisp.png');

/** Duration of a film, seconds. */
const lasts = ({ settings }: App): number => (settings.wish !== '' ? 9 : 6.5);

/** Plays the events of a film: the flame burns, is blown out, smokes, and is lit again. */
async function happen(app: App): Promise<void> {
  const { held } = app.breath.keys;
  const { playing } = app.player;
  const acts: readonly (readonly [at: number, act: () => unknown])[] = [
    [0.9, () => held.add('Space')],
    [2.1, () => held.delete('Space')],
    [app.settings.wish !== '' ? 7 : 4.6, () => playing !== null && playing === app.player.playing && playing.scene.act()],
    [lasts(app), () => undefined],
  ];
  let passed = 0;
  for (const [at, act] of acts) {
    await after(at - passed);
    passed = at;
    act();
  }
}

export async function saveGif(app: App): Promise<string> {
  const { gifOf } = await fetchPart(() => import('./gif.js'));
  void happen(app);
  return saveFile(await gifOf(app.stage.canvas, lasts(app)), 'wisp.gif');
}

export async function saveLoop(app: App): Promise<string> {
  const kind = typeof MediaRecorder === 'undefined' ? undefined : KINDS.find((name) => MediaRecorder.isTypeSupported(name));
  if (kind === undefined) return 'This browser records no films';
  const recorder = new MediaRecorder(app.stage.canvas.captureStream(FRAMES), { mimeType: kind, videoBitsPerSecond: 8e6 });
  const parts: Blob[] = [];
  const begun = new Promise((resolve) => {
    recorder.addEventListener('dataavailable', ({ data }) => {
      parts.push(data);
      if (data.size > 0) resolve(null);
    });
  });
  const ended = new Promise((resolve) => recorder.addEventListener('stop', resolve, { once: true }));
  recorder.start(SLICE_MS);
  // On a busy machine encoding starts late.
  await Promise.race([begun, after(PATIENCE)]);
  await happen(app);
  recorder.stop();
  await ended;
  if (parts.every(({ size }) => size === 0)) return 'No picture came: try again';
  return saveFile(new Blob(parts, { type: kind }), kind.startsWith('video/mp4') ? 'wisp.mp4' : 'wisp.webm');
}
