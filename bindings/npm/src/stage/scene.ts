// What the stage asks of a scene. A scene lives without a picture too: the picture comes and goes with the context.

import type { Bank, Model } from '../index.js';

/** The pointer during one frame. Pixels of the canvas, y up from its lower edge. */
export interface Pointer {
  x: number;
  y: number;
  /** where it was a frame ago */
  fromX: number;
  fromY: number;
  /** pixels a second, smoothed over some 30 ms */
  speedX: number;
  speedY: number;
  /** over the canvas, or touching it */
  present: boolean;
}

/** Wind along the table as the eye sees it: to its right, and away from it. */
export interface Air {
  right: number;
  away: number;
}

/** What acts on a scene during one frame. */
export interface Acting {
  /** time since the last frame, as scenes count it: at most a tenth of a second, 0 while paused */
  seconds: number;
  /** from microphone and keys together, signed towards the right, 1 is a strong breath: for what is blown along one line */
  breath: number;
  /** the same for what stands in the round */
  air?: Air;
  pointer: Pointer;
}

/** What the drawer plots of the last frame. */
export interface Reading {
  /** in the model's own unit */
  wind: number;
  /** what the wind moves */
  answer: number;
}

/** Settings that scenes share; each takes what it knows. */
export interface SceneSettings {
  seed: number;
  /** scale of the learned noise */
  noise: number;
  /** how many candles, or leaves */
  count: number;
  /** a number that stands on a cake in figures, whose name is on it, and what its smoke says */
  figures?: string;
  name?: string;
  wish?: string;
}

/** How a picture is to be drawn. */
export interface SceneLook {
  /** 0 black, 1 all of it */
  fade: number;
  /** share of the picture's height that controls cover below */
  footer: number;
  /** what burns or falls alone, without a room around it */
  clear: boolean;
  /** without what costs most: frames come too slowly */
  plain: boolean;
}

export interface Scene {
  readonly model: Model;
  readonly bank: Bank;
  /** what the answer of a reading is called */
  readonly answerName: string;
  /** Lets time pass. Allocates nothing large: it runs every frame. */
  update(acting: Acting): void;
  reading(): Reading;
  /** Makes what the graphics card holds; once more after it lost that. */
  attach(gl: WebGL2RenderingContext): void;
  /** Draws on the canvas of the attached context. False: what it needs is still to come, and nothing was drawn. */
  draw(width: number, height: number, look: SceneLook): boolean;
  /** Says what pressing there would take hold of; for the shape of the pointer. */
  hover(x: number, y: number): 'none' | 'grab';
  press(x: number, y: number): void;
  /** `tap`: it did not move in between */
  release(x: number, y: number, tap: boolean): void;
  /** What the key of the scene's own action does: lights candles, kicks leaves. */
  act(): void;
  apply(settings: SceneSettings): void;
  /** Leaves in the air and on the ground, in a scene that has any. */
  leaves?(): { count: number; lying: number };
  /** A sentence about what is to be seen, for who does not see it. */
  describe(): string;
  dispose(): void;
}
