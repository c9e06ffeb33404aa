// Passes on the microphone's sound unchanged in blocks, each with the audio time of its first sample.

const BLOCK = 2048;

class Blocks extends AudioWorkletProcessor {
  constructor() {
    super();
    this.block = new Float32Array(BLOCK);
    this.filled = 0;
    this.since = 0;
  }

  process([input]) {
    const samples = input?.[0];
    if (samples === undefined) return true;
    if (this.filled === 0) this.since = currentTime;
    this.block.set(samples, this.filled);
    this.filled += samples.length;
    if (this.filled + samples.length <= BLOCK) return true;
    const samplesOut = this.block.slice(0, this.filled);
    this.port.postMessage({ samples: samplesOut, since: this.since }, [samplesOut.buffer]);
    this.filled = 0;
    return true;
  }
}

registerProcessor('wisp-blocks', Blocks);
