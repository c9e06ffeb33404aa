// Chosen or dropped sources: films, pictures, tables; folders are read.

/** Files to learn from, all of one kind; and a sentence for the user about what is left out, '' if nothing is. */
export interface Pick { kind: 'film' | 'pictures' | 'table' | 'nothing'; files: File[]; words: string }

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

/** Returns the dropped files, and those in dropped folders. */
export async function unfold(files: readonly File[], entries: readonly (FileSystemEntry | null)[]): Promise<File[]> {
  if (!entries.some((entry) => entry?.isDirectory === true)) return [...files];
  return (await Promise.all(entries.filter((entry) => entry !== null).map(filesOf))).flat();
}

export function pickOf(given: readonly File[]): Pick {
  // A leading dot marks a system's own files: a Mac adds one to every file on a foreign disk.
  const files = given.filter(({ name }) => !name.startsWith('.'));
  const [films, pictures, tables] = [files.filter(isFilm), files.filter(isPicture), files.filter(isTable)];
  const alone = (what: string, others: number): string => (others > 0 ? `Of these, the ${what} alone are looked at: give the others by themselves.` : '');
  if (films.length > 0) return { kind: 'film', files: films, words: alone('films', pictures.length + tables.length) };
  if (pictures.length > 1) return { kind: 'pictures', files: pictures, words: alone('pictures', tables.length) };
  const [table] = tables;
  if (table !== undefined) {
    const words = `Of the ${pictures.length > 0 ? 'files' : 'tables'}, ${table.name} alone is read: each is learned by itself.`;
    return { kind: 'table', files: [table], words: tables.length + pictures.length > 1 ? words : '' };
  }
  if (pictures.length > 0) return { kind: 'nothing', files, words: 'One picture does not move. Choose a film, or the whole folder of numbered pictures.' };
  const [name] = files.map((file) => file.name);
  return { kind: 'nothing', files, words: name === undefined ? 'There is no picture in this folder.' : `${name} is no film, no picture and no table. Choose a film (MP4, MOV, WebM, MKV), a folder of numbered pictures, or a table (CSV); unpack an archive first.` };
}
