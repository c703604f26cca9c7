// SPDX-License-Identifier: Apache-2.0
// How terrain is shown: height, colours, contour lines, and what the engine did.
import { groundHeights } from "../drawn_bounds";
import type { Colouring } from "../look";
import { exaggerationAt, nextInterval, placeOf, suggestedInterval } from "../look";
import type { State } from "../state";
import type { Viewer } from "../viewer";
import { byId, make, setText } from "./element";
import { metres, times } from "./format";
import { onHeldKeys, onKeys } from "./keys";
import { change, slider, toggles } from "./look_controls";
import { transferEditor } from "./transfer";

const colourings: readonly (readonly [Colouring, string])[] = [
  ["tints", "Tints"],
  ["edited", "Edited"],
  ["bare", "Bare"],
];

const reliefOf = ({ session }: State): number => {
  const [lowest, highest] = (session.value && groundHeights(session.value)) ?? [0, 1000];
  return highest - lowest;
};

function colouringChoice(state: State): HTMLElement {
  const choice = make("fieldset", "segments", make("legend", "label", "Colours"));
  for (const [colouring, name] of colourings) {
    const input = make("input", "");
    input.type = "radio";
    input.name = "colouring";
    input.value = colouring;
    input.addEventListener("change", () => change(state, { colouring }));
    state.look.watch((look) => (input.checked = look.colouring === colouring));
    choice.append(make("label", "segment", input, make("span", "", name)));
  }
  return choice;
}

function contourField(state: State): HTMLElement {
  const label = make("span", "label", "Contour lines");
  label.title = "Metres of elevation between two; every fifth is stronger (C)";
  const value = make("output", "value");
  const step = (text: string, name: string, by: 1 | -1): HTMLElement => {
    const button = make("button", "step", text);
    button.type = "button";
    button.setAttribute("aria-label", name);
    button.addEventListener("click", () => {
      const { contourMetres } = state.look.value;
      const isFirst = contourMetres === 0 && by === 1;
      change(state, {
        contourMetres: isFirst
          ? suggestedInterval(reliefOf(state))
          : nextInterval(contourMetres, by),
      });
    });
    return button;
  };
  state.look.watch(({ contourMetres }) =>
    setText(value, contourMetres > 0 ? `every ${metres(contourMetres)}` : "off"),
  );
  const less = step("−", "Smaller contour interval", -1);
  const more = step("+", "Larger contour interval", 1);
  return make("div", "field row", label, make("span", "stepper", less, value, more));
}

export function showTerrain(state: State, viewer: Viewer): void {
  const toggleContours = (): void =>
    change(state, {
      contourMetres: state.look.value.contourMetres > 0 ? 0 : suggestedInterval(reliefOf(state)),
    });
  const toggleFrozen = (): void => viewer.setFrozen(state.look.value.frozen === null);
  const toggleUnderground = (): void =>
    change(state, { underground: !state.look.value.underground });
  const exaggerate = (step: number): void => {
    const place = Math.round((placeOf(state.look.value.exaggeration) + step) * 20) / 20;
    change(state, { exaggeration: exaggerationAt(Math.min(1, Math.max(-1, place))) });
  };

  byId("terrain", HTMLElement).append(
    make("h2", "heading", "Terrain"),
    slider(state, {
      id: "exaggeration",
      name: "Height",
      title: "Heights are drawn times this ([ and ]; double-click or \\: true)",
      min: -1,
      max: 1,
      step: 0.05,
      placeOf: (look) => Math.round(placeOf(look.exaggeration) * 20) / 20,
      text: (look) => times(look.exaggeration),
      change: (place) => ({ exaggeration: exaggerationAt(place) }),
    }),
    slider(state, {
      id: "saturation",
      name: "Saturation",
      title: "Grey to gaudy (double-click: as it is)",
      min: 0,
      max: 2,
      step: 0.05,
      placeOf: (look) => look.saturation,
      text: (look) => look.saturation.toFixed(2),
      change: (saturation) => ({ saturation }),
    }),
    contourField(state),
    colouringChoice(state),
    transferEditor(state),
    toggles(state, "What the engine did", [
      {
        id: "tile-bounds",
        name: "Boxes",
        title: "Boxes around the tiles of terrain and the nodes of meshes that are drawn",
        isOn: (look) => look.tileBounds,
        set: (tileBounds) => change(state, { tileBounds }),
      },
      {
        id: "page-bounds",
        name: "Pages",
        title: "Boxes around the pages that the view needs",
        isOn: (look) => look.pageBounds,
        set: (pageBounds) => change(state, { pageBounds }),
      },
      {
        id: "level-tint",
        name: "Levels",
        title: "A colour for each level of detail",
        isOn: (look) => look.levelTint,
        set: (levelTint) => change(state, { levelTint }),
      },
      {
        id: "frozen",
        name: "Freeze",
        title: "Hold what is drawn as chosen for this camera, and move on (X)",
        isOn: (look) => look.frozen !== null,
        set: toggleFrozen,
      },
      {
        id: "underground",
        name: "Underground",
        title: "Let the camera go below the ground (U)",
        isOn: (look) => look.underground,
        set: toggleUnderground,
      },
    ]),
  );

  onKeys({ c: toggleContours, x: toggleFrozen, u: toggleUnderground });
  onHeldKeys({
    "[": () => exaggerate(-0.1),
    "]": () => exaggerate(0.1),
    "\\": () => change(state, { exaggeration: 1 }),
  });
}
