// The colour standard of a film: what its file states, and the default if it states nothing.

import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, describe, it } from 'node:test';
import { BlobSource, Input, MATROSKA, MP4 } from 'mediabunny';
import { isBt709 } from '../dist/pictures.js';

const folder = mkdtempSync(join(tmpdir(), 'wisp-colours-'));
const tags = (name) => (name === '' ? [] : ['-colorspace', name, '-color_primaries', name, '-color_trc', name]);

/** Writes a film by ffmpeg with the flags `more`. Returns the colour space that the file states. */
async function statedIn(file, ...more) {
  const path = join(folder, file);
  execFileSync('ffmpeg', ['-y', '-loglevel', 'error', '-f', 'lavfi', '-i', 'testsrc=size=1280x720:rate=10:duration=0.2', '-pix_fmt', 'yuv420p', '-c:v', 'libx264', ...more, path]);
  const input = new Input({ formats: [MP4, MATROSKA], source: new BlobSource(new Blob([readFileSync(path)])) });
  const stated = await (await input.getPrimaryVideoTrack()).getColorSpace();
  input.dispose();
  return stated;
}

describe('the colours of a film', () => {
  after(() => rmSync(folder, { recursive: true }));
  // What a browser guesses for a film of that size.
  const guessed = { matrix: 'bt709' };

  for (const kind of ['mp4', 'mkv']) {
    it(`are what an ${kind} file states`, async () => {
      assert.equal(isBt709(await statedIn(`a.${kind}`, ...tags('bt709')), guessed), true);
      assert.equal(isBt709(await statedIn(`b.${kind}`, ...tags('smpte170m')), guessed), false);
    });

    it(`are BT.601 where an ${kind} file states nothing, as in the program, though a browser guesses BT.709`, async () => assert.equal(isBt709(await statedIn(`c.${kind}`), guessed), false));
  }

  it('are the frame\'s own where there is no file', () => {
    assert.equal(isBt709(undefined, { matrix: 'bt709' }), true);
    assert.equal(isBt709(undefined, { matrix: 'smpte170m' }), false);
  });
});
