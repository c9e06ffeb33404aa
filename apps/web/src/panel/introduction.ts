// Introduction in the drawer: what the model is and what it was learned from, as far as its file says.

import type { Model } from '@wisp/player';

const list = (names: readonly string[]): string =>
  names.length < 2 ? (names[0] ?? '') : `${names.slice(0, -1).join(', ')} and ${names[names.length - 1] as string}`;

function taught(model: Model, shipped: boolean): string {
  if (shipped) {
    return model.view === 'outline'
      ? 'This flame was taught by the candle simulator that comes with Wisp; learn one from a film of yours under Yours.'
      : 'This leaf was taught by the leaf simulator that comes with Wisp.';
  }
  const { sources, program } = model.provenance;
  return sources.length === 0 ? `Its file says that ${program} made it, and not from what.` : `It was learned from ${list(sources)} by ${program}.`;
}

function wind(model: Model, borrows: boolean): string {
  if (model.inputs.length > 0) return '';
  return borrows
    ? ' It has never felt wind: how it leans and goes out is borrowed from the flame that comes with this page.'
    : ' It has no input: wind does not reach it.';
}

/** Two or three sentences. `borrows`: the wind response is the shipped flame's. */
export function introductionTo(model: Model, shipped: boolean, borrows: boolean): string {
  return `${motionOf(model)} ${taught(model, shipped)}${wind(model, borrows)}`;
}

function motionOf({ view, kind, arx, inputs, outputs }: Model): string {
  if (view === 'outline') {
    const order = Math.max(...(arx?.na.flat() ?? [0]));
    const what = arx && arx.na.length !== outputs.length ? 'Each component of the shape' : 'Each point of the outline';
    return `Nothing here is animated by hand. ${what} follows an equation in its last ${order} steps${inputs.length > 0 ? ' and the wind' : ''}.`;
  }
  if (kind === 'chain') return 'Nothing here is animated by hand. Pieces of recorded motion follow each other by chance, as often as they were seen to.';
  return 'What the model does, number by number.';
}
