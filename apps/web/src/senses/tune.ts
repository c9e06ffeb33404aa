// A birthday tune from oscillators: "Good Morning to All" (1893), which everybody sings with other words. It plays only on request.

/** Tempo in beats per second. */
const PACE = 2.1;
const LOUD = 0.11;
/** Notes of the melody: semitones above C4, and beats. */
const MELODY: readonly (readonly [number, number])[] = [
  [7, 0.75], [7, 0.25], [9, 1], [7, 1], [12, 1], [11, 2],
  [7, 0.75], [7, 0.25], [9, 1], [7, 1], [14, 1], [12, 2],
  [7, 0.75], [7, 0.25], [19, 1], [16, 1], [12, 1], [11, 1], [9, 1.6],
  [17, 0.75], [17, 0.25], [16, 1], [12, 1], [14, 1], [12, 2.5],
];
/** Chords below the melody: semitones above C3, and beats; the first is the upbeat's rest. */
const CHORDS: readonly (readonly [readonly number[], number])[] = [
  [[], 1], [[0, 4], 3], [[-1, 5], 3], [[-1, 5], 3], [[0, 4], 3], [[0, 4], 3], [[0, 5], 3.6], [[0, 4], 2], [[-1, 5], 1], [[0, 4, 7], 2.5],
];

const hertz = (halfTones: number): number => 261.63 * 2 ** (halfTones / 12);

export class Tune {
  private context: AudioContext | null = null;

  get plays(): boolean {
    return this.context !== null;
  }

  /** Plays or stops the tune; returns whether it plays. Call it in a press handler: browsers start sound only there. */
  toggle(): boolean {
    if (this.context !== null) this.stop();
    else this.play();
    return this.plays;
  }

  stop(): void {
    void this.context?.close();
    this.context = null;
  }

  private play(): void {
    const context = new AudioContext();
    this.context = context;
    const out = new GainNode(context, { gain: LOUD });
    out.connect(context.destination);
    const begin = context.currentTime + 0.1;
    let at = begin;
    for (const [tone, beats] of MELODY) at = this.note(out, tone, at, beats / PACE, 1);
    const end = at;
    at = begin;
    for (const [tones, beats] of CHORDS) {
      for (const tone of tones) this.note(out, tone - 12, at, (0.94 * beats) / PACE, 0.32);
      at += beats / PACE;
    }
    setTimeout(() => {
      if (this.context === context) this.stop();
    }, 1000 * (end - begin + 1));
  }

  /** A note like a music box's: struck, then decaying. Returns the start of the next. */
  private note(out: AudioNode, tone: number, at: number, seconds: number, loud: number): number {
    const { context } = out;
    const gain = new GainNode(context, { gain: 0 });
    gain.connect(out);
    gain.gain.setValueAtTime(0, at);
    gain.gain.linearRampToValueAtTime(loud, at + 0.012);
    gain.gain.exponentialRampToValueAtTime(0.03 * loud, at + seconds + 0.25);
    for (const [times, share, type] of [[1, 0.8, 'triangle'], [2, 0.16, 'sine'], [3, 0.07, 'sine']] as const) {
      const voice = new OscillatorNode(context, { type, frequency: times * hertz(tone) });
      const part = new GainNode(context, { gain: share });
      voice.connect(part).connect(gain);
      voice.start(at);
      voice.stop(at + seconds + 0.3);
    }
    return at + seconds;
  }
}
