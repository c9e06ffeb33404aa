// Files that are dropped anywhere on the page.

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
