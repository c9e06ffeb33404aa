// Loading of page parts after the start, with retries.

export { once } from '@wisp/player/parts/library';

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
