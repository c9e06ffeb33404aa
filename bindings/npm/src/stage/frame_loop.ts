// A loop that runs once per screen refresh until it is stopped.

export class FrameLoop {
  private running = 0;
  private last = 0;

  /** `frame` receives the seconds since the last frame (0 after a start) and the animation frame's time. */
  constructor(private readonly frame: (seconds: number, now: number) => void) {}

  /** Starts the loop; may be called twice. */
  start(): void {
    this.running ||= requestAnimationFrame((now) => this.next(now));
  }

  stop(): void {
    cancelAnimationFrame(this.running);
    this.running = 0;
    this.last = 0;
  }

  private next(now: number): void {
    this.running = requestAnimationFrame((later) => this.next(later));
    const seconds = this.last === 0 ? 0 : (now - this.last) / 1000;
    this.last = now;
    this.frame(seconds, now);
  }
}
