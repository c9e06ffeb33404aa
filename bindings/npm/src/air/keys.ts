// Breath from keys: it grows while a key is held, decays after its release, and fluctuates like real breath.

/** Breath of each key: strength, positive to the right, and rise time in seconds. */
const BREATHS: Readonly<Record<string, readonly [number, number]>> = {
  ArrowRight: [0.85, 0.22],
  ArrowLeft: [-0.85, 0.22],
  ArrowUp: [0.4, 0.3],
  Space: [3, 0.12],
  /** pseudo-key: a visitor's arrival */
  arrival: [0.4, 0.3],
};

export class KeyBreath {
  /** keys that are held; all are released when the window loses the keyboard focus */
  readonly held = new Set<string>();
  private strength = 0;
  private clock = 0;

  static blows(code: string): boolean {
    return code in BREATHS;
  }

  /** Advances by `seconds` and returns the signed breath; 1 is strong. */
  update(seconds: number): number {
    this.clock += seconds;
    let goal = 0;
    let within = 0.1;
    for (const code of this.held) {
      const [strength, time] = BREATHS[code] as readonly [number, number];
      if (Math.abs(strength) >= Math.abs(goal)) [goal, within] = [strength, time];
    }
    this.strength += (goal - this.strength) * (1 - Math.exp(-seconds / within));
    if (Math.abs(this.strength) < 1e-3) this.strength = 0;
    const unsteady = 0.1 * Math.sin(this.clock * 13.1) + 0.07 * Math.sin(this.clock * 31.7 + 1);
    return this.strength * (1 + unsteady);
  }
}
