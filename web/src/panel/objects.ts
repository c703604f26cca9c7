// SPDX-License-Identifier: Apache-2.0
// The objects of a scene: each shown or left out, alone, brought into view, and with a shading and a
// colour of its own.
import type { Look, ObjectLook } from "../look";
import { fromHex, maxObjects, objectLook, toHex, withHidden, withObjectLook } from "../look";
import type { ObjectState } from "../protocol/messages";
import { ObjectKind } from "../protocol/messages";
import type { State } from "../state";
import type { Viewer } from "../viewer";
import { button, make } from "./element";
import { count } from "./format";
import { change } from "./look_controls";
import { shadings } from "./quality";

/** "Terrain · 1.74 M triangles"; "" while that is not known. */
export function objectText(object: ObjectState | undefined): string {
  if (object === undefined) return "";
  const kind = object.kind === ObjectKind.TERRAIN ? "Terrain" : "Mesh";
  return `${kind} · ${count(Number(object.triangles))} triangles`;
}

/** All but one; what is alone already brings the others back. */
export function alone(hidden: readonly number[], object: number, objects: number): number[] {
  const others = Array.from({ length: objects }, (_, i) => i).filter((i) => i !== object);
  const isAlone = !hidden.includes(object) && others.every((one) => hidden.includes(one));
  return isAlone ? [] : others;
}

/** What an object is first coloured: apart from its neighbours. */
const firstColours = ["#e0823d", "#3d8fe0", "#5cb85c", "#c25fc2", "#d9c13d", "#4fc3c3"] as const;

/** Part of the tree that follows the look. */
interface Shown {
  element: HTMLElement;
  show(look: Look): void;
}

/** Shading and colour of one object. */
function ownLook(state: State, object: number, name: string): Shown {
  const set = (by: Partial<ObjectLook>): void => {
    const { objects } = state.look.value;
    change(state, {
      objects: withObjectLook(objects, { ...objectLook(objects, object), ...by }),
    });
  };
  const shading = make("select", "shape object-shading", make("option", "", "As all"));
  shading.setAttribute("aria-label", `Shading of ${name}`);
  for (const [value, text] of shadings) {
    const option = make("option", "", text);
    option.value = String(value);
    shading.append(option);
  }
  shading.addEventListener("change", () => {
    const chosen = shadings.find(([value]) => String(value) === shading.value);
    set({ shading: chosen?.[0] ?? null });
  });
  const colour = make("input", "swatch");
  colour.type = "color";
  colour.setAttribute("aria-label", `Colour of ${name}`);
  colour.value = firstColours[object % firstColours.length] ?? firstColours[0];
  colour.addEventListener("input", () => set({ colour: fromHex(colour.value) }));
  const isColoured = make("input", "");
  isColoured.type = "checkbox";
  isColoured.setAttribute("aria-label", `One colour for ${name}`);
  isColoured.addEventListener("change", () =>
    set({ colour: isColoured.checked ? fromHex(colour.value) : null }),
  );
  const label = make("label", "object-label", isColoured, make("span", "", "One colour"));
  label.title = `All of ${name} in one colour, in place of those of its data`;
  return {
    element: make("div", "object-look", shading, label, colour),
    show({ objects }) {
      const look = objectLook(objects, object);
      shading.selectedIndex = 1 + shadings.findIndex(([value]) => value === look.shading);
      isColoured.checked = look.colour !== null;
      colour.hidden = look.colour === null;
      if (look.colour !== null) colour.value = toHex(look.colour);
    },
  };
}

function objectRow(state: State, viewer: Viewer, object: number): Shown {
  const { objectNames = [], objects = [] } = state.session.value ?? {};
  const name = objectNames[object] ?? "";
  const isShown = make("input", "");
  isShown.type = "checkbox";
  const hide = (hidden: readonly number[]): void => {
    if (hidden.length <= maxObjects) return change(state, { hidden });
    state.notice.set(`At most ${maxObjects} objects can be hidden`);
    isShown.checked = !state.look.value.hidden.includes(object);
  };
  isShown.addEventListener("change", () =>
    hide(withHidden(state.look.value.hidden, object, !isShown.checked)),
  );
  const title = make("span", "object-name", name);
  title.title = name;
  const label = make("label", "object-label", isShown, title);
  const only = button("Only", `Show ${name} alone, or all again`, () =>
    hide(alone(state.look.value.hidden, object, objectNames.length)),
  );
  const go = button("Go to", `Bring ${name} into view`, () => viewer.steering.goToObject(object));
  only.setAttribute("aria-label", only.title);
  go.setAttribute("aria-label", go.title);
  const facts = make("summary", "note", objectText(objects[object]) || "Look");
  facts.title = `How ${name} is shown`;
  const own = ownLook(state, object, name);
  const more = make("details", "object-facts", facts, own.element);
  return {
    element: make("li", "object", label, only, go, more),
    show(look) {
      isShown.checked = !look.hidden.includes(object);
      own.show(look);
    },
  };
}

export function objectTree(state: State, viewer: Viewer): HTMLElement {
  const list = make("ul", "objects");
  list.id = "objects";
  list.setAttribute("aria-label", "Objects of the scene");
  let key = "";
  let rows: Shown[] = [];
  state.session.watch((session) => {
    const { objectNames = [], objects = [] } = session ?? {};
    const now = JSON.stringify([objectNames, objects.map(objectText)]);
    if (now === key) return;
    key = now;
    rows = objectNames.map((_, i) => objectRow(state, viewer, i));
    for (const row of rows) row.show(state.look.value);
    list.replaceChildren(...rows.map(({ element }) => element));
  });
  state.look.watch((look) => {
    for (const row of rows) row.show(look);
  });
  return list;
}
