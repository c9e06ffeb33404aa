// A decoder of films that does not run ahead of who looks at them. Mediabunny hands a decoder forty packets while no frame is
// out, and each comes back as a frame that waits: 55 MB at 720p, 120 MB at 1080p. Here the packets wait.

/** Frames that are out and not closed yet. Decoding and looking still go on at once. */
const MAX_FRAMES = 4;

/** The browser's own decoder, so paced. */
export function paced(Native: typeof VideoDecoder): typeof VideoDecoder {
  return class PacedDecoder extends Native {
    private readonly waiting: EncodedVideoChunk[] = [];
    private readonly untilFed: (() => void)[] = [];
    private frames = 0;

    constructor({ output, error }: VideoDecoderInit) {
      super({
        output: (frame) => {
          this.follow(frame);
          output(frame);
          this.feed();
        },
        error,
      });
      this.addEventListener('dequeue', () => this.feed());
    }

    /** Packets that are no frames yet, those that wait here too. */
    override get decodeQueueSize(): number {
      return this.waiting.length + super.decodeQueueSize;
    }

    override decode(packet: EncodedVideoChunk): void {
      this.waiting.push(packet);
      this.feed();
    }

    override async flush(): Promise<void> {
      if (this.waiting.length > 0) await new Promise<void>((resolve) => this.untilFed.push(resolve));
      return super.flush();
    }

    override reset(): void {
      this.forget();
      super.reset();
    }

    override close(): void {
      this.forget();
      super.close();
    }

    private follow(frame: VideoFrame): void {
      const close = frame.close.bind(frame);
      this.frames += 1;
      frame.close = () => {
        frame.close = close;
        this.frames -= 1;
        close();
        this.feed();
      };
    }

    private feed(): void {
      while (this.state === 'configured' && this.waiting.length > 0 && this.frames < MAX_FRAMES && super.decodeQueueSize === 0) {
        super.decode(this.waiting.shift()!);
      }
      if (this.waiting.length === 0) this.goOn();
    }

    private forget(): void {
      this.waiting.length = 0;
      this.goOn();
    }

    private goOn(): void {
      for (const resolve of this.untilFed.splice(0)) resolve();
    }
  };
}
