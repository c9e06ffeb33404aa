// Files that are dropped anywhere on the page.

/** What was dropped: its files, and where a browser says it what each is, so that a folder can be looked into. */
export interface Dropped {
  files: File[];
  entries: (FileSystemEntry | null)[];
}

/** Lets files be dropped anywhere. */
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
    // Known during the event alone.
    if (carried?.files.length) dropped({ files: [...carried.files], entries: [...carried.items].map((item) => item.webkitGetAsEntry()) });
  });
}
