// Small pictures kept of a film: for the strip, and for replay where there is no file. At their maximum number every other one is dropped.

import type { Region, Seen } from '@wisp/studio';

/** Maximum number of pictures without a file (about 90 MB) and beside a file; maximum height of a picture, pixels. */
const MOST = 420;
export const MAX_OF_FILE = 105;
export const KEPT_HEIGHT = 200;

/** A kept picture: its time in seconds, and the part of the film it shows of a whole, pixels of the film. */
export interface Kept { seconds: number; bitmap: ImageBitmap; part: Region; whole: { width: number; height: number } }

export class Reel {
  private pictures: Kept[] = [];
  private last = -Infinity;
  /** factor from the times of findings to seconds */
  private unit = 1;

  /** `every`: initial seconds between pictures; `most`: maximum number */
  constructor(private every = 0, private readonly most = MOST) {}

  /** Whether a picture at a time would be kept. */
  wants(seconds: number): boolean { return seconds - this.last >= 0.98 * this.every; }

  /** Keeps a picture and takes over its ownership. */
  keep(picture: Kept): void {
    this.last = picture.seconds;
    this.pictures.push(picture);
    if (this.pictures.length < this.most) return;
    this.every = (2 * ((this.pictures.at(-1) as Kept).seconds - (this.pictures[0] as Kept).seconds)) / this.most;
    this.pictures = this.pictures.filter(({ bitmap }, k) => {
      if (k % 2 === 1) bitmap.close();
      return k % 2 === 0;
    });
  }

  /** Keeps a picture of findings, cut to the flame; its time is the frame number from 0, as the rate is unknown. */
  keepSeen({ picture, box, frame, width, height }: Seen): void {
    if (picture === undefined || !this.wants(frame)) return;
    const share = picture.width / width;
    const wanted = box === null ? { x: 0, y: 0, width, height } : around(box, width, height);
    const [x, y] = [Math.floor(share * wanted.x), Math.floor(share * wanted.y)];
    const [wide, tall] = [Math.max(1, Math.ceil(share * wanted.width)), Math.max(1, Math.ceil(share * wanted.height))];
    // Part of the film shown by the whole pixels that are copied, so that an outline drawn over them fits.
    const part = { x: x / share, y: y / share, width: wide / share, height: tall / share };
    createImageBitmap(picture, x, y, wide, tall, { resizeHeight: Math.min(tall, KEPT_HEIGHT), resizeQuality: 'medium' }).then(
      (bitmap) => this.keep({ seconds: this.unit * (frame - 1), bitmap, part, whole: { width, height } }),
      () => undefined,
    );
  }

  /** The picture nearest to a time; null if there is none. */
  at(seconds: number): Kept | null {
    const apart = (picture: Kept): number => Math.abs(picture.seconds - seconds);
    return this.pictures.reduce<Kept | null>((best, picture) => (best === null || apart(picture) < apart(best) ? picture : best), null);
  }

  /** Multiplies all times, which converts frame numbers to seconds. */
  scale(factor: number): void {
    this.unit *= factor;
    for (const picture of this.pictures) picture.seconds *= factor;
  }

  close(): void { for (const { bitmap } of this.pictures.splice(0)) bitmap.close(); }
}

/** Box of a flame with a margin, within the picture. */
export function around(box: Region, width: number, height: number): Region {
  const air = box.height;
  const x = Math.max(0, Math.floor(box.x - air));
  const y = Math.max(0, Math.floor(box.y - 0.6 * air));
  const [right, low] = [Math.ceil(box.x + box.width + air), Math.ceil(box.y + box.height + 0.6 * air)];
  return { x, y, width: Math.min(width, right) - x, height: Math.min(height, low) - y };
}
