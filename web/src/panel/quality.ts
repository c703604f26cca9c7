// SPDX-License-Identifier: Apache-2.0
// What to ask for: the error tau, and how surfaces are drawn.
import { Shading } from "../protocol/messages";
import type { Numbers, State } from "../state";
import { byId, make, setText } from "./element";
import { degrees, milliseconds, pixels } from "./format";

/** The slider holds log2(tau): from a quarter of a pixel to sixteen. */
const minLog = -2;
const maxLog = 4;
const stepLog = 0.25;

export const shadings: readonly (readonly [Shading, string])[] = [
  [Shading.SMOOTH, "Smooth"],
  [Shading.GOURAUD, "Gouraud"],
  [Shading.FLAT, "Flat"],
  [Shading.WIREFRAME, "Wireframe"],
];

/** Milliseconds of a frame that may be asked for here, and what is asked for first. */
const minBudget = 10;
const maxBudget = 200;
const firstBudget = 33;

/** Whether the error is to be held or the frame time. */
function choiceOfMode(state: State): HTMLElement {
  const choice = make("fieldset", "segments", make("legend", "label", "What is held"));
  for (const [budget, name, title] of [
    [null, "Fixed error", "Every picture keeps the error, however long it takes"],
    [firstBudget, "Fixed frame time", "Coarser while the view moves, so that frames come in time"],
  ] as const) {
    const input = make("input", "");
    input.type = "radio";
    input.name = "held";
    input.addEventListener("change", () => state.budget.set(budget));
    state.budget.watch((value) => (input.checked = (value === null) === (budget === null)));
    const segment = make("label", "segment", input, make("span", "", name));
    segment.title = title;
    choice.append(segment);
  }
  return choice;
}

function budgetSlider(state: State): HTMLElement {
  const label = make("label", "label", "Frame time");
  label.title = "How long a picture may take to make while the view moves";
  const output = make("output", "value");
  const slider = make("input", "slider");
  slider.type = "range";
  slider.id = "budget";
  slider.min = String(minBudget);
  slider.max = String(maxBudget);
  slider.value = String(firstBudget);
  label.htmlFor = output.htmlFor.value = slider.id;
  slider.addEventListener("input", () => state.budget.set(Number(slider.value)));
  const ends = make("div", "ends", make("span", "", "faster"), make("span", "", "finer"));
  const field = make("div", "field", make("div", "row", label, output), slider, ends);
  state.budget.watch((budget) => {
    field.hidden = budget === null;
    if (budget === null) return;
    slider.value = String(budget);
    setText(output, milliseconds(budget));
    slider.setAttribute("aria-valuetext", `${budget} milliseconds`);
  });
  return field;
}

/** Why a frame time is not held, or "". */
export function budgetHint(numbers: Numbers): string {
  if (numbers.predictedMilliseconds <= numbers.budgetMilliseconds) return "";
  return "takes longer even at its coarsest and smallest";
}

/** How long the last picture took, of what it was given; at rest there is no limit. */
function timeAchieved(state: State): HTMLElement {
  const label = make("span", "label", "Taken");
  label.title = "By the last picture of the moving view, and what was foreseen for it";
  const value = make("span", "value", "–");
  const hint = make("p", "hint");
  const field = make("div", "field", make("div", "row", label, value), hint);
  state.budget.watch((budget) => (field.hidden = budget === null));
  state.numbers.watch((numbers) => {
    if (numbers === null || numbers.budgetMilliseconds === 0) return;
    const taken = milliseconds(numbers.renderMilliseconds);
    setText(value, `${taken}, foreseen ${milliseconds(numbers.predictedMilliseconds)}`);
    setText(hint, budgetHint(numbers));
    hint.hidden = hint.textContent === "";
  });
  return field;
}

function tauSlider(state: State): HTMLElement {
  const label = make("label", "label", "Error allowed");
  const output = make("output", "value");
  const slider = make("input", "slider");
  slider.type = "range";
  slider.id = "tau";
  slider.min = String(minLog);
  slider.max = String(maxLog);
  slider.step = String(stepLog);
  label.htmlFor = output.htmlFor.value = slider.id;
  label.title = "Tau: how far, in pixels, anything may be from where it belongs on the screen";
  slider.addEventListener("input", () => state.tau.set(2 ** Number(slider.value)));
  state.budget.watch((budget) =>
    setText(label, budget === null ? "Error allowed" : "Error at rest"),
  );
  state.tau.watch((tau) => {
    slider.value = String(Math.log2(tau));
    setText(output, pixels(tau));
    slider.setAttribute("aria-valuetext", `${tau.toFixed(2)} pixels`);
  });
  const ends = make("div", "ends", make("span", "", "finer"), make("span", "", "faster"));
  return make("div", "field", make("div", "row", label, output), slider, ends);
}

/** Rounding on the way must not look like a broken promise. */
const tolerance = 1 + 1e-6;

/** Why the error drawn is larger than the one asked for, or "". */
export function tauHint(numbers: Numbers): string {
  if (numbers.frozen) return "the cut is frozen: nothing is promised";
  if (numbers.tauAchieved <= numbers.tauAsked * tolerance) return "";
  if (numbers.complete && numbers.budgetTau > numbers.tauAsked)
    return "coarser, to be in time; finer at rest";
  if (numbers.complete) return "finest data drawn, or all that memory holds";
  return numbers.pagesMissing > numbers.pagesFailed
    ? "refining while data are loaded"
    : "incomplete: data are missing";
}

function tauAchieved(state: State): HTMLElement {
  const label = make("span", "label", "Error drawn");
  label.title = "A bound on how far anything in this picture is from where it belongs";
  const value = make("span", "value", "–");
  const hint = make("p", "hint");
  state.numbers.watch((numbers) => {
    const reason = numbers === null ? "" : tauHint(numbers);
    setText(value, numbers === null ? "–" : pixels(numbers.tauAchieved));
    setText(hint, reason);
    hint.hidden = reason === "";
    value.classList.toggle("is-warning", reason !== "");
  });
  return make("div", "field", make("div", "row", label, value), hint);
}

/** How far normals of meshes may be off, and what says more; null where they are the source's. */
export function normalsText(numbers: Numbers | null): { value: string; title: string } | null {
  if (numbers === null || numbers.normalDegrees === 0) return null;
  return {
    value: `${degrees(numbers.normalMeanDegrees)} on average`,
    title: `A bound on how far the normals of meshes, which light goes by, are turned from the source's: on average over any part, and by at most ${degrees(numbers.normalDegrees)} anywhere. Error allowed does not hold it`,
  };
}

function normalsDrawn(state: State): HTMLElement {
  const label = make("span", "label", "Normals drawn");
  const value = make("span", "value");
  const field = make("div", "field", make("div", "row", label, value));
  state.numbers.watch((numbers) => {
    const text = normalsText(numbers);
    field.hidden = text === null;
    setText(value, text?.value ?? "");
    label.title = text?.title ?? "";
  });
  return field;
}

function shadingChoice(state: State): HTMLElement {
  const choice = make("fieldset", "segments", make("legend", "label", "Shading"));
  for (const [shading, name] of shadings) {
    const input = make("input", "");
    input.type = "radio";
    input.name = "shading";
    input.value = name.toLowerCase();
    input.addEventListener("change", () => state.shading.set(shading));
    state.shading.watch((value) => (input.checked = value === shading));
    choice.append(make("label", "segment", input, make("span", "", name)));
  }
  return choice;
}

export function showQuality(state: State): void {
  byId("quality", HTMLElement).append(
    make("h2", "heading", "Quality"),
    choiceOfMode(state),
    budgetSlider(state),
    timeAchieved(state),
    tauSlider(state),
    tauAchieved(state),
    normalsDrawn(state),
    shadingChoice(state),
  );
}
