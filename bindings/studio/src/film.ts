// Films: demultiplexed by Mediabunny, decoded by the browser, frame by frame and block by block.

import { AudioSampleSink, BlobSource, EncodedPacketSink, Input, MATROSKA, MP4, QTFF, UnsupportedInputFormatError, VideoSampleSink, WEBM, type InputVideoTrack } from 'mediabunny';
import type { CaptureSettings, Engine, RawPicture } from './engine.js';
import { sentenceOf, StudioError } from './module.js';
import { rawOfFrame } from './pictures.js';

/** Formats written by cameras, phones and browsers. */
const FORMATS = [MP4, QTFF, MATROSKA, WEBM];

/** Number of key frames, over the whole film, that the engine receives before the first frame. */
const GLIMPSES = 4;

/** Rates of cameras, Hz; a rate within 0.4 % of one of these is rounded to it. */
const RATES = [24_000 / 1001, 24, 25, 30_000 / 1001, 30, 48, 50, 60_000 / 1001, 60, 90, 100, 120_000 / 1001, 120, 240_000 / 1001, 240];

/**
 * Returns the rate of the frame grid: the camera's, from the usual interval between frames, or the mean rate where a
 * third of the camera's frames or more were lost.
 */
function gridRate(times: readonly number[]): number {
  const sorted = [...times].sort((a, b) => a - b);
  const steps = sorted.slice(1).map((time, k) => time - sorted[k]!).filter((step) => step > 1e-4);
  if (steps.length === 0) return 0;
  const mean = (times.length - 1) / (sorted.at(-1)! - sorted[0]!);
  // Some files round times to a millisecond: the usual interval is a mean over intervals near the median.
  const middle = steps.toSorted((a, b) => a - b)[steps.length >> 1]!;
  const usual = steps.filter((step) => Math.abs(step - middle) < 0.2 * middle);
  const nominal = usual.length / usual.reduce((sum, step) => sum + step, 0);
  const near = RATES.reduce((best, rate) => (Math.abs(rate - nominal) < Math.abs(best - nominal) ? rate : best));
  const rate = Math.abs(near - nominal) < 0.004 * near ? near : nominal;
  return rate / mean < 1.5 ? rate : mean;
}

const wordsOf = (error: unknown): string => (error instanceof Error ? error.message : String(error));

/** Reason why a file cannot be shown, and what to do. */
function unreadable(name: string, error: unknown): StudioError {
  if (error instanceof UnsupportedInputFormatError) {
    return new StudioError(`${name} is not a film that can be read here. MP4, MOV, WebM and MKV can: convert it to MP4, or give another`);
  }
  return new StudioError(`${name} is damaged: ${wordsOf(error)}; give another copy of it`);
}

/** Error for files without pictures: sound only, or an MP4 truncated before its index. */
async function withoutPicture(name: string, input: Input): Promise<StudioError> {
  const tracks = await input.getTracks();
  if (tracks.length > 0) return new StudioError(`${name} has sound and no picture: give a film`);
  return new StudioError(`${name} is cut off: its end, where it says what is in it, is missing; copy the whole film, or give another`);
}

/** Names of codecs in cameras. */
const CODECS: Readonly<Record<string, string>> = { hevc: 'HEVC (H.265)', avc: 'H.264', av1: 'AV1', vp8: 'VP8', vp9: 'VP9' };

function undecodable(name: string, codec: string | null): StudioError {
  const phone = codec === 'hevc' ? '; an iPhone films in H.264 when Camera, Formats says Most Compatible' : '';
  return new StudioError(`${name} is coded in ${CODECS[codec ?? ''] ?? codec ?? 'a way'}, which this browser cannot decode: convert it to MP4 with H.264, or use another browser${phone}`);
}

async function timesOf(track: InputVideoTrack): Promise<number[]> {
  const times: number[] = [];
  for await (const packet of new EncodedPacketSink(track).packets(undefined, undefined, { metadataOnly: true })) times.push(packet.timestamp);
  return times;
}

/** Passes the last key frame before the end of each quarter of the film to the engine. */
async function glimpse(engine: Engine, track: InputVideoTrack, first: number, last: number, stated: VideoColorSpaceInit): Promise<void> {
  const packets = new EncodedPacketSink(track);
  const frames = new VideoSampleSink(track);
  let before = first;
  for (let k = 1; k <= GLIMPSES; ++k) {
    const packet = await packets.getKeyPacket(first + ((last - first) * k) / GLIMPSES, { metadataOnly: true });
    if (packet === null || packet.timestamp === before) continue;
    before = packet.timestamp;
    // Damage of the film is reported where its frames are decoded in order.
    const sample = await frames.getSample(packet.timestamp).catch(() => null);
    if (sample === null) continue;
    const frame = sample.toVideoFrame();
    engine.frame(await rawOfFrame(frame, sample.rotation, stated), 0, true);
    frame.close();
    sample.close();
  }
}

/** Passes the film's sound to the engine if it can be decoded. Returns the reason if not, else ''. */
async function hear(engine: Engine, input: Input, first: number): Promise<string> {
  const track = await input.getPrimaryAudioTrack();
  if (track === null) return '';
  if (!(await track.canDecode())) return `its sound (${track.codec ?? 'of an unknown kind'}) cannot be decoded by this browser, so its wind is not heard`;
  try {
    for await (const sample of new AudioSampleSink(track).samples()) {
      const samples = new Float32Array(sample.numberOfFrames * sample.numberOfChannels);
      sample.copyTo(samples, { planeIndex: 0, format: 'f32' });
      engine.sound(samples, sample.numberOfChannels, sample.sampleRate, sample.timestamp - first);
      sample.close();
    }
  } catch (error) {
    if (sentenceOf(error) instanceof StudioError) throw error;
    return `its sound is damaged (${wordsOf(error)}), so its wind is heard only up to there`;
  }
  return '';
}

/** Passes a whole film to the engine. `looked`: called after each frame, with the finished share. Returns warnings. */
export async function showFilm(
  engine: Engine, file: Blob, settings: Omit<CaptureSettings, 'rate'>, looked: (picture: RawPicture, share: number) => Promise<void>,
): Promise<string[]> {
  const input = new Input({ source: new BlobSource(file), formats: FORMATS });
  try {
    const track = await input.getPrimaryVideoTrack().catch((error: unknown) => { throw unreadable(settings.name, error); });
    if (track === null) throw await withoutPicture(settings.name, input);
    if (!(await track.canDecode())) throw undecodable(settings.name, track.codec);
    const times = await timesOf(track);
    const rate = gridRate(times);
    if (!(rate > 0)) throw new StudioError(`${settings.name} has ${times.length === 1 ? 'one frame' : 'no frames'}: give a film of some seconds`);
    engine.begin({ ...settings, rate });
    const [first, last] = [Math.min(...times.slice(0, 64)), times.reduce((a, b) => Math.max(a, b), 0)];
    const stated = await track.getColorSpace();
    await glimpse(engine, track, first, last, stated);
    let begin = null;
    let done = 0;
    try {
      for await (const sample of new VideoSampleSink(track).samples()) {
        begin ??= sample.timestamp;
        const frame = sample.toVideoFrame();
        const picture = await rawOfFrame(frame, sample.rotation, stated);
        frame.close();
        sample.close();
        engine.frame(picture, sample.timestamp);
        done += 1;
        await looked(picture, done / times.length);
      }
    } catch (error) {
      if (sentenceOf(error) instanceof StudioError) throw error;
      if (done === 0) throw unreadable(settings.name, error);
    }
    const unheard = await hear(engine, input, begin ?? first);
    const cut = done < times.length - 1 ? `cut off or damaged: found ${done} frames of ${times.length} stated; what is there is used` : '';
    return [unheard, cut].filter((words) => words !== '').map((words) => `${settings.name}: ${words}`);
  } finally {
    input.dispose();
  }
}
