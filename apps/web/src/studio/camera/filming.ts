// Filming with the camera: a preview, then half a minute (of falls a minute) with instructions.

import type { LiveCapture, PictureSettings, Region, Seen, Studio } from '@wisp/studio';
import { button, drawing, element } from '../../panel/element.js';
import { Camera, KEPT_RATE, smallPicture } from './camera.js';
import { wallField } from '../panels/rate.js';
import { FallCount, Guide, hintOf, hintOfFalls } from './guide.js';
import { around, Reel } from '../reel.js';
import type { Viewer } from '../pictures/viewer.js';
import type { Room } from '../room.js';

/** Milliseconds between updates of the instructions. */
const LOOK = 100;
/** During preview one frame in this many is analysed. */
const PREVIEW_SHARE = 4;
/** Milliseconds between reductions of the exposure. */
const DARKER_EVERY = 900;
/** Milliseconds without a picture after which filming ends. */
const GIVES_UP = 6000;
const ASLEEP = 'No picture comes from the camera: a call or another program may have it. It goes on when it is free.';

const ADVICE = {
  flame: 'One flame before something dark, large in the picture; the camera lies still, the microphone near. It takes half a minute:',
  falls: 'A slip of paper or a leaf before a plain wall; the camera lies still and sees the whole way down. Take your hand out of the picture before it lands. A dozen falls are enough, two dozen are better:',
} as const;

const CIRCLE = { cx: 50, cy: 50, r: 46, pathLength: 100 } as const;

export class Filming {
  readonly panel = element('div', { class: 'panel filming' });
  private readonly word = element('span', {}, 'Film');
  private readonly ring = drawing('circle', { ...CIRCLE, class: 'ring' });
  private readonly button = element(
    'button',
    { type: 'button', class: 'blow record', click: () => this.press() },
    drawing('svg', { viewBox: '0 0 100 100', 'aria-hidden': 'true' }, drawing('circle', { ...CIRCLE, class: 'rail' }), this.ring),
    this.word,
  );
  private readonly hint = element('p', { class: 'quiet', role: 'status' });
  private readonly level = element('i');
  private readonly plan = element('ol', { class: 'plan' });
  private live: LiveCapture | null = null;
  private reel = new Reel(1 / KEPT_RATE);
  private settings: PictureSettings;
  private count = new FallCount();
  private seen: Seen | null = null;
  private loud = 0;
  state: 'looking' | 'filming' | 'ending' | 'over' = 'looking';
  private began = 0;
  private timer = 0;
  private darkened = 0;
  private keeping = false;
  private act = '';
  /** performance.now() when pictures stopped arriving; 0 while they arrive */
  private sleeping = 0;
  private guide: Guide;
  private readonly hidden = (): void => {
    if (document.hidden && this.state === 'filming') this.finish('Filming stopped when the page was hidden; what was filmed till then is kept.');
  };

  /** Opens the camera, and for a flame the microphone; null if not `wanted` then. Throws a CameraTrouble with a sentence. */
  static async open(studio: Studio, viewer: Viewer, falls: boolean, room: Room, wanted: () => boolean): Promise<Filming | null> {
    let filming: Filming | null = null;
    const happens = {
      lost: () => filming?.lose(),
      deaf: () => room.say('The microphone is gone: from here on the wind is not heard.'),
      loud: (level: number) => filming?.showLevel(level),
    };
    const camera = await Camera.open(happens, !falls);
    if (wanted()) return (filming = new Filming(studio, viewer, camera, falls, room));
    camera.close();
    return null;
  }

  private constructor(
    private readonly studio: Studio, private readonly viewer: Viewer, private readonly camera: Camera,
    private readonly falls: boolean, private readonly room: Room,
  ) {
    this.settings = falls ? { looks_for: 'falls' } : {};
    this.guide = this.newGuide();
    this.fill();
    viewer.camera(camera.stream);
    camera.watch(viewer.video);
    document.addEventListener('visibilitychange', this.hidden);
    this.look();
    this.timer = window.setInterval(() => this.tick(), LOOK);
  }

  choose(region: Region | null): void {
    if (this.state !== 'looking') return this.viewer.showBox(this.settings.region ?? null);
    const { region: _, ...rest } = this.settings;
    this.settings = region === null ? rest : { ...rest, region };
    this.look();
  }

  /** Releases camera and microphone. */
  close(): void {
    if (this.state === 'over') return;
    this.state = 'over';
    clearInterval(this.timer);
    document.removeEventListener('visibilitychange', this.hidden);
    this.live?.cancel();
    this.live = null;
    this.camera.close();
    this.viewer.camera(null);
    this.viewer.say('');
  }

  private fill(): void {
    const back = (): void => {
      this.close();
      this.room.filmed(null);
    };
    const meter = element('div', { class: 'level', 'aria-hidden': 'true' }, this.level);
    for (const [name, words, seconds] of this.guide.plan) this.plan.append(element('li', { 'data-plan': name }, element('span', {}, words), element('small', {}, `${seconds} s`)));
    this.panel.append(
      element('h2', { tabindex: '-1' }, this.falls ? 'Film how it falls' : 'Film your flame'),
      element('p', {}, this.falls ? ADVICE.falls : ADVICE.flame),
      this.plan,
      ...(this.falls ? [wallField(1, (height) => (this.settings = { ...this.settings, height }))] : []),
      this.hint,
      element('div', { class: 'record-row' }, this.button, ...(this.hears ? [element('div', {}, element('small', {}, 'Sound'), meter)] : [])),
      ...(this.camera.silent === '' ? [] : [element('p', { class: 'warning' }, this.camera.silent)]),
      element('div', { class: 'actions' }, button('Back', back)),
    );
  }

  private get hears(): boolean { return !this.falls && this.camera.silent === ''; }

  private newGuide(): Guide { return new Guide(this.falls ? 'falls' : this.hears ? 'flame' : 'mute flame'); }

  /** Starts a capture of one frame in `every`: by default the preview, which keeps nothing. */
  private look(name = 'a look', every = PREVIEW_SHARE): void {
    this.live?.cancel();
    this.live = this.studio.live(name, this.camera.rate, this.settings, { seen: (seen) => this.take(seen) });
    this.camera.feed(this.live, every);
  }

  private press(): void {
    if (this.state === 'looking') void this.begin();
    else if (this.state === 'filming') this.finish('');
  }

  private async begin(): Promise<void> {
    this.state = 'filming';
    // The capture takes its settings now.
    for (const field of this.panel.querySelectorAll('input')) field.disabled = true;
    const said = await this.camera.lock();
    // No warning about exposure for falls: only their positions count, and the words would cover them.
    if (said !== '' && !this.falls) this.room.say(said);
    if (this.state !== 'filming') return;
    this.reel = new Reel(1 / KEPT_RATE);
    this.guide = this.newGuide();
    this.count = new FallCount();
    this.look('camera', 1);
    if (!this.falls) this.room.traceLive();
    this.began = performance.now();
    this.word.textContent = 'Stop';
    this.button.classList.add('live');
    this.hint.textContent = '';
  }

  private take(seen: Seen): void {
    if (this.state === 'over') return;
    this.seen = seen;
    this.viewer.show(seen);
    if (this.state !== 'filming') return;
    if (this.falls) this.count.see(seen, (performance.now() - this.began) / 1000);
    else this.room.traces.add(seen, this.hears ? this.loud : null);
  }

  private tick(): void {
    if (this.state === 'filming' && this.began > 0) this.advise();
    if (this.state === 'looking' && this.live?.alive === false) this.look();
    const asleep = this.camera.asleep;
    if (!asleep) this.sleeping = 0;
    else this.sleeping ||= performance.now();
    this.camera.wake();
    if (asleep && this.state === 'filming' && performance.now() - this.sleeping > GIVES_UP) return this.finish('No picture came from the camera any more; what was filmed till then is kept.');
    const hint = asleep ? ASLEEP : this.seen === null ? '' : this.falls ? hintOfFalls(this.seen) : hintOf(this.seen);
    if (this.state !== 'looking' && this.state !== 'filming') return;
    if (this.hint.textContent !== hint) this.hint.textContent = hint;
    if (this.state === 'looking') this.brighten();
  }

  /** Shows the next instruction, and ends filming after the last. */
  private advise(): void {
    const seconds = (performance.now() - this.began) / 1000;
    // finish() reports why the capture has ended.
    if (this.live?.alive === false) return this.finish('');
    const { act, words, share } = this.guide.at(seconds, this.seen?.state ?? null, this.count.falls);
    this.ring.style.strokeDasharray = `${Math.round(100 * share)} 100`;
    this.viewer.say(words);
    for (const item of this.plan.children) item.toggleAttribute('aria-current', (item as HTMLElement).dataset.plan === act);
    if (words !== this.act) this.room.announce(words);
    this.act = words;
    if (act === 'done') this.finish('');
    else this.keepPicture(seconds);
  }

  /** Reduces the exposure where at least half of the flame is saturated. */
  private brighten(): void {
    const now = performance.now();
    if ((this.seen?.clipped ?? 0) < 0.5 || now - this.darkened < DARKER_EVERY) return;
    this.darkened = now;
    this.camera.darker().catch(() => undefined);
  }

  /** Keeps the next picture with its capture time, since a picture is displayed some frames after it was captured. */
  private keepPicture(seconds: number): void {
    const { video } = this.viewer;
    const { reel } = this;
    if (this.keeping || !reel.wants(seconds) || video.videoWidth === 0) return;
    this.keeping = true;
    this.camera.next(video, (now, taken) => {
      this.keeping = false;
      const all = { x: 0, y: 0, width: video.videoWidth, height: video.videoHeight };
      const box = this.seen?.box ?? null;
      const part = box === null ? all : around(box, all.width, all.height);
      const bitmap = this.state === 'filming' ? smallPicture(video, part) : null;
      if (bitmap !== null) reel.keep({ seconds: Math.max(0, (taken?.captureTime ?? now) - this.began) / 1000, bitmap, part, whole: all });
    });
  }

  private lose(): void {
    if (this.state === 'filming') this.finish('The camera is gone; what was filmed till then is kept.');
    else if (this.state === 'looking') {
      this.close();
      this.room.notFilmed('The camera is gone. Plug it in, or choose a film from your phone.');
    }
  }

  private finish(said: string): void {
    const { live, reel, settings } = this;
    // Until the camera is locked, `live` is still the preview's.
    if (this.state !== 'filming' || this.began === 0 || live === null) return;
    this.state = 'ending';
    this.live = null;
    this.camera.feed(null);
    this.word.textContent = 'One moment';
    this.button.classList.add('small-word');
    this.viewer.say('');
    if (said !== '') this.room.say(said);
    const shown = live.finish().then(
      (captured) => () => this.room.filmed({ captured, reel, settings }),
      (error: unknown) => () => this.room.notFilmed(error instanceof Error ? error.message : String(error), reel),
    );
    void shown.then((show) => {
      if (this.state === 'over') return reel.close(); // left by Back
      this.close();
      show();
    });
  }

  private showLevel(level: number): void {
    // 0 at −66 dB (a quiet room), 1 at −6 dB (a strong breath).
    const share = Math.max(0, Math.min(1, (20 * Math.log10(level + 1e-6) + 66) / 60));
    this.loud = share;
    this.level.style.transform = `scaleX(${share.toFixed(3)})`;
  }
}
