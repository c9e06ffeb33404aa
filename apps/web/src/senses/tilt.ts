// A phone that is tilted makes wind: what it leans to from how it was held before.

import type { Air } from '@wisp/player/parts/stage/scene';

/** Degrees from rest that blow as a strong breath. */
const STRONG = 38;
const MOST = 1;
/** Seconds after which a new way to hold it is rest. */
const FORGETS = 4;

interface Asking {
  requestPermission?: () => Promise<'granted' | 'denied'>;
}

/** One of the phone's angles, degrees. */
class Angle {
  private rest: number | null = null;
  private now = 0;

  get wind(): number {
    if (this.rest === null) return 0;
    const lean = (this.now - this.rest) / STRONG;
    return Math.max(-MOST, Math.min(MOST, Math.abs(lean) < 0.12 ? 0 : lean));
  }

  take(degrees: number | null, seconds: number): void {
    if (degrees === null) return;
    this.now = degrees;
    this.rest = this.rest === null ? degrees : this.rest + (degrees - this.rest) * (1 - Math.exp(-seconds / FORGETS));
  }
}

export class Tilt {
  private sideways = new Angle();
  private forwards = new Angle();
  private at = 0;
  private readonly listener = (event: DeviceOrientationEvent): void => {
    const seconds = Math.min(1, Math.max(0, (event.timeStamp - this.at) / 1000));
    this.at = event.timeStamp;
    this.sideways.take(event.gamma, seconds);
    this.forwards.take(event.beta, seconds);
  };

  /** Asks, where that has to be asked; then listens. */
  async open(): Promise<void> {
    if (typeof DeviceOrientationEvent === 'undefined') return;
    const { requestPermission } = DeviceOrientationEvent as Asking;
    if (requestPermission !== undefined && (await requestPermission()) !== 'granted') return;
    window.addEventListener('deviceorientation', this.listener);
  }

  close(): void {
    window.removeEventListener('deviceorientation', this.listener);
    this.sideways = new Angle();
    this.forwards = new Angle();
  }

  /** 1 is strong. A phone whose upper edge goes down leans away. */
  get air(): Air {
    return { right: this.sideways.wind, away: -this.forwards.wind };
  }
}
