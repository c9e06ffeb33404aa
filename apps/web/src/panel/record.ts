// The last minute of what was plotted, as a table to take away.

const ROWS = 3600;
const COLUMNS = 3;

export class PlotRecord {
  private readonly numbers = new Float32Array(COLUMNS * ROWS);
  private count = 0;
  private clock = 0;

  push(seconds: number, wind: number, answer: number): void {
    this.clock += seconds;
    this.numbers.set([this.clock, wind, answer], COLUMNS * (this.count % ROWS));
    this.count += 1;
  }

  /** Comma-separated values, oldest first; time in seconds. */
  csv(answerName: string): string {
    const rows = [`time,wind,"${answerName}"`];
    const length = Math.min(ROWS, this.count);
    for (let k = this.count - length; k < this.count; ++k) {
      const at = COLUMNS * (k % ROWS);
      rows.push([...this.numbers.subarray(at, at + COLUMNS)].map((value) => value.toPrecision(6)).join(','));
    }
    return `${rows.join('\n')}\n`;
  }
}
