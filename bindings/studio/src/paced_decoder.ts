// A film decoder that does not run ahead of analysis. Mediabunny passes up to forty packets ahead to a decoder, and
// all would wait as frames: 55 MB at 720p, 120 MB at 1080p. Here packets wait instead.

/** Maximum number of open frames; decoding and analysis still overlap. */
const MAX_FRAMES = 4;

/** Returns a subclass of the browser's decoder that gets packets only while fewer than MAX_FRAMES frames are open. */
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

    /** Number of packets not yet decoded, including those waiting here. */
    override get decodeQueueSize(): number { return this.waiting.length + super.decodeQueueSize; }

    override decode(packet: EncodedVideoChunk): void { this.waiting.push(packet); this.feed(); }

    override async flush(): Promise<void> {
      if (this.waiting.length > 0) await new Promise<void>((resolve) => this.untilFed.push(resolve));
      return super.flush();
    }

    override reset(): void { this.forget(); super.reset(); }

    override close(): void { this.forget(); super.close(); }

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
      const free = (): boolean => this.state === 'configured' && this.frames < MAX_FRAMES && super.decodeQueueSize === 0;
      while (this.waiting.length > 0 && free()) super.decode(this.waiting.shift()!);
      if (this.waiting.length === 0) this.goOn();
    }

    private forget(): void { this.waiting.length = 0; this.goOn(); }

    private goOn(): void { for (const resolve of this.untilFed.splice(0)) resolve(); }
  };
}
