// Files dropped anywhere on the page.

/** Dropped files, with directory entries where the browser provides them, so that folders can be read. */
export interface Dropped { files: File[]; entries: (FileSystemEntry | null)[] }

export function watchDrops(curtain: HTMLElement, dropped: (what: Dropped) => void): void {
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
    const carried = event.dataTransfer;
    // Entries are available during the event only.
    if (carried?.files.length) dropped({ files: [...carried.files], entries: [...carried.items].map((item) => item.webkitGetAsEntry()) });
  });
}
