// Mouse, finger or pen over the canvas as one pointer with a speed.

import type { Pointer, Scene } from './scene.js';

/** Averaging time of the speed, seconds. */
const MEAN = 0.035;
/** Maximum distance in CSS pixels between press and release of a tap. */
const TAP = 8;

export class PointerReader {
  readonly now: Pointer = { x: 0, y: 0, fromX: 0, fromY: 0, speedX: 0, speedY: 0, present: false };
  private lastX = 0;
  private lastY = 0;
  private fresh = true;
  private pressed: { id: number; x: number; y: number; tap: boolean } | null = null;

  /** `scene`: receives presses; `touched`: called at a press of any button. */
  constructor(
    private readonly canvas: HTMLCanvasElement,
    private readonly scene: () => Scene | null,
    private readonly touched: () => void,
  ) {
    canvas.addEventListener('pointerdown', (event) => this.press(event));
    canvas.addEventListener('pointermove', (event) => this.move(event));
    canvas.addEventListener('pointerup', (event) => this.release(event, true));
    canvas.addEventListener('pointercancel', (event) => this.release(event, false));
    canvas.addEventListener('pointerleave', () => this.pressed === null && (this.now.present = false));
    canvas.addEventListener('contextmenu', (event) => event.preventDefault());
  }

  /** Computes this frame's speed from the current position. Call once a frame, before use. */
  update(seconds: number): void {
    const { now } = this;
    if (seconds <= 0) return;
    const share = 1 - Math.exp(-seconds / MEAN);
    const speedX = now.present && !this.fresh ? (now.x - this.lastX) / seconds : 0;
    const speedY = now.present && !this.fresh ? (now.y - this.lastY) / seconds : 0;
    now.speedX += (speedX - now.speedX) * share;
    now.speedY += (speedY - now.speedY) * share;
    now.fromX = this.fresh ? now.x : this.lastX;
    now.fromY = this.fresh ? now.y : this.lastY;
    this.lastX = now.x;
    this.lastY = now.y;
    this.fresh = !now.present;
  }

  private place(event: PointerEvent): void {
    const box = this.canvas.getBoundingClientRect();
    this.now.x = ((event.clientX - box.left) / Math.max(1, box.width)) * this.canvas.width;
    this.now.y = (1 - (event.clientY - box.top) / Math.max(1, box.height)) * this.canvas.height;
    this.now.present = true;
  }

  private press(event: PointerEvent): void {
    this.touched();
    if (this.pressed !== null || event.button !== 0) return;
    this.place(event);
    this.fresh = true;
    this.pressed = { id: event.pointerId, x: event.clientX, y: event.clientY, tap: true };
    // Synthetic events have no pointer to capture.
    if (event.isTrusted) this.canvas.setPointerCapture(event.pointerId);
    this.scene()?.press?.(this.now.x, this.now.y);
    this.point('grabbing');
  }

  /** Shows by the cursor whether a press here would take hold of something. */
  private point(shape: 'grab' | 'grabbing'): void {
    this.canvas.classList.toggle(shape, this.scene()?.hover?.(this.now.x, this.now.y) === 'grab');
  }

  private move(event: PointerEvent): void {
    if (this.pressed !== null && event.pointerId !== this.pressed.id) return;
    this.place(event);
    const { pressed } = this;
    if (pressed === null) this.point('grab');
    else if (Math.hypot(event.clientX - pressed.x, event.clientY - pressed.y) > TAP) pressed.tap = false;
  }

  private release(event: PointerEvent, whole: boolean): void {
    if (this.pressed?.id !== event.pointerId) return;
    this.place(event);
    const { tap } = this.pressed;
    this.pressed = null;
    this.canvas.classList.remove('grabbing');
    this.scene()?.release?.(this.now.x, this.now.y, whole && tap);
    // A lifted finger has no position.
    if (event.pointerType === 'touch') this.now.present = false;
  }
}
