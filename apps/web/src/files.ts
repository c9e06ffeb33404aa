// Files that people drop here: looked at, and refused in words that help.

/** No model is larger; a film dropped by mistake is not even read. */
const MOST_BYTES = 16e6;

/** Why a file was not played. */
export class Refused extends Error {}

const isFilm = ({ name, type }: File): boolean => /^video\//.test(type) || /\.(mp4|mov|m4v|mkv|webm|avi|gif)$/i.test(name);

/** Reads a dropped file. Throws Refused with a sentence for people. */
export async function readDropped(file: File): Promise<Uint8Array> {
  const { name } = file;
  if (file.size === 0) throw new Refused(`${name} is empty. Was it still being saved?`);
  if (isFilm(file)) {
    throw new Refused(`${name} is a film, and this page plays models. “wisp learn flame ${name} -o flame.wisp” on the command line makes one of it; drop that here.`);
  }
  if (file.size > MOST_BYTES) {
    throw new Refused(`${name} is ${Math.round(file.size / 1e6)} MB large. Models are a few kilobytes, a megabyte at most.`);
  }
  try {
    return new Uint8Array(await file.arrayBuffer());
  } catch {
    throw new Refused(`${name} cannot be read.`);
  }
}

/** Says what was wrong with the bytes of a file that is not a sound model. */
export function refusalOf(name: string, error: unknown): Refused {
  const why = error instanceof Error ? error.message : String(error);
  return new Refused(`${name} is not a model that can be played: ${why.replace(/\.$/, '')}.`);
}
