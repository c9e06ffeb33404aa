/// <reference types="vite/client" />

// The parts of gifenc in use; it has no types. `delay` in milliseconds; all frames use the first frame's palette.
declare module 'gifenc' {
  export type Palette = number[][];
  type Bytes = Uint8Array | Uint8ClampedArray;
  export function quantize(rgba: Bytes, colours: number): Palette;
  export function applyPalette(rgba: Bytes, palette: Palette): Uint8Array;
  export function GIFEncoder(): {
    writeFrame(index: Uint8Array, width: number, height: number, options: { palette?: Palette; delay: number }): void;
    finish(): void;
    bytes(): Uint8Array;
  };
}
