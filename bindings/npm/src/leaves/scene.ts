// Endlessly falling leaves in autumn light, which settle and are kicked up again.

import type { Bank, Model } from '../index.js';
import { MAX_LEAVES } from './limits.js';
import type { Acting, Reading, Scene, SceneLook, SceneSettings } from '../stage/scene.js';
import { LeafCamera } from './camera.js';
import { LeafFall, type Gust } from './fall.js';
import { LeafRenderer } from './renderer.js';

/** Depth of the pointer's gusts, metres. */
const STIRRED_DEPTH = 0.4;
/** Maximum wind of the pointer, metres a second, and wind as a share of the pointer's speed. */
const STRONGEST = 4.5;
const CARRIED = 0.75;
/** Wind at a breath of 1, metres a second. */
const BREATH = 2.2;
/** Duration of a kick, seconds. */
const KICKS = 0.25;

/** Half width and half length of a leaf whose model lacks its size, metres. */
const USUAL_HALF_SIZE = [0.0245, 0.0365] as const;

export class LeavesScene implements Scene {
  private readonly bank: Bank;
  readonly answerName = 'share in the air';
  private readonly camera = new LeafCamera();
  private readonly fall: LeafFall;
  private renderer: LeafRenderer | null = null;
  private clock = 0;
  private kickLeft = 0;
  private readonly gust: Gust = { x: 0, z: 0, speedX: 0, speedZ: 0, everywhere: 0, kick: 0, kickX: 0, kickY: STIRRED_DEPTH, kickReach: 1 };

  constructor(private readonly model: Model, settings: SceneSettings) {
    this.bank = model.bank({ capacity: MAX_LEAVES, seed: settings.seed });
    this.fall = new LeafFall(this.bank, this.camera, settings.seed);
    this.apply(settings);
  }

  update(acting: Acting): void {
    const { pointer, seconds } = acting;
    const { gust, camera } = this;
    this.clock += seconds;
    gust.everywhere = BREATH * acting.breath;
    const metre = (2 * camera.half[1] * (STIRRED_DEPTH - camera.eye[1])) / Math.max(1, camera.height);
    [gust.x, gust.z] = camera.at(pointer.x, pointer.y, STIRRED_DEPTH);
    const wind = (speed: number): number => (pointer.present ? Math.max(-STRONGEST, Math.min(STRONGEST, CARRIED * metre * speed)) : 0);
    [gust.speedX, gust.speedZ] = [wind(pointer.speedX), wind(pointer.speedY)];
    this.kickLeft = Math.max(0, this.kickLeft - seconds);
    gust.kick = this.kickLeft / KICKS;
    this.fall.update(seconds, gust);
  }

  reading(): Reading {
    const { count, lying } = this.fall;
    const wind = this.gust.everywhere + Math.hypot(this.gust.speedX, this.gust.speedZ);
    return { wind, answer: count === 0 ? 0 : 1 - lying / count };
  }

  attach(gl: WebGL2RenderingContext): void {
    this.renderer = new LeafRenderer(gl);
  }

  draw(width: number, height: number, { fade }: SceneLook): boolean {
    if (this.camera.width !== width || this.camera.height !== height) this.camera.frame(width, height);
    const { halfWidth, halfLength } = this.model.facts;
    const size = halfWidth > 0 ? ([halfWidth, halfLength > 0 ? halfLength : halfWidth] as const) : USUAL_HALF_SIZE;
    this.renderer?.draw(this.camera, this.fall.shown, this.fall.count, size, this.clock, fade);
    return true;
  }

  release(x: number, y: number, tap: boolean): void {
    if (!tap) return;
    // A tap in the air kicks the leaves on the ground below.
    const [near] = this.camera.at(x, y, STIRRED_DEPTH);
    Object.assign(this.gust, { kickX: near, kickY: this.groundDepth(y), kickReach: 0.9 });
    this.kickLeft = KICKS;
  }

  act(): void {
    Object.assign(this.gust, { kickX: 0, kickY: 0.6, kickReach: 2.4 });
    this.kickLeft = 2 * KICKS;
  }

  apply(settings: SceneSettings): void {
    this.bank.setNoise(settings.noise);
    this.fall.want(settings.count);
  }

  leaves(): { count: number; lying: number } {
    return { count: this.fall.count, lying: this.fall.lying };
  }

  describe(): string {
    return `Leaves fall in autumn light, ${this.fall.wanted} of them.`;
  }

  dispose(): void {
    this.renderer?.dispose();
    this.bank.free();
  }

  private groundDepth(pixelY: number): number {
    const [, low] = this.camera.at(0, pixelY, STIRRED_DEPTH);
    const eye = this.camera.eye;
    const slope = (low - eye[2]) / (STIRRED_DEPTH - eye[1]);
    if (slope >= -0.1) return STIRRED_DEPTH;
    return Math.max(-1, Math.min(3, eye[1] - eye[2] / slope));
  }
}
