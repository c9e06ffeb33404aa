// Chosen or dropped sources: films, pictures, tables; folders are read.

/** Files to learn from, all of one kind; or a sentence for the user that says why there are none. */
export type Pick =
  | { kind: 'film' | 'pictures' | 'table'; files: File[] }
  | { kind: 'nothing'; words: string };

const isPicture = ({ name, type }: File): boolean => /^image\/(?!gif|svg)/.test(type) || /\.(png|jpe?g|webp|bmp)$/i.test(name);
const isFilm = ({ name, type }: File): boolean => type.startsWith('video/') || /\.(mp4|mov|m4v|mkv|webm|avi|gif)$/i.test(name);
const isTable = ({ name, type }: File): boolean => type === 'text/csv' || /\.(csv|tsv|txt|dat|asc)$/i.test(name);

/** Files of a folder, including its subfolders. */
async function filesOf(entry: FileSystemEntry): Promise<File[]> {
  if (entry.isFile) return [await new Promise<File>((resolve, reject) => (entry as FileSystemFileEntry).file(resolve, reject))];
  const reader = (entry as FileSystemDirectoryEntry).createReader();
  const found: File[] = [];
  for (;;) {
    // Browsers return a hundred entries at a time.
    const some = await new Promise<FileSystemEntry[]>((resolve, reject) => reader.readEntries(resolve, reject));
    if (some.length === 0) return found;
    for (const one of some) found.push(...(await filesOf(one)));
  }
}

/** Returns the files in dropped folders; if there are no folders, the dropped files. */
export async function unfold(files: readonly File[], entries: readonly (FileSystemEntry | null)[]): Promise<File[]> {
  const folders = entries.filter((entry): entry is FileSystemEntry => entry?.isDirectory === true);
  if (folders.length === 0) return [...files];
  return (await Promise.all(folders.map(filesOf))).flat();
}

export function pickOf(files: readonly File[]): Pick {
  const films = files.filter(isFilm);
  if (films.length > 0) return { kind: 'film', files: films };
  const pictures = files.filter(isPicture);
  if (pictures.length > 1) return { kind: 'pictures', files: pictures };
  if (pictures.length === 1) return { kind: 'nothing', words: 'One picture does not move. Choose a film, or the whole folder of numbered pictures.' };
  const tables = files.filter(isTable);
  if (tables.length > 0) return { kind: 'table', files: tables };
  const [name] = files.map((file) => file.name);
  return { kind: 'nothing', words: name === undefined ? 'There is no picture in this folder.' : `${name} is no film, no picture and no table. Choose a film (MP4, MOV, WebM, MKV), a folder of numbered pictures, or a table (CSV); unpack an archive first.` };
}
