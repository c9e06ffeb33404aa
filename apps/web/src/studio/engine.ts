// The engine: a worker that captures and learns. Opened when it is wanted, and anew after it failed.

import type { Studio } from '@wisp/studio';

export class Engine {
  private studio: Promise<Studio> | null = null;

  /** Fetches and starts it; twice is fine. Rejects with a sentence where this browser cannot. */
  open(): Promise<Studio> {
    this.studio ??= import('@wisp/studio')
      .then(({ Studio }) => Studio.open())
      .catch((error: unknown) => {
        this.studio = null;
        throw error;
      });
    return this.studio;
  }

  /** After a failure the next work begins in a worker of its own: memory that ran out is free again. */
  renew(): void {
    const failed = this.studio;
    this.studio = null;
    failed?.then(
      (studio) => studio.close(),
      () => undefined,
    );
  }
}
