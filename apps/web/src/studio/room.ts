// The studio: from a film, a camera or a table to a model, on one screen. The display follows the session; errors are
// sentences and never lose gathered sources.

import './studio.css';
import type { Captured, Learned, PictureSettings, Recipe, Region, Seen, TableSettings, Watch } from '@wisp/studio';
import type { App } from '../app.js';
import type { Dropped } from '../drops.js';
import { element } from '../panel/element.js';
import { fetchPart, once } from '../part.js';
import { fetchShipped, FLAME } from '../shipped.js';
import { fallsPlayed, linesOfFalls, plotsOf, recordedOf } from './pictures/curves.js';
import { Duet } from './pictures/duet.js';
import { Filming } from './camera/filming.js';
import { gatherPanel } from './panels/gather.js';
import { Invitation } from './pictures/invitation.js';
import { lookPanel, partOfSeen } from './panels/look.js';
import { Outlines } from './outlines.js';
import { pickOf, unfold } from './picks.js';
import { MAX_OF_FILE, Reel } from './reel.js';
import { ratePanel } from './panels/rate.js';
import { resultPanel } from './panels/result.js';
import { nameInC, type Format, type Moving } from './panels/taking.js';
import { saveFile } from '../saving.js';
import type { StudioDoor } from '../studio_door.js';
import { emptied, filmsOf, newSession, sessionName, shownIn, thingOf, withoutTake, withTake, type Looked, type Session, type Take } from './session.js';
import { LEARNING, LOOKING, STEP_WORDS, STEPS, type Step } from './steps.js';
import { Strip } from './pictures/strip.js';
import { tablePanel } from './panels/table.js';
import { headOf, recipeOfTable } from './table_head.js';
import { Traces } from './pictures/traces.js';
import { button, verdictHead } from './panels/verdict.js';
import { Viewer } from './pictures/viewer.js';
import { sentence, verdictOf, type Thing } from './words.js';
import { Working } from './panels/working.js';

/** Share of a table's rows held out for validation. */
const KEPT_BACK = 0.25;

/** Order of the point systems of a model that fits in a link: about 6 kB. */
const LINK_ORDER = 4;

/** Seconds of loops exported to other tools, and number of instances. */
const LOOPED: Readonly<Record<Thing, { loop: number; instances: number }>> = {
  flame: { loop: 4, instances: 1 }, fall: { loop: 6, instances: 20 }, table: { loop: 4, instances: 1 },
};

/** Maximum bytes of a table, as text, numbers and learning data are in memory together. */
const MAX_TABLE_BYTES = 100e6;

const APART = 'A flame and what falls are learned apart. The other films are set aside until what was added now is left out.';
const BUSY = 'A film is still being looked at: give pictures or a table when that is done, or cancel it.';

/** Initial number of frames between kept pictures of a film. */
const FRAMES_APART = 3;

const isAbort = (error: unknown): boolean => error instanceof Error && error.name === 'AbortError';
const wordsOf = (error: unknown): string => sentence(error instanceof Error ? error.message : String(error));

export class Room {
  readonly place = element('section', { id: 'studio', class: 'studio', 'aria-label': 'Learn a flame of your own', hidden: true });
  private readonly left = element('div', { class: 'left' });
  private readonly story = element('div', { class: 'story' });
  private readonly below = element('div', { class: 'below' });
  private readonly steps = element('ol', { class: 'steps', 'aria-label': 'Steps' });
  private readonly panel = element('div');
  private readonly spoken = element('p', { class: 'spoken', role: 'status', 'aria-live': 'polite' });
  private readonly viewer = new Viewer((region) => this.lookThere(region));
  readonly traces = new Traces();
  private readonly app: App;
  private readonly invitation: Invitation;
  private session: Session = newSession();
  /** Starts the worker that captures and learns at first use. Rejects with a sentence if this browser cannot. */
  private readonly studio = once(() => import('@wisp/studio').then(({ Studio }) => Studio.open()));
  private filming: Filming | null = null;
  private duet: Duet | null = null;
  private working: Working | null = null;
  /** ends the validation that still computes plots */
  private judging: AbortController | null = null;
  /** films chosen together with the current one, or while it is analysed */
  private waiting: File[] = [];
  /** film that a dragged box refers to */
  private looked: Looked | null = null;
  /** number of the latest display; work begun for an earlier one shows nothing */
  private turn = 0;

  constructor(private readonly door: StudioDoor) {
    this.app = door.app;
    this.invitation = new Invitation(this.app.wisp);
    this.story.append(this.steps, this.panel, this.spoken);
    this.place.append(this.left, this.story, this.below);
    document.querySelector('header.top')?.after(this.place);
    // Keys pressed in the studio do not blow, pause or act on the page.
    this.place.addEventListener('keydown', (event) => event.stopPropagation());
    fetchShipped(FLAME).then((model) => this.invitation.fill(model), () => undefined);
    this.gather();
  }

  /** Enters or leaves the studio; the session is kept. */
  show(inside: boolean): void {
    this.place.hidden = !inside;
    if (inside) {
      // Loaded while the user looks at the choices.
      this.studio().catch(() => undefined);
      this.invitation.loop.start();
      this.duet?.loop.start();
      return;
    }
    this.invitation.loop.stop();
    this.duet?.stop();
    // What was filmed and is looked over is not lost.
    if (this.filming !== null && this.filming.state !== 'ending') this.gather();
  }

  take({ files, entries }: Dropped): void {
    unfold(files, entries).then((found) => this.files(found), () => this.say('What was dropped cannot be read.'));
  }

  private stepTo(step: Step, thing: Thing = 'flame'): void {
    this.place.dataset.step = step;
    const words = STEP_WORDS[thing];
    this.steps.replaceChildren(...STEPS.map((name) => element('li', name === step ? { 'aria-current': 'step' } : {}, words[name])));
  }

  /** Shows a panel and moves focus and scroll to its top. */
  private showPanel(panel: HTMLElement): void {
    const here = this.place.contains(document.activeElement);
    this.panel.replaceChildren(panel);
    this.story.scrollTop = 0;
    if (here || document.activeElement === document.body) panel.querySelector<HTMLElement>('h2')?.focus({ preventScroll: true });
  }

  private invite(): void { this.left.replaceChildren(element('div', { class: 'viewer' }, this.invitation.canvas)); }

  say(words: string): void { this.app.notices.say(words); }

  /** Reads a message to screen readers only. */
  announce(words: string): void { this.spoken.textContent = words; }

  /** Ends all running work. `waiting`: films that are still to be analysed */
  private clear(waiting: File[] = []): void {
    this.turn += 1;
    this.waiting = waiting;
    for (const work of [this.working, this.judging]) work?.abort();
    this.filming?.close();
    this.duet?.dispose();
    this.working = this.judging = this.filming = this.duet = this.looked = null;
    this.below.replaceChildren();
  }

  gather(): void {
    this.clear();
    this.stepTo('gather');
    this.viewer.clear();
    this.invite();
    // A table from which nothing was learned is not kept; the films before it are.
    const [table] = thingOf(this.session) === 'table' && this.session.learned === null ? this.session.takes : [];
    if (table !== undefined) this.session = withoutTake(this.session, table);
    const { length: count } = this.session.takes;
    this.showPanel(gatherPanel(this, count === 0 ? null : { count, thing: thingOf(this.session), back: () => this.back() }));
  }

  /** Returns to the last result or film, or to the choice of sources. */
  back(): void {
    const last = this.session.takes.at(-1);
    if (this.session.learned !== null && last !== undefined) this.showResult();
    else if (last === undefined || thingOf(this.session) === 'table') this.gather();
    else this.showLook(last);
  }

  files(given: File[]): void {
    const { kind, files, words } = pickOf(given);
    const { busy } = this;
    if (words !== '') this.say(words);
    if (kind === 'film') {
      this.waiting = busy ? [...this.waiting, ...files] : files;
      if (busy) this.say('What was added is looked at after this film.');
      else this.lookAtNext();
    } else if (kind !== 'nothing' && busy) this.say(BUSY);
    else if (kind === 'table') void this.table(files[0] as File);
    else if (kind === 'pictures') this.pictures(files);
  }

  /** Whether a film is made or looked at, which other sources would end. */
  private get busy(): boolean {
    const { looked, working, filming } = this;
    return (looked !== null && working?.control.signal.aborted === false) || filming?.state === 'filming' || filming?.state === 'ending';
  }

  /** Asks for the rate of numbered pictures, which they do not contain. */
  private pictures(files: File[]): void {
    this.clear();
    this.stepTo('gather');
    this.viewer.clear();
    this.invite();
    const folder = files[0]?.webkitRelativePath.split('/')[0] ?? '';
    const name = folder === '' ? 'pictures' : folder;
    this.showPanel(
      ratePanel(name, files.length, (rate) => void this.look(name, null, { looks_for: 'either' }, async (settings, watch) => (await this.studio()).pictures(files, rate, settings, watch)), () => this.back()),
    );
  }

  /** Analyses the next of several films. Returns false where none is left. */
  private lookAtNext(): boolean {
    const file = this.waiting.shift();
    if (file === undefined) return false;
    void this.look(file.name, file, { looks_for: 'either' }, async (settings, watch) => (await this.studio()).film(file, settings, watch));
    return true;
  }

  /** Analyses a film, with a live display of the outline. */
  private async look(name: string, film: File | null, settings: PictureSettings, capture: NonNullable<Take['again']>): Promise<void> {
    this.clear(this.waiting);
    const { turn } = this;
    this.stepTo('look', settings.looks_for === 'falls' ? 'fall' : 'flame');
    this.viewer.clear();
    this.viewer.showBox(settings.region ?? null);
    this.left.replaceChildren(this.viewer.place);
    const { title, words, thing } = LOOKING[settings.looks_for ?? 'flame'];
    const working = new Working(title, words, (said) => this.announce(said), thing);
    this.working = working;
    this.showPanel(working.panel);
    const reel = film === null ? new Reel(FRAMES_APART) : new Reel(FRAMES_APART, MAX_OF_FILE);
    if (settings.looks_for !== 'falls') this.traces.begin();
    const looked: Looked = { name, reel, film, settings, again: capture };
    this.looked = looked;
    try {
      const captured = await capture(settings, working.watch((seen) => this.see(seen, reel, working)));
      if (turn !== this.turn) return;
      reel.scale(1 / captured.rate);
      this.keep({ ...looked, captured, outlines: Outlines.of(captured) });
    } catch (error) {
      reel.close();
      if (turn === this.turn) this.notFound(error);
    }
  }

  /** Plots the tip during filming. */
  traceLive(): void { this.traces.begin(); this.below.replaceChildren(this.traces.place); }

  private see(seen: Seen, reel: Reel, working: Working): void {
    if (working !== this.working) return seen.picture?.close();
    reel.keepSeen(seen);
    this.viewer.show(seen);
    this.traces.add(seen, null);
    // Without an outline there is no tip to plot.
    if (seen.state === 'following' && !this.traces.place.isConnected) this.below.replaceChildren(this.traces.place);
    working.found(partOfSeen(seen, this.looked?.settings.looks_for === 'falls'));
  }

  /** Stores a take: in place of an earlier version of the film, else at the end. Then analyses the next film. */
  private keep(take: Take): void {
    const { takes } = this.session;
    this.session = withTake(this.session, take);
    if (this.session.aside.some((one) => takes.includes(one))) this.say(APART);
    if (!this.lookAtNext()) this.showLook(take);
  }

  private showLook(take: Take): void {
    this.clear();
    this.looked = take;
    this.stepTo('look', shownIn(take));
    this.left.replaceChildren(this.viewer.place);
    this.viewer.showBox(take.settings.region ?? null);
    const { outlines } = take;
    const line = this.viewer.shows ? null : this.showStill(take);
    this.viewer.showLines((size) => (line !== null ? [line] : linesOfFalls(take.captured, take.settings.height ?? 1, size)));
    if (outlines !== null) {
      this.viewer.showFollowed();
      this.traces.fill(outlines);
      this.below.replaceChildren(this.traces.place);
    }
    this.showPanel(lookPanel(take, this.session.takes, this));
  }

  /** Shows a kept picture, near the middle of a flame's film, where the viewer has none. Returns its outline. */
  private showStill({ reel, outlines }: Take): Float32Array | null {
    const kept = reel.at(outlines === null ? 0 : 0.4 * (outlines.rows / outlines.rate));
    if (kept !== null) this.viewer.still(kept);
    return kept === null || outlines === null ? null : outlines.line(Math.round(kept.seconds * outlines.rate));
  }

  leaveOut(take: Take): void {
    this.session = withoutTake(this.session, take);
    this.viewer.clear();
    this.back();
  }

  private lookThere(region: Region | null): void {
    if (this.filming !== null) return this.filming.choose(region);
    const { region: before, ...rest } = this.looked?.settings ?? {};
    // A press without a drag gives the box that is shown.
    if (region !== null && region !== before) this.lookAgain({ ...rest, region });
    else if (region === null && before !== undefined) this.lookAgain(rest);
  }

  lookAgain(settings: PictureSettings): void {
    const take = this.looked;
    if (take === null) return;
    if (take.again === null) {
      this.say('A film from the camera is not kept, only its outline. Film again to look elsewhere.');
      this.viewer.showBox(null);
      return;
    }
    void this.look(take.name, take.film, settings, take.again);
  }

  /** After a failure, ends the worker: later work starts another, with fresh memory. */
  private renew(): void { this.studio().then((studio) => studio.close(), () => undefined); }

  /** Reports why a film gave nothing, or was stopped, and what can be done. */
  private notFound(error: unknown): void {
    this.working = null;
    if (isAbort(error)) {
      this.viewer.clear();
      this.waiting = [];
      this.say(this.session.takes.length > 0 ? 'Stopped. What was gathered before is kept.' : 'Stopped.');
      return this.back();
    }
    this.renew();
    if (this.passedOver(wordsOf(error))) return;
    const kept = this.session.takes.length > 0 ? 'What was gathered before is kept.' : '';
    if (!this.viewer.shows) this.invite();
    const otherwise = this.viewer.shows ? 'The picture stays: drag a box around what you mean to look there, or choose something else.' : kept;
    this.trouble('Nothing was learned from this', wordsOf(error), otherwise, this.viewer.shows);
  }

  /** Says why a film gave nothing, and looks at the next. Returns false where none waits, for a panel that says it. */
  private passedOver(words: string): boolean {
    if (this.waiting.length > 0) this.say(words);
    return this.lookAtNext();
  }

  /** `seen`: whether there is a picture that can be analysed in another way. */
  private trouble(title: string, words: string, otherwise: string, seen = false): void {
    const again = seen && this.looked !== null && this.looked.again !== null && this.looked.settings.looks_for !== 'falls';
    const falls = again ? [button('It is something that falls', 'other', () => this.lookAgain({ ...this.looked?.settings, looks_for: 'falls' }))] : [];
    const choose = button('Choose something else', 'choose', () => this.gather(), true);
    this.announce(words);
    this.showPanel(
      element('div', { class: 'panel' }, verdictHead(false, title, words), ...(otherwise === '' ? [] : [element('p', {}, otherwise)]), element('div', { class: 'actions' }, choose, ...falls)),
    );
  }

  async film(falls: boolean): Promise<void> {
    this.clear();
    const { turn } = this;
    try {
      const filming = await Filming.open(await this.studio(), this.viewer, falls, this, () => turn === this.turn && !this.place.hidden);
      if (filming === null) return;
      this.filming = filming;
      this.stepTo('gather', falls ? 'fall' : 'flame');
      this.left.replaceChildren(this.viewer.place);
      this.showPanel(filming.panel);
    } catch (error) {
      if (turn === this.turn) this.trouble('There is no camera', wordsOf(error), 'What was gathered before is kept.');
    }
  }

  /** Stores a filmed recording; null: goes back. */
  filmed(shot: { captured: Captured; reel: Reel; settings: PictureSettings } | null): void {
    this.filming = null;
    if (shot === null) return this.lookAtNext() ? undefined : this.back();
    const count = this.session.takes.filter(({ film }) => film === null).length + 1;
    this.keep({ ...shot, name: count === 1 ? 'camera' : `camera ${count}`, outlines: Outlines.of(shot.captured), film: null, again: null });
  }

  /** Says why filming gave nothing usable. */
  notFilmed(words: string, reel?: Reel): void {
    this.filming = null;
    reel?.close();
    if (this.passedOver(sentence(words))) return;
    this.trouble('Nothing was learned from this', sentence(words), 'What was gathered before is kept. Film again, or choose a film from your phone.');
  }

  /** `recipe`: becomes the session's once a model is learned by it */
  async learn(recipe = this.session.recipe): Promise<void> {
    const { session } = this;
    this.clear();
    const { turn } = this;
    const thing = thingOf(session);
    this.stepTo('learn', thing);
    const working = new Working('Learning', LEARNING[thing], (words) => this.announce(words));
    this.working = working;
    this.showPanel(working.panel);
    try {
      session.learned = await this.learned({ ...session, recipe }, thing === 'table' ? { kept_back: KEPT_BACK } : {}, working.watch());
      session.recipe = recipe;
    } catch (error) {
      if (turn !== this.turn) return;
      this.working = null;
      if (isAbort(error)) this.say('Stopped. What was filmed is kept.');
      else {
        this.renew();
        this.say(wordsOf(error));
      }
      return this.back();
    }
    if (turn !== this.turn) return;
    this.showResult();
    if (thing === 'flame') await this.judge();
  }

  /** Learns a model from a session's takes by its recipe, with `change` applied. */
  private async learned(session: Session, change: Partial<Recipe>, watch: Watch = {}): Promise<Learned> {
    const { takes, recipe } = session;
    const studio = await this.studio();
    return studio.learn(takes.map(({ captured }) => captured.csv), { ...recipe, name: sessionName(session), sources: takes.map(({ name }) => name), ...change }, watch);
  }

  /** Plays the model along its last recording for plots, without delaying the result. */
  private async judge(): Promise<void> {
    const { learned, takes } = this.session;
    const take = takes.at(-1);
    if (learned === null || take === undefined) return;
    const control = new AbortController();
    this.judging = control;
    try {
      const studio = await this.studio();
      const { curves } = await studio.validate(learned.model, [take.captured.csv], { signal: control.signal });
      learned.curves = [...curves, ...learned.curves];
      if (this.judging === control) this.place.querySelector('[data-plots]')?.replaceChildren(...plotsOf(learned.curves));
    } catch {
      // Without these plots, those of the fit are shown.
    } finally {
      if (this.judging === control) this.judging = null;
    }
  }

  /** Runs the viewing test of the last film against the model learned from it. Returns a message about the result. */
  async compare(model: Uint8Array): Promise<string> {
    const outlines = this.session.takes.at(-1)?.outlines ?? null;
    if (outlines === null) return 'There is no outline';
    const { ANSWERS, filmPairs, Viewing } = await fetchPart(() => import('../viewing/viewing.js'));
    const pairs = filmPairs(this.app.wisp, model, outlines, ANSWERS);
    if (pairs.length < 5) return 'The film is too short for it';
    new Viewing(pairs, { model: this.file, from: 'the film that it learned from' });
    return 'Answered';
  }

  /** Name of the learned model's file. */
  private get file(): string { return `${sessionName(this.session)}.wisp`; }

  /** Plays the learned model in the page's own scene. */
  blow(model: Uint8Array): void {
    this.door.blow(this.file, model).catch((error: unknown) => this.say(wordsOf(error)));
  }

  /** Saves a film or GIF in which the flame is blown out and lit again. Returns a message about the result. */
  record(model: Uint8Array, kind: Moving): Promise<string> { return this.door.film(this.file, model, kind); }

  /** Learns a model small enough for a link. */
  async small(): Promise<Uint8Array> { return (await this.learned(this.session, { paper: LINK_ORDER })).model; }

  private showResult(): void {
    const { session, app } = this;
    const thing = thingOf(session);
    const { learned } = session;
    const take = session.takes.at(-1);
    if (learned === null || take === undefined) return;
    this.clear();
    const { outlines } = take;
    this.stepTo('blow', thing);
    if (outlines !== null && thing === 'flame') this.showFlame(take, outlines, learned.model);
    else this.left.replaceChildren(element('div', { class: 'plots', 'data-plots': true }, ...plotsOf([...(learned.judged?.curves ?? []), ...learned.curves, ...recordedOf(take.captured), ...(thing === 'fall' ? fallsPlayed(app.wisp, learned.model, take.captured) : [])])));
    this.showPanel(resultPanel(session, learned, this));
    const { title, reason } = verdictOf(learned, thing);
    this.announce(`${title}. ${reason}`);
  }

  /** Saves files for other tools. Returns a message about the result. */
  async make(format: Format, model: Uint8Array): Promise<string> {
    const studio = await this.studio();
    const name = sessionName(this.session);
    const settings = format === 'c' ? { name: nameInC(name) } : { name, ...LOOPED[thingOf(this.session)] };
    for (const file of await studio.export(model, { format, ...settings })) saveFile(new Blob([file.bytes.slice()]), file.name);
    return 'Saved';
  }

  private showFlame(take: Take, outlines: Outlines, model: Uint8Array): void {
    const { wisp } = this.app;
    this.traces.fill(outlines);
    this.duet = new Duet(wisp, take, outlines, model, (share) => this.traces.mark(share));
    this.duet.loop.start();
    this.left.replaceChildren(this.duet.place);
    this.below.replaceChildren(this.traces.place, new Strip(wisp, take, outlines, model).place);
  }

  learnAgain(change: Partial<Recipe>): void {
    const recipe = Object.fromEntries(Object.entries({ ...this.session.recipe, ...change }).filter(([, value]) => value !== undefined));
    void this.learn(recipe as unknown as Recipe);
  }

  /** Starts over without the gathered sources; after a table, with the films before it. */
  anew(): void {
    if (thingOf(this.session) === 'table') this.session.learned = null;
    else this.session = emptied(this.session);
    this.gather();
  }

  /** Opens a table: its columns are chosen first, unless it is a Wisp recording. */
  private async table(file: File): Promise<void> {
    try {
      if (file.size > MAX_TABLE_BYTES) throw new Error(`${file.name} has ${Math.round(file.size / 1e6).toLocaleString('en')} MB, and tables of up to ${MAX_TABLE_BYTES / 1e6} MB are read here. Give a part of it.`);
      const bytes = new Uint8Array(await file.arrayBuffer());
      const head = headOf(bytes);
      if (head.names.length === 0) throw new Error(`${file.name} is empty.`);
      if (!head.recording && !head.numeric.includes(true)) throw new Error(`${file.name} has no column of numbers. A table is rows of numbers below the names of their columns.`);
      if (head.recording) return await this.tabled(file.name, bytes);
      this.clear();
      this.stepTo('look', 'table');
      this.viewer.clear();
      this.left.replaceChildren(element('div', { class: 'plots' }, ...plotsOf(head.preview)));
      this.showPanel(tablePanel(file.name, head.named ?? bytes, head, this));
    } catch (error) {
      this.say(wordsOf(error));
    }
  }

  async advise(name: string, bytes: Uint8Array, settings: TableSettings): Promise<Captured> {
    return (await this.studio()).table(name, bytes, settings, 'advise');
  }

  /** Learns from a table, or keeps an outline's recording. `settings`: absent for recordings, which have their own. */
  async tabled(name: string, bytes: Uint8Array, settings?: TableSettings): Promise<void> {
    const { turn } = this;
    try {
      const captured = await (await this.studio()).table(name, bytes, settings);
      // The columns were left meanwhile.
      if (settings !== undefined && turn !== this.turn) return;
      if (this.busy) return this.say(BUSY);
      const outlines = Outlines.of(captured);
      const take: Take = { name, captured, outlines, reel: new Reel(), film: null, settings: {}, again: null };
      if (outlines === null) {
        this.session = { ...newSession(), takes: [take], aside: filmsOf(this.session), recipe: recipeOfTable(captured, settings) };
        this.left.replaceChildren(element('div', { class: 'plots' }, ...plotsOf(recordedOf(captured))));
        await this.learn();
      } else {
        this.viewer.clear();
        this.keep(take);
      }
    } catch (error) {
      this.say(wordsOf(error));
    }
  }
}
