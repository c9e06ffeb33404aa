// Computes the hash of a model's outputs in a worker, which loads the package itself.

import { hashOfLife } from './lives.mjs';

export function work({ load }) {
  self.onmessage = async ({ data: { model, frames } }) => {
    const wisp = await load();
    self.postMessage(hashOfLife(wisp, new Uint8Array(await (await fetch(model)).arrayBuffer()), frames));
  };
}
