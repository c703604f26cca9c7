// SPDX-License-Identifier: Apache-2.0
// What is asked for besides the camera: the error or frame time, the shading, and the look.
import type { SharedView } from "./share";
import type { State } from "./state";

export type Settings = Omit<SharedView, "camera">;

export function settingsOf({ tau, budget, shading, look }: State): Settings {
  return { tau: tau.value, budget: budget.value, shading: shading.value, look: look.value };
}

export function areSame(a: Settings, b: Settings): boolean {
  const text = ({ tau, budget, shading, look }: Settings): string =>
    JSON.stringify([tau, budget, shading, look]);
  return text(a) === text(b);
}

/** Nobody is told where nothing changes, as with most frames that are watched. */
export function applySettings(state: State, settings: Settings): void {
  if (areSame(settingsOf(state), settings)) return;
  state.tau.set(settings.tau);
  state.budget.set(settings.budget);
  state.shading.set(settings.shading);
  state.look.set(settings.look);
}

/**
 * Calls `changed` with each change; `settled` once everybody has heard of it, and those that come
 * with it are made. Returns how to end that.
 */
export function watchSettings(state: State, changed: () => void, settled: () => void): () => void {
  const ends = [state.tau, state.budget, state.shading, state.look].map((value) =>
    value.watch(() => {
      changed();
      queueMicrotask(settled);
    }),
  );
  return () => ends.forEach((end) => end());
}
