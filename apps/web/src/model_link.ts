// A model in a link: packed into the link itself, or at an address of the page's own origin.

import { fetchBytes } from './shipped.js';

/** Prefix of packed models (no address begins so): the compressed bytes follow in base64url. */
const PACKED = 'packed,';
/** Maximum size of a model in a link, bytes before packing; programs truncate longer links. */
export const MAX_PACKED_BYTES = 24_000;

async function through(bytes: Uint8Array, stream: CompressionStream | DecompressionStream): Promise<Uint8Array> {
  return new Uint8Array(await new Response(new Blob([bytes.slice()]).stream().pipeThrough(stream)).arrayBuffer());
}

/** Value of `model=` that contains these bytes. */
export async function packModel(bytes: Uint8Array): Promise<string> {
  const packed = await through(bytes, new CompressionStream('deflate-raw'));
  const letters = Array.from(packed, (byte) => String.fromCharCode(byte)).join('');
  return PACKED + btoa(letters).replaceAll('+', '-').replaceAll('/', '_').replace(/=+$/, '');
}

/** Bytes and file name for a value of `model=`. Throws an Error with a sentence for people. */
export async function fetchModel(value: string): Promise<{ bytes: Uint8Array; file: string }> {
  if (value.startsWith(PACKED)) {
    try {
      const letters = atob(value.slice(PACKED.length).replaceAll('-', '+').replaceAll('_', '/'));
      const packed = Uint8Array.from(letters, (letter) => letter.charCodeAt(0));
      return { bytes: await through(packed, new DecompressionStream('deflate-raw')), file: 'from-a-link.wisp' };
    } catch {
      throw new Error('The model in this link is damaged: was the link cut?');
    }
  }
  const url = new URL(value, location.href);
  if (url.origin !== location.origin) throw new Error(`A link can name models of ${location.host} only, not of ${url.host}.`);
  const file = url.pathname.split('/').pop() ?? 'model.wisp';
  return { bytes: await fetchBytes(url, file), file };
}
