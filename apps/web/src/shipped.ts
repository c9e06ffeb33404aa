// Models that come with the page, made by script/models from the candle rig and the leaf simulator.

export interface Shipped {
  url: string;
  /** name of the file when saved */
  file: string;
}

export const SHIPPED_FLAME: Shipped = { url: './models/flame.wisp', file: 'flame.wisp' };
export const SHIPPED_LEAF: Shipped = { url: './models/leaf.wisp', file: 'leaf.wisp' };

/** Fetches a shipped model's bytes. Throws an Error that says so where they are missing. */
export async function fetchShipped({ url, file }: Shipped): Promise<Uint8Array> {
  const answer = await fetch(url);
  if (!answer.ok) throw new Error(`${file} could not be fetched (${answer.status}).`);
  return new Uint8Array(await answer.arrayBuffer());
}
