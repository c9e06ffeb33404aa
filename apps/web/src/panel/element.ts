// Creation of DOM elements in one expression.

/** Attributes by name; functions listen to the event of that name. */
export type Attributes = Record<string, string | boolean | number | ((event: Event) => unknown)>;

/** Creates an element with attributes, listeners and children; strings become text, never markup. */
export function element<Tag extends keyof HTMLElementTagNameMap>(
  tag: Tag,
  attributes: Attributes = {},
  ...children: (Node | string)[]
): HTMLElementTagNameMap[Tag] {
  return filled(document.createElement(tag), attributes, children);
}

/** Creates an SVG element with attributes, listeners and children. */
export function drawing<Tag extends keyof SVGElementTagNameMap>(tag: Tag, attributes: Attributes, ...children: SVGElement[]): SVGElementTagNameMap[Tag] {
  return filled(document.createElementNS('http://www.w3.org/2000/svg', tag), attributes, children);
}

function filled<Made extends Element>(made: Made, attributes: Attributes, children: readonly (Node | string)[]): Made {
  for (const [name, value] of Object.entries(attributes)) {
    if (typeof value === 'function') made.addEventListener(name, value);
    else if (value !== false) made.setAttribute(name, value === true ? '' : String(value));
  }
  made.append(...children);
  return made;
}

export const button = (words: string, act: () => unknown, attributes: Attributes = {}): HTMLButtonElement =>
  element('button', { type: 'button', class: 'tool', click: act, ...attributes }, words);

export const closeButton = (close: () => unknown): HTMLButtonElement => button('×', close, { class: 'tool round', 'aria-label': 'Close' });

/** Names and values of a description list. */
export const definitions = (facts: readonly (readonly [name: string, value: string])[]): HTMLElement[] =>
  facts.flatMap(([name, value]) => [element('dt', {}, name), element('dd', {}, value)]);

/** Returns the element with an id. Throws if it is missing or of another kind, as with a page of another version. */
export function byId<Kind extends HTMLElement>(id: string, kind: new () => Kind): Kind {
  const found = document.getElementById(id);
  if (!(found instanceof kind)) throw new Error(`the page has no ${kind.name} #${id}`);
  return found;
}
