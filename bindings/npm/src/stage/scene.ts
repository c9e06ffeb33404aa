// Interface between stage and scene. A scene also lives without a picture, as the context comes and goes.

/** The pointer during one frame. Pixels of the canvas, y up from its lower edge. */
export interface Pointer {
  x: number;
  y: number;
  /** position one frame ago */
  fromX: number;
  fromY: number;
  /** pixels a second, averaged over 35 ms */
  speedX: number;
  speedY: number;
  /** whether it is over the canvas or touching it */
  present: boolean;
}

/** Wind along the table relative to the eye: to its right, and away from it. */
export type Air = Record<'right' | 'away', number>;

/** Influences on a scene during one frame. */
export interface Acting {
  /** seconds since the last frame in scene time: at most 0.1, 0 while paused */
  seconds: number;
  /** from microphone and keys, positive to the right, 1 is a strong breath: for scenes blown along one axis */
  breath: number;
  /** the breath as a vector, for bodies */
  air: Air;
  pointer: Pointer;
}

/** Values of the last frame plotted by the drawer. */
export interface Reading {
  /** wind in the model's unit */
  wind: number;
  /** response to the wind */
  answer: number;
}

/** Settings shared by scenes; each uses those that it knows. */
export interface SceneSettings {
  /** read when the scene is made */
  seed: number;
  /** scale of the learned noise */
  noise: number;
  /** number of candles or leaves */
  count: number;
  /** number shown as digit candles; name on the cake; text written by smoke */
  figures?: string;
  name?: string;
  wish?: string;
}

/** Options for drawing a picture. */
export interface SceneLook {
  /** brightness from 0 (black) to 1 (full) */
  fade: number;
  /** share of the picture's height covered by controls below */
  footer: number;
  /** whether to draw only the burning or falling things, without a room */
  clear: boolean;
  /** whether to leave out expensive effects, because frames are slow */
  plain: boolean;
}

export interface Scene {
  /** name of a reading's response */
  readonly answerName: string;
  /** Advances by a time. Runs every frame, so it must not allocate much. */
  update(acting: Acting): void;
  reading(): Reading;
  /** Creates the resources on the graphics card; again after they were lost. */
  attach(gl: WebGL2RenderingContext): void;
  /** Draws to the canvas of the attached context. Returns false, drawing nothing, while parts are loading. */
  draw(width: number, height: number, look: SceneLook): boolean;
  /** 'grab' if a press at a place would take hold of something; absent in scenes without things to grab. */
  hover?(x: number, y: number): 'none' | 'grab';
  press?(x: number, y: number): void;
  /** `tap`: the pointer did not move in between */
  release?(x: number, y: number, tap: boolean): void;
  /** The scene's own action: lights candles, kicks leaves. */
  act(): void;
  apply(settings: SceneSettings): void;
  /** Number of all leaves, and of those on the ground, in a scene with leaves. */
  leaves?(): { count: number; lying: number };
  /** A sentence that describes the picture, for screen readers. */
  describe(): string;
  dispose(): void;
}
