// Models that come with the page, made by script/models from the candle rig and the leaf simulator.

export const FLAME = 'flame.wisp';
export const LEAF = 'leaf.wisp';

/** Fetches a file's bytes. Throws an Error on failure, with the HTTP status if there is one. */
export async function fetchBytes(url: string | URL, file: string): Promise<Uint8Array> {
  const answer = await fetch(url).catch(() => null);
  if (!answer?.ok) throw new Error(`${file} could not be fetched (${answer?.status ?? 'no network'}).`);
  return new Uint8Array(await answer.arrayBuffer());
}

export const fetchShipped = (file: string): Promise<Uint8Array> => fetchBytes(`./models/${file}`, file);
