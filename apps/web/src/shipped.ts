// Models that come with the page. script/models makes them, from the candle rig and the leaf simulator.

export interface Shipped {
  url: string;
  /** how the file is called when it is saved */
  file: string;
}

/** The flame of the default recipe (0), or of point systems of that order. */
export function shippedFlame(order: number): Shipped {
  const file = order === 0 ? 'flame.wisp' : `flame-${order}.wisp`;
  return { url: `./models/${file}`, file };
}

export const SHIPPED_LEAF: Shipped = { url: './models/leaf.wisp', file: 'leaf.wisp' };

/** Fetches a shipped model's bytes. Throws an Error that says so when they are not there. */
export async function fetchShipped({ url, file }: Shipped): Promise<Uint8Array> {
  const answer = await fetch(url);
  if (!answer.ok) throw new Error(`${file} could not be fetched (${answer.status}).`);
  return new Uint8Array(await answer.arrayBuffer());
}
