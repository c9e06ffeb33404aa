// What is done once a picture of the screen, until it is stopped.

export class FrameLoop {
  private running = 0;
  private last = 0;

  /** `frame` is told the seconds since the one before, 0 after a start, and the time as animation frames have it. */
  constructor(private readonly frame: (seconds: number, now: number) => void) {}

  /** Runs; twice is fine. */
  start(): void {
    this.running ||= requestAnimationFrame((now) => this.next(now));
  }

  /** Stands still until start(). */
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
