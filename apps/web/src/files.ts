// Reading of dropped files, with helpful messages for unsuitable ones.

import { WispError } from '@wisp/player/parts/native';

/** Maximum size of a model, bytes. */
const MAX_BYTES = 16e6;

/** Reads a dropped model. Throws an Error with a sentence for people. */
export async function readDropped(file: File): Promise<Uint8Array> {
  const { name } = file;
  if (file.size === 0) throw new Error(`${name} is empty. Was it still being saved?`);
  if (file.size > MAX_BYTES) {
    throw new Error(`${name} is ${Math.round(file.size / 1e6)} MB large. Models are a few kilobytes, a megabyte at most.`);
  }
  try {
    return new Uint8Array(await file.arrayBuffer());
  } catch {
    throw new Error(`${name} cannot be read.`);
  }
}

/** Explains what is wrong with a file that is not a valid model; other errors stay. */
export const refusalOf = (name: string, error: unknown): unknown =>
  error instanceof WispError ? new Error(`${name} is not a model that can be played: ${error.message.replace(/\.$/, '')}.`) : error;

/** Whether the files are for learning in the studio: a film, pictures, a folder of them, or a table. */
export function isLesson(files: readonly File[], entries: readonly (FileSystemEntry | null)[]): boolean {
  if (entries.some((entry) => entry?.isDirectory === true)) return true;
  return files.some(
    ({ name, type }) =>
      /^(video|image)\//.test(type) || /\.(mp4|mov|m4v|mkv|webm|avi|gif|png|jpe?g|webp|bmp|csv|tsv|dat|asc)$/i.test(name),
  );
}
