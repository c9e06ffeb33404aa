// Functions of both pages that use the package, for the test to call.

import { hashOfLife } from './lives.mjs';

/** Provides these functions as `window.page`. */
export function offer({ load, openMicrophone }, worker) {
  let wisp;
  let microphone;
  const winds = [];
  const page = {
    /** Starts the library and a model; returns milliseconds until the library runs, and until the first outline. */
    async start(model) {
      const began = performance.now();
      wisp = await load();
      const loaded = performance.now();
      const bank = wisp.model(await (await fetch(model)).arrayBuffer()).bank();
      bank.spawn();
      bank.advance(1e9);
      const points = bank.polylinesView().length;
      return { simd: wisp.simd, points, load: loaded - began, first: performance.now() - began };
    },

    async life(model, frames) {
      return hashOfLife(wisp, new Uint8Array(await (await fetch(model)).arrayBuffer()), frames);
    },

    /** Computes the hash of `life()` in a worker. */
    lifeInWorker(model, frames) {
      return new Promise((resolve, reject) => {
        worker.onmessage = (event) => resolve(event.data);
        worker.onerror = (event) => reject(new Error(event.message));
        worker.postMessage({ model: new URL(model, location.href).href, frames });
      });
    },

    /** Opens the microphone; returns its settings, or why there is none. */
    async listen(options) {
      page.lost = null;
      page.slept = [];
      try {
        microphone = await openMicrophone(wisp, {
          ...options,
          onWind: (wind) => winds.push(wind),
          onAsleep: (asleep) => page.slept.push(asleep),
          onLost: (error) => (page.lost = error.trouble),
        });
        return { raw: microphone.raw, settings: microphone.settings };
      } catch (error) {
        return { trouble: error.trouble, message: error.message };
      }
    },

    calibration: () => microphone.calibration(),
    calibrate: (...how) => microphone.calibrate(...how),
    /** Opens the microphone again, as after a long interruption, after a guided calibration that heard `known`. */
    reopen(known) {
      microphone.hear({ type: 'calibrated', known, heard: true });
      return microphone.reopen();
    },
    strongest: () => winds.reduce((most, { wind }) => Math.max(most, wind), 0),
  };
  window.page = page;
}
