// A phone that is tilted makes wind: what it leans to from how it was held before.

/** Degrees from rest that blow as a strong breath. */
const STRONG = 38;
const MOST = 1;
/** Seconds after which a new way to hold it is rest. */
const FORGETS = 4;

interface Asking {
  requestPermission?: () => Promise<'granted' | 'denied'>;
}

export class Tilt {
  private rest: number | null = null;
  private now = 0;
  private at = 0;
  private readonly listener = (event: DeviceOrientationEvent): void => this.take(event.gamma, event.timeStamp);

  /** Asks, where that has to be asked; then listens. */
  async open(): Promise<void> {
    if (typeof DeviceOrientationEvent === 'undefined') return;
    const { requestPermission } = DeviceOrientationEvent as Asking;
    if (requestPermission !== undefined && (await requestPermission()) !== 'granted') return;
    window.addEventListener('deviceorientation', this.listener);
  }

  close(): void {
    window.removeEventListener('deviceorientation', this.listener);
    this.rest = null;
    this.now = 0;
  }

  /** Signed, towards the right; 1 is strong. */
  get wind(): number {
    if (this.rest === null) return 0;
    const lean = (this.now - this.rest) / STRONG;
    return Math.max(-MOST, Math.min(MOST, Math.abs(lean) < 0.12 ? 0 : lean));
  }

  private take(degrees: number | null, time: number): void {
    if (degrees === null) return;
    const seconds = Math.min(1, Math.max(0, (time - this.at) / 1000));
    this.at = time;
    this.now = degrees;
    this.rest = this.rest === null ? degrees : this.rest + (degrees - this.rest) * (1 - Math.exp(-seconds / FORGETS));
  }
}
