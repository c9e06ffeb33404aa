// Whether the page's tests notice when the page is wrong: one thing is broken at a time, in a copy, and the tests that should see it
// are run. A mutant that survives wants a test.
//
//     npm run mutants --workspace apps/web -- [--sure] [NUMBER…]      default: all; needs apps/web/dist and the packages' dist
//
// --sure leaves out running the tests once without a mutant.

import { execFileSync, spawn } from 'node:child_process';
import { cpSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';

const page = 'apps/web/src/';
const npm = 'bindings/npm/src/';

/** [file, what stands there, what stands there instead, the test that should see it, or the suite of it] */
const mutants = [
  // Keys and controls
  [`${page}panel/keys.ts`, 'breath.press(event.code);', '', 'controls: the candle'],
  [`${page}app.ts`, 'l: () => this.act(),', 'l: () => undefined,', 'controls: the candle'],
  [`${page}app.ts`, "'2': scene('leaves'),", "'2': scene('candle'),", 'controls: the leaves'],
  [`${page}app.ts`, 'this.settings.noise > 0 ? 0 : 1', 'this.settings.noise > 0 ? 1 : 0', 'controls: the drawer'],
  [`${page}app.ts`, 'this.stage.paused = !this.stage.paused;', 'this.stage.paused = false;', 'controls: the page'],
  [`${page}app.ts`, "setAttribute('aria-expanded', String(open))", "setAttribute('aria-expanded', 'false')", 'controls: the drawer'],
  [`${page}app.ts`, 'escape: () => this.showDrawer(false),', 'escape: () => undefined,', 'controls: the drawer'],
  [`${page}app.ts`, 'this.stage.canvas.setAttribute(\'aria-label\', scene.describe());', '', 'controls: the candle'],
  [`${page}panel/controls.ts`, 'String(name === tab)', "'false'", 'controls: the leaves'],
  [`${page}panel/controls.ts`, 'settings.candles + way', 'settings.candles - way', 'controls: the candle'],
  [`${page}panel/controls.ts`, 'this.ring.style.strokeDasharray = `${shown} 100`', "this.ring.setAttribute('stroke-dasharray', `${shown} 100`)", 'learned'],
  [`${page}style.css`, '--quiet: #b9b3ac;', '--quiet: #6b655e;', 'controls: the page'],
  // A phone
  [`${page}style.css`, '.tool.round { width: 40px;', '.tool.round { width: 20px;', 'phone'],
  [`${page}late.css`, '.drawer { top: auto; left: 0; width: 100%;', '.drawer { top: auto; left: 0; width: 120%;', 'phone'],
  // Links and sharing
  [`${page}link.ts`, 'if (!(value >= low && value <= high) || ', 'if (Number.isNaN(value) || ', 'controls: the page'],
  [`${page}model_link.ts`, 'if (url.origin !== location.origin)', 'if (url.origin === "")', 'sharing'],
  [`${page}model_link.ts`, "throw new Error('The model in this link is damaged: was the link cut?');", 'return { bytes: new Uint8Array(), file: value };', 'sharing'],
  [`${page}app.ts`, 'settings.model = await packModel(playing.bytes);', '', 'sharing'],
  [`${page}app.ts`, 'clear: overlay });', 'clear: false });', 'sharing'],
  [`${page}style.css`, 'body.overlay > :not(#stage, #absent) { display: none; }', '', 'sharing'],
  // Trouble
  [`${page}files.ts`, 'if (file.size > MAX_BYTES)', 'if (file.size < 0)', 'trouble'],
  [`${page}wind/ear.ts`, "denied: 'The microphone was not allowed.", "denied: 'No microphone was found.", 'trouble'],
  [`${page}app.ts`, "absent.hidden = state === 'back';", 'absent.hidden = true;', 'trouble'],
  ['apps/web/service-worker.js', 'cache.addAll(files.filter(wanted))', 'cache.addAll([])', 'trouble'],
  ['apps/web/vite.config.ts', '"connect-src \'self\'"', '"connect-src *"', 'weight'],
  // Breath
  [`${page}wind/ear.ts`, 'this.microphone?.stop();', '', 'breath'],
  [`${npm}air/breath.ts`, 'this.path.usedAtFrame = frame;', 'this.path.usedAtFrame = frame + 2;', 'breath'],
  [`${page}wind/ear.ts`, 'if (!silent) this.events.wind(wind);', 'this.events.wind(wind);', 'tuning: a microphone'],
  [`${page}panel/tuning.ts`, 'this.ear.listenFor(step.asked, step.seconds)', "this.ear.listenFor('blow hard', step.seconds)", 'tuning: a microphone'],
  [`${page}panel/tuning.ts`, 'this.returnTo.focus();', '', 'tuning: a microphone'],
  [`${page}wind/ear.ts`, '++this.vain >= VAIN_BLOWS', '++this.vain >= 99', 'tuning: blow after blow'],
  // The scenes
  [`${npm}air/delay.ts`, 'const way = Math.max(0, EDGE + side * x);', 'const way = 0;', 'controls: the candle'],
  [`${npm}air/stroke.ts`, 'if (Math.abs(blown) > Math.abs(this.gust)) this.gust = blown;', '', 'controls: the candle'],
  [`${npm}candle/scene.ts`, 'if (nearest !== null) this.relight(nearest);', '', 'controls: the candle'],
  [`${npm}candle/scene.ts`, 'for (const candle of this.candles) candle.stand.x += way;', '', 'controls: the candle'],
  [`${npm}candle/scene.ts`, 'candle.wind = breath + candle.stroke.wind + candle.motionWind(acting.seconds);', 'candle.wind = breath + candle.stroke.wind;', 'controls: the candle'],
  [`${npm}leaves/scene.ts`, 'this.kickLeft = 2 * KICKS;', 'this.kickLeft = 0;', 'controls: the leaves'],
  // What came last
  [`${page}late.css`, '--quiet: #5c5247;', '--quiet: #9c9287;', 'controls: the page'],
  ['apps/web/service-worker.js', "|\\/models\\/leaf", '', 'trouble'],
];

const root = fileURLToPath(new URL('../../../', import.meta.url));
const copy = mkdtempSync(join(tmpdir(), 'wisp-mutants-'));
const tool = (name) => join(copy, 'node_modules/.bin', name);

/** Builds what of the copy a file belongs to. */
function build(file) {
  const run = (program, ...given) => execFileSync(program, given, { cwd: copy, stdio: 'pipe' });
  if (file.startsWith(npm)) run(tool('tsc'), '-p', 'bindings/npm', '--noCheck');
  run(tool('vite'), 'build', 'apps/web', '--logLevel', 'error');
}

/** Runs a test until it fails, and says what failed; null: nothing did. */
function failureOf(test) {
  const env = { ...process.env, WISP_DATA: process.env.WISP_DATA ?? join(root, '../shared/data/') };
  const [file, suite = ''] = test.split(': ');
  const run = spawn(process.execPath, ['--test', `--test-name-pattern=^${suite}`, `tests/${file}.test.js`], { cwd: join(copy, 'apps/web'), env, detached: true });
  let said = '';
  return new Promise((resolve) => {
    run.stdout.on('data', (text) => {
      said += text;
      const failed = /not ok \d+ - (.*)\n/.exec(said);
      if (failed === null) return;
      resolve(failed[1]);
      // With the browser that it opened.
      process.kill(-run.pid);
    });
    run.on('close', (status) => resolve(status === 0 ? null : 'it did not end'));
  });
}

try {
  for (const part of ['apps/web', 'bindings/npm', 'bindings/studio', 'node_modules', 'third_party', 'package.json']) {
    cpSync(join(root, part), join(copy, part), { recursive: true, verbatimSymlinks: true });
  }
  const wanted = process.argv.slice(2).filter((word) => word !== '--sure').map(Number);
  const chosen = [...mutants.entries()].filter(([k]) => wanted.length === 0 || wanted.includes(k + 1));
  build(npm);
  for (const test of process.argv.includes('--sure') ? [] : new Set(chosen.map(([, [, , , name]]) => name))) {
    // On a busy machine once is no proof.
    const failed = (await failureOf(test)) && (await failureOf(test));
    if (failed) throw new Error(`${test} fails without a mutant: ${failed}`);
  }
  let red = 0;
  for (const [k, [file, from, to, test]] of chosen) {
    const path = join(copy, file);
    const sound = readFileSync(path, 'utf8');
    if (sound.split(from).length !== 2) throw new Error(`mutant ${k + 1}: ${file} has ${sound.split(from).length - 1} of: ${from}`);
    writeFileSync(path, sound.replace(from, () => to));
    build(file);
    const failed = await failureOf(test);
    if (failed !== null) red += 1;
    console.log(`${k + 1}\t${failed === null ? 'SURVIVED' : 'red'}\t${test}\t${file}: ${from.trim()} → ${to.trim() || 'nothing'}\t${failed ?? ''}`);
    writeFileSync(path, sound);
    if (file.startsWith(npm)) build(file);
  }
  console.log(`${red} of ${chosen.length} seen red`);
} finally {
  rmSync(copy, { recursive: true });
}
