// Facts of a model in words and numbers.

import type { Model } from '@wisp/player';
import { definitions, element } from './element.js';
import { inWords, number } from './figures.js';

type Fact = readonly [string, string];

const KINDS: Readonly<Record<Model['view'], string>> = {
  outline: 'an outline',
  pose: 'a body that tumbles',
  position: 'a thing that moves',
  plain: 'numbers',
};

function inputOf({ name, unit, lowest, highest }: Model['inputs'][number]): string {
  // Leaves out units such as "0.73 1": a scale of 0.73 on an input that the recording gave no unit ("1").
  const said = unit === '' || /1$/.test(unit) ? '' : ` ${unit}`;
  return `${name}, ${number(lowest, 2)} to ${number(highest, 2)}${said}`;
}

function commonFacts(model: Model, bytes: number): Fact[] {
  const { facts } = model;
  return [
    ['Name', model.name || 'none given'],
    ['What it is', KINDS[model.view]],
    ['Moved by', model.inputs.map(inputOf).join(', ') || 'nothing: it has no input'],
    ['File', bytes < 20_000 ? `${number(bytes)} bytes` : `${number(bytes / 1000)} kB`],
    ['Its own clock', `${number(facts.rateHz)} steps a second`],
    ['Cost of a step', `${number(facts.operationsPerFrame)} operations`],
  ];
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

// Quality figures of the model, with the range of good values.
function figuresOf(model: Model): HTMLElement[] {
  const { figures } = model.provenance;
  if (figures.length === 0) return [];
  const made = figures.flatMap(({ name, value }) => {
    const { words, value: shown, good } = inWords(name, value);
    return [element('dt', {}, words, ...(good === '' ? [] : [element('small', {}, `good: ${good}`)])), element('dd', {}, shown)];
  });
  return [element('h3', {}, 'How well it does'), element('dl', { class: 'figures' }, ...made)];
}

/** All facts, as shown in the drawer. */
export function factsOf(model: Model, bytes: number): HTMLElement {
  const { provenance } = model;
  const made: Fact[] = [['By', provenance.program]];
  if (provenance.sources.length > 0) made.push(['From', provenance.sources.join(', ')]);
  made.push(['Fit for use', provenance.usable ? 'yes' : `no: ${provenance.reason}`]);
  return element(
    'section',
    {},
    element('h3', {}, 'The model'),
    element('dl', {}, ...definitions([...commonFacts(model, bytes), ...flameFacts(model), ...chainFacts(model)])),
    ...figuresOf(model),
    element('h3', {}, 'How it was made'),
    element('dl', {}, ...definitions(made)),
  );
}
