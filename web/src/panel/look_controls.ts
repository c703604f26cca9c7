// SPDX-License-Identifier: Apache-2.0
// Sliders and switches of the look.
import type { Look } from "../look";
import { defaultLook } from "../look";
import type { State } from "../state";
import { make, setText } from "./element";

export const change = (state: State, by: Partial<Look>): void =>
  state.look.set({ ...state.look.value, ...by });

interface SliderOptions {
  id: string;
  name: string;
  title: string;
  min: number;
  max: number;
  step: number;
  placeOf(look: Look): number;
  text(look: Look): string;
  change(place: number): Partial<Look>;
}

export function slider(state: State, options: SliderOptions): HTMLElement {
  const label = make("label", "label", options.name);
  const output = make("output", "value");
  const input = make("input", "slider");
  input.type = "range";
  input.id = options.id;
  [input.min, input.max, input.step] = [options.min, options.max, options.step].map(String) as [
    string,
    string,
    string,
  ];
  label.htmlFor = output.htmlFor.value = input.id;
  label.title = options.title;
  input.addEventListener("input", () => change(state, options.change(Number(input.value))));
  input.addEventListener("dblclick", () => {
    const place = options.placeOf(defaultLook);
    change(state, options.change(place));
  });
  state.look.watch((look) => {
    const place = options.placeOf(look);
    if (Number(input.value) !== place) input.value = String(place);
    setText(output, options.text(look));
    input.setAttribute("aria-valuetext", options.text(look));
  });
  return make("div", "field", make("div", "row", label, output), input);
}

interface Toggle {
  id: string;
  name: string;
  title: string;
  isOn(look: Look): boolean;
  set(isOn: boolean): void;
}

export function toggles(state: State, name: string, list: readonly Toggle[]): HTMLElement {
  const group = make("div", "toggles");
  group.setAttribute("role", "group");
  group.setAttribute("aria-label", name);
  for (const toggle of list) {
    const button = make("button", "toggle", toggle.name);
    button.type = "button";
    button.id = toggle.id;
    button.title = toggle.title;
    button.addEventListener("click", () => toggle.set(!toggle.isOn(state.look.value)));
    state.look.watch((look) => button.setAttribute("aria-pressed", String(toggle.isOn(look))));
    group.append(button);
  }
  return group;
}
