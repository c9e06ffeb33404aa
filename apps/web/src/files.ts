// Files that people drop here: looked at, and refused in words that help.

/** No model is larger; a film dropped by mistake is not even read. */
const MOST_BYTES = 16e6;

/** Why a file was not played. */
export class Refused extends Error {}

/** Reads a dropped file. Throws Refused with a sentence for people. */
export async function readDropped(file: File): Promise<Uint8Array> {
  if (file.size === 0) throw new Refused(`${file.name} is empty. Was it still being saved?`);
  if (file.size > MOST_BYTES) {
    const size = `${Math.round(file.size / 1e6)} MB`;
    throw new Refused(`${file.name} is ${size} large. Models are a few kilobytes, a megabyte at most: is it a film? “wisp learn” makes a model of it.`);
  }
  try {
    return new Uint8Array(await file.arrayBuffer());
  } catch {
    throw new Refused(`${file.name} cannot be read.`);
  }
}

/** Says what was wrong with the bytes of a file that is not a sound model. */
export function refusalOf(name: string, error: unknown): Refused {
  const why = error instanceof Error ? error.message : String(error);
  return new Refused(`${name} is not a model that can be played: ${why}`);
}

/** Lets files be dropped anywhere. */
export function watchDrops(curtain: HTMLElement, dropped: (file: File) => void): void {
  let depth = 0;
  const carriesFiles = (event: DragEvent): boolean => event.dataTransfer?.types.includes('Files') ?? false;
  window.addEventListener('dragenter', (event) => {
    if (!carriesFiles(event)) return;
    depth += 1;
    curtain.hidden = false;
  });
  window.addEventListener('dragleave', () => {
    depth = Math.max(0, depth - 1);
    if (depth === 0) curtain.hidden = true;
  });
  window.addEventListener('dragover', (event) => event.preventDefault());
  window.addEventListener('drop', (event) => {
    event.preventDefault();
    depth = 0;
    curtain.hidden = true;
    const file = event.dataTransfer?.files[0];
    if (file !== undefined) dropped(file);
  });
}
