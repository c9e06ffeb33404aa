// What a model says of itself, in words and numbers that people read.

import type { Model } from '@wisp/player';
import { element } from './element.js';

type Fact = readonly [string, string];

const number = (value: number, digits = 3): string =>
  Number.isInteger(value) ? value.toLocaleString('en') : Number(value.toPrecision(digits)).toLocaleString('en', { maximumSignificantDigits: digits });

const KINDS: Readonly<Record<Model['view'], string>> = {
  outline: 'an outline that wind moves',
  pose: 'a body that tumbles',
  position: 'a thing that moves',
  plain: 'numbers',
};

function commonFacts(model: Model, bytes: number): Fact[] {
  const { facts } = model;
  const list: Fact[] = [
    ['Name', model.name || 'none given'],
    ['What it is', KINDS[model.view]],
    ['File', bytes < 20_000 ? `${number(bytes)} bytes` : `${number(bytes / 1000)} kB`],
    ['Its own clock', `${number(facts.rateHz)} steps a second`],
    ['Cost of a step', `${number(facts.operationsPerFrame)} operations`],
  ];
  return list;
}

function flameFacts(model: Model): Fact[] {
  const { arx } = model;
  const { blowOut } = model.facts;
  const list: Fact[] = [];
  if (arx !== null) {
    list.push(['Looks back', `${Math.max(...arx.na.flat())} steps`]);
    list.push(['Coefficients', number(model.facts.multiplyAddsPerFrame)]);
  }
  if (model.view === 'outline') list.push(['Control points', number(model.facts.controlPoints)]);
  if (blowOut !== null) {
    list.push(['Goes out at wind', `${number(blowOut.level)} for ${number(blowOut.seconds, 2)} s`]);
  }
  return list;
}

function chainFacts(model: Model): Fact[] {
  const { chain } = model;
  if (chain === null) return [];
  return [
    ['Kinds of motion', number(chain.modes)],
    ['Recorded pieces', number(chain.segments.length)],
    ['Remembers', `${chain.history} ${chain.history === 1 ? 'piece' : 'pieces'}`],
    ['Answers to gusts', chain.gustOrder > 0 ? 'yes' : 'no'],
  ];
}

function list(facts: readonly Fact[]): HTMLElement {
  const made = element('dl');
  for (const [name, value] of facts) made.append(element('dt', {}, name), element('dd', {}, value));
  return made;
}

// Which kind of motion follows which: a row for the one before, brighter where it is likelier.
function transitions(model: Model): HTMLElement[] {
  const { chain } = model;
  if (chain === null) return [];
  const grid = element('div', { class: 'matrix', role: 'img', 'aria-label': 'How likely each kind of motion follows each' });
  grid.style.gridTemplateColumns = `repeat(${chain.modes}, 1fr)`;
  chain.transitions.forEach((row, from) =>
    row.forEach((chance, to) => {
      const cell = element('i', { title: `${from + 1} → ${to + 1}: ${Math.round(100 * chance)} %` });
      cell.style.background = `rgb(255 179 92 / ${(6 + 94 * Math.sqrt(chance)).toFixed(0)}%)`;
      grid.append(cell);
    }),
  );
  return [element('h3', {}, 'Which kind of motion follows which'), grid];
}

/** All of it, as the drawer shows it. */
export function factsOf(model: Model, bytes: number): HTMLElement {
  const { provenance } = model;
  const figures = provenance.figures.slice(0, 10).map(({ name, value }): Fact => [name.replaceAll('_', ' '), number(value)]);
  const made: Fact[] = [['By', provenance.program]];
  if (provenance.sources.length > 0) made.push(['From', provenance.sources.join(', ')]);
  made.push(['Fit for use', provenance.usable ? 'yes' : `no: ${provenance.reason}`]);
  return element(
    'section',
    {},
    element('h3', {}, 'The model'),
    list([...commonFacts(model, bytes), ...flameFacts(model), ...chainFacts(model)]),
    ...transitions(model),
    ...(figures.length > 0 ? [element('h3', {}, 'How well it does'), list(figures)] : []),
    element('h3', {}, 'How it was made'),
    list(made),
  );
}
