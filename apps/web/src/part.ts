// Loading of page parts after the start, with retries.

/** Milliseconds before each retry. */
const WAITS = [300, 1200];

/** Loads a part, with retries. Throws a sentence for people. */
export async function fetchPart<T>(bring: () => Promise<T>, [wait, ...later]: readonly number[] = WAITS): Promise<T> {
  try {
    return await bring();
  } catch (error) {
    if (wait === undefined) throw new Error('A piece of this page could not be fetched. Is there a network? Press again, or load the page anew.', { cause: error });
    await new Promise((resolve) => setTimeout(resolve, wait));
    return fetchPart(bring, later);
  }
}

/** Returns a function that does the work at its first call, and again at a call after a failure. */
export function once<T>(work: () => Promise<T>): () => Promise<T> {
  let coming: Promise<T> | null = null;
  return () =>
    (coming ??= work().catch((error: unknown) => {
      coming = null;
      throw error;
    }));
}
