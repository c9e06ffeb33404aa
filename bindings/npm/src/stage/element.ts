// Base of the package's elements: a canvas in a shadow root, a model, wind, and one WebAssembly module shared by all.

import { loadLibrary, once } from '../library.js';
import type { Model } from '../model.js';
import type { Microphone } from '../microphone.js';
import { Breath } from '../air/breath.js';
import { KeyBreath } from '../air/keys.js';
import type { Scene, SceneSettings } from './scene.js';
import { Stage } from './stage.js';

const STYLE = `
:host { display: block; position: relative; width: 300px; height: 400px; contain: strict; background: #07080c; color: #f3ece2; }
:host([clear]) { background: none; }
:host([hidden]) { display: none; }
canvas { width: 100%; height: 100%; display: block; touch-action: pan-y; outline: none; }
canvas:focus-visible { box-shadow: inset 0 0 0 2px #ffb35c; }
button { position: absolute; left: 50%; bottom: 10px; transform: translateX(-50%); padding: 8px 18px; min-height: 44px;
  border: 1px solid rgb(255 240 220 / 30%); border-radius: 999px; background: rgb(14 14 19 / 78%); color: inherit; font: inherit; cursor: pointer; }
button:focus-visible { outline: 2px solid #ffb35c; outline-offset: 2px; }
button[aria-pressed=true]::before { content: ''; display: inline-block; width: 8px; height: 8px; margin-right: 8px; border-radius: 50%; background: #ff6b57; }
p { position: absolute; inset: auto 6% 62px; margin: 0; text-align: center; font: inherit; font-size: 14px; text-shadow: 0 0 4px #000, 0 0 8px #000; }
[hidden] { display: none; }`;

/** CSS pixels covered by the button at the lower edge. */
const BUTTON = 56;

/** An empty class where there is no document, so that servers that render pages can import this file. */
const Base = (globalThis.HTMLElement ?? class {}) as typeof HTMLElement;

/** Registers an element once, where custom elements exist. */
export function define(name: string, element: typeof SceneElement & (new () => SceneElement)): void {
  if (globalThis.customElements !== undefined && !customElements.get(name)) customElements.define(name, element);
}

/** The library, loaded once for all elements of a page. */
const shared = once(() => loadLibrary());

/** Attributes of an element's tag in JSX. */
export interface SceneAttributes {
  src?: string;
  wind?: 'pointer' | 'mic' | 'none';
  seed?: number | string;
  noise?: number | string;
  clear?: boolean;
  [attribute: string]: unknown;
}

/** Numeric value of an attribute, clamped to a range; `otherwise` if missing. */
export function numberOf(element: Element, name: string, low: number, high: number, otherwise: number): number {
  const text = element.getAttribute(name);
  const value = text === null || text.trim() === '' ? NaN : Number(text);
  return Number.isFinite(value) ? Math.max(low, Math.min(high, value)) : otherwise;
}

/**
 * An element that plays a model. Attributes: `src`, the model's address; `wind`: `pointer` (default), `mic` or `none`;
 * `seed`; `noise`; `clear`: transparent canvas. Keys, when focused: arrows and Space blow, Enter acts.
 */
export abstract class SceneElement extends Base {
  static readonly observedAttributes: readonly string[] = ['src', 'wind', 'seed', 'noise', 'candles', 'leaves'];

  private readonly canvas = document.createElement('canvas');
  private readonly button = document.createElement('button');
  private readonly words = document.createElement('p');
  private readonly wind = new Breath();
  protected stage: Stage | null = null;
  private lacking = ''; // said while there is nothing else to say
  private model: Model | null = null;
  private microphone: Microphone | null = null;
  /** numbers of the latest load, and of the latest opening of the microphone; results of earlier ones are dropped */
  private turn = 0;
  private asked = 0;
  /** Scenes out of view are not drawn. */
  private readonly seen = new IntersectionObserver((entries) => {
    if (entries.at(-1)?.isIntersecting === true) this.stage?.loop.start();
    else this.stage?.loop.stop();
  });
  protected scene: Scene | null = null;

  constructor() {
    super();
    this.canvas.tabIndex = 0;
    this.canvas.setAttribute('role', 'img');
    this.button.type = 'button';
    this.button.hidden = true;
    this.button.addEventListener('click', () => void this.toggleMicrophone());
    this.words.hidden = true;
    this.words.setAttribute('role', 'status');
    const shadow = this.attachShadow({ mode: 'open' });
    // A constructed style sheet, as a page's policy may forbid inline ones.
    const sheet = new CSSStyleSheet();
    sheet.replaceSync(STYLE);
    shadow.adoptedStyleSheets = [sheet];
    shadow.append(this.canvas, this.words, this.button);
    this.listenToKeys();
  }

  /** Address of the model played when the attribute `src` is missing; null: the package has none. */
  protected abstract readonly usualModel: URL | null;
  protected abstract sceneOf(model: Model, settings: SceneSettings): Promise<Scene>;
  /** Number of candles or leaves. */
  protected abstract count(): number;
  /** Called after each frame; overridden by elements that dispatch events when the scene's state changes. */
  protected watch?(): void;

  connectedCallback(): void {
    this.stage ??= new Stage(this.canvas, {
      breath: (seconds) => (this.getAttribute('wind') === 'none' ? 0 : this.wind.update(seconds, this.stage?.frames ?? 0)),
      air: () => (this.getAttribute('wind') === 'none' ? { right: 0, away: 0 } : this.wind.air),
      touched: () => undefined,
      context: (state) => state === 'absent' && this.say((this.lacking = 'This browser shows no WebGL 2.')),
      framed: () => this.scene !== null && this.watch?.(),
    }, this.hasAttribute('clear'));
    this.stage.take();
    this.stage.loop.start();
    this.seen.observe(this);
    this.showWind();
    if (this.scene === null) void this.play();
  }

  disconnectedCallback(): void {
    this.seen.disconnect();
    this.stage?.loop.stop();
    this.closeMicrophone();
    this.wind.keys.held.clear(); // their release is not reported
    // Browsers allow about sixteen contexts. An element moved within the page is connected again before the timeout.
    setTimeout(() => this.isConnected || this.rest());
  }

  attributeChangedCallback(name: string, before: string | null, now: string | null): void {
    if (before === now || this.stage === null) return;
    if (name === 'src' || name === 'seed') void this.play();
    else if (name === 'wind') this.showWind();
    else this.scene?.apply(this.settings());
    this.stage.relabel();
  }

  /** The scene's own action: lights candles, kicks leaves. */
  act(): void {
    this.scene?.act();
  }

  /** Gives context, scene and model back; an element put into a page again plays its model anew. */
  private rest(): void {
    this.turn += 1;
    this.stage?.giveBack();
    this.model?.free();
    this.scene = this.model = null;
  }

  private settings(): SceneSettings {
    const calm = matchMedia('(prefers-reduced-motion: reduce)').matches;
    return {
      seed: Math.round(numberOf(this, 'seed', 0, 2 ** 32 - 1, 1)),
      noise: numberOf(this, 'noise', 0, 2, calm ? 0.3 : 1),
      count: this.count(),
    };
  }

  private async play(): Promise<void> {
    const turn = ++this.turn;
    const src = this.getAttribute('src');
    let model: Model | null = null;
    try {
      const url = src === null ? this.usualModel : new URL(src, document.baseURI);
      if (url === null) throw new Error(`${this.localName} needs src, the address of a model.`);
      const [library, answer] = await Promise.all([shared(), fetch(url)]);
      if (!answer.ok) throw new Error(`${url.pathname.split('/').pop() ?? 'the model'} could not be fetched (${answer.status})`);
      model = library.model(await answer.arrayBuffer());
      const scene = await this.sceneOf(model, this.settings());
      if (turn !== this.turn || !this.isConnected) {
        scene.dispose();
        model.free();
        return;
      }
      this.stage?.show(scene);
      this.model?.free();
      [this.scene, this.model] = [scene, model];
      this.say('');
      this.dispatchEvent(new Event('load'));
    } catch (error) {
      if (model !== this.model) model?.free();
      if (turn !== this.turn) return;
      this.say(error instanceof Error ? error.message : String(error));
      this.dispatchEvent(new ErrorEvent('error', { error, message: this.words.textContent ?? '' }));
    }
  }

  private say(words: string): void {
    this.words.textContent = words || this.lacking;
    this.words.hidden = this.words.textContent === '';
  }

  private showWind(): void {
    const wind = this.getAttribute('wind') ?? 'pointer';
    if (this.stage !== null) {
      this.stage.still = wind === 'none';
      this.stage.covered = wind === 'mic' ? BUTTON : 0;
    }
    this.button.hidden = wind !== 'mic';
    if (wind !== 'mic') this.closeMicrophone();
    this.showButton('Blow');
  }

  private showButton(words: string): void {
    const open = this.microphone !== null;
    this.button.textContent = words;
    this.button.setAttribute('aria-pressed', String(open));
    this.button.setAttribute('aria-label', open ? `${words}: microphone off` : `${words}: microphone on`);
  }

  private async toggleMicrophone(): Promise<void> {
    if (this.microphone?.asleep === true) return; // the click has resumed the sound
    if (this.microphone !== null) return this.closeMicrophone();
    const asked = ++this.asked;
    this.say('');
    try {
      // Loaded only when the user wants to blow.
      const [library, { openMicrophone }] = await Promise.all([shared(), import('../microphone.js')]);
      const opened = await openMicrophone(library, {
        onWind: ({ wind }) => this.wind.hear(wind, this.stage?.frames ?? 0),
        onAsleep: (asleep) => {
          this.wind.deafen();
          this.showButton(asleep ? 'Tap to wake' : 'Listening');
        },
        onLost: (error) => {
          this.closeMicrophone();
          this.say(error.message);
        },
      });
      if (asked !== this.asked || !this.isConnected) return opened.stop();
      this.microphone = opened;
      this.showButton('Listening');
    } catch (error) {
      this.say(error instanceof Error ? error.message : String(error));
    }
  }

  private closeMicrophone(): void {
    this.asked += 1;
    this.microphone?.stop();
    this.microphone = null;
    this.wind.deafen();
    this.showButton('Blow');
  }

  private listenToKeys(): void {
    this.canvas.addEventListener('keydown', (event) => {
      if (event.ctrlKey || event.metaKey || event.altKey) return;
      if (event.key === 'Enter') this.act();
      else if (KeyBreath.blows(event.code)) this.wind.keys.held.add(event.code);
      else return;
      event.preventDefault();
    });
    this.canvas.addEventListener('keyup', (event) => this.wind.keys.held.delete(event.code));
    this.canvas.addEventListener('blur', () => this.wind.keys.held.clear());
  }
}
