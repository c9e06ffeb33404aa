// The engine: a worker that captures and learns. Started at first use, and again after a failure.

import type { Studio } from '@wisp/studio';

export class Engine {
  private studio: Promise<Studio> | null = null;

  /** Loads and starts it; may be called twice. Rejects with a sentence where this browser cannot run it. */
  open(): Promise<Studio> {
    this.studio ??= import('@wisp/studio')
      .then(({ Studio }) => Studio.open())
      .catch((error: unknown) => {
        this.studio = null;
        throw error;
      });
    return this.studio;
  }

  /** After a failure, starts later work in a new worker, with fresh memory. */
  renew(): void {
    const failed = this.studio;
    this.studio = null;
    failed?.then(
      (studio) => studio.close(),
      () => undefined,
    );
  }
}
