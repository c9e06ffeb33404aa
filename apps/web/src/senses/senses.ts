// Tilt and touch, opt-in: tilting a phone from its rest position makes wind, rotating it about the vertical moves the
// eye round the candle, and the phone vibrates when a flame goes out.

import type { Air } from '@wisp/player/parts/stage/scene';

/** Radians of tilt that make a strong breath, and the share of them ignored as trembling. */
const STRONG = 0.66;
const TREMBLES = 0.12;
/** Time constant in seconds with which the rest position follows. */
const FORGETS = 4;
/** Maximum radians between readings; larger differences are sensor jumps. */
const JUMP = 0.5;
/** Milliseconds of vibration when a flame goes out. */
const VIBRATES = 40;

/** One angle of the phone; its deviation from a slowly following rest position is wind. */
class Angle {
  private rest: number | null = null;
  private now = 0;

  get wind(): number {
    const lean = (this.now - (this.rest ?? this.now)) / STRONG;
    return Math.max(-1, Math.min(1, Math.abs(lean) < TREMBLES ? 0 : lean));
  }

  take(radians: number): void {
    this.now = radians;
    this.rest ??= radians;
  }

  pass(seconds: number): void {
    if (this.rest !== null) this.rest += (this.now - this.rest) * (1 - Math.exp(-seconds / FORGETS));
  }
}

/** Angles of the picture, radians: roll, positive with the right edge down; pitch, with the upper edge up; azimuth. */
function lie({ alpha, beta, gamma }: DeviceOrientationEvent): [roll: number, pitch: number, heading: number] | null {
  if (alpha === null || beta === null || gamma === null) return null;
  const [a, b, c, held] = [alpha, beta, gamma, window.screen.orientation?.angle ?? 0].map((degrees) => (degrees * Math.PI) / 180) as [number, number, number, number];
  // The vertical in the phone's axes, and its x and y axes from above: the angles jump when the phone is upright.
  const up = [-Math.cos(b) * Math.sin(c), Math.sin(b), Math.cos(b) * Math.cos(c)] as const;
  const first = [Math.cos(a) * Math.cos(c) - Math.sin(a) * up[1] * Math.sin(c), Math.sin(a) * Math.cos(c) + Math.cos(a) * up[1] * Math.sin(c)] as const;
  const second = [-Math.sin(a) * Math.cos(b), Math.cos(a) * Math.cos(b)] as const;
  const right = (x: number, y: number): number => Math.cos(held) * x - Math.sin(held) * y;
  return [
    -Math.asin(Math.max(-1, Math.min(1, right(up[0], up[1])))),
    Math.atan2(Math.sin(held) * up[0] + Math.cos(held) * up[1], up[2]),
    Math.atan2(right(first[1], second[1]), right(first[0], second[0])),
  ];
}

export class Senses {
  on = false;
  private burning = 0;
  private sideways = new Angle();
  private forwards = new Angle();
  private heading: number | null = null;
  private at = 0;
  private turn = 0;
  private readonly listener = (event: DeviceOrientationEvent): void => {
    const angles = lie(event);
    if (angles === null) return;
    const [roll, pitch, heading] = angles;
    this.sideways.take(roll);
    this.forwards.take(pitch);
    const turned = Math.atan2(Math.sin(heading - (this.heading ?? heading)), Math.cos(heading - (this.heading ?? heading)));
    if (Math.abs(turned) < JUMP) this.turn += turned;
    this.heading = heading;
  };

  /** Toggles tilt and vibration. Call it in a press or key handler, as browsers allow the request only there. */
  toggle(): void {
    this.on = !this.on;
    if (!this.on) this.close();
    // If the request is refused, the phone vibrates without tilt.
    else this.open().catch(() => undefined);
  }

  frame(lit: number): void {
    if (lit < this.burning && this.on) navigator.vibrate?.(VIBRATES);
    this.burning = lit;
  }

  /** Requests permission where needed, then listens. */
  private async open(): Promise<void> {
    if (typeof DeviceOrientationEvent === 'undefined') return;
    const { requestPermission } = DeviceOrientationEvent as { requestPermission?: () => Promise<'granted' | 'denied'> };
    if (requestPermission !== undefined && (await requestPermission()) !== 'granted') return;
    window.addEventListener('deviceorientation', this.listener);
  }

  private close(): void {
    window.removeEventListener('deviceorientation', this.listener);
    this.sideways = new Angle();
    this.forwards = new Angle();
    this.heading = null;
  }

  /** Wind from tilt: 1 is strong. Lowering the upper edge blows away. Decays to 0, also when readings stop. */
  get air(): Air {
    const seconds = (performance.now() - this.at) / 1000;
    this.at += 1000 * seconds;
    for (const angle of [this.sideways, this.forwards]) angle.pass(seconds);
    return { right: this.sideways.wind, away: -this.forwards.wind };
  }

  /** Radians of rotation since the last call, anticlockwise from above. 0 for users who prefer reduced motion. */
  turned(): number {
    const { turn } = this;
    this.turn = 0;
    return document.body.classList.contains('calm') ? 0 : turn;
  }
}
