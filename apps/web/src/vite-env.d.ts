/// <reference types="vite/client" />

// What is used of gifenc, which comes without types. `delay` in milliseconds; the first frame's palette is all the others'.
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
