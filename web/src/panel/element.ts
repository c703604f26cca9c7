// SPDX-License-Identifier: Apache-2.0

/** The element of the page with this id; the page is broken without it. */
export function byId<T extends Element>(id: string, type: new () => T): T {
  const element = document.getElementById(id);
  if (!(element instanceof type)) throw new Error(`index.html has no ${type.name} #${id}`);
  return element;
}

/** A new element with a class and text or children. */
export function make<K extends keyof HTMLElementTagNameMap>(
  tag: K,
  className: string,
  ...children: (Node | string)[]
): HTMLElementTagNameMap[K] {
  const element = document.createElement(tag);
  element.className = className;
  element.append(...children);
  return element;
}

/** A small button; its title is for those who rest the pointer on it. */
export function button(text: string, title: string, action: () => void): HTMLButtonElement {
  const element = make("button", "small", text);
  element.type = "button";
  element.title = title;
  element.addEventListener("click", action);
  return element;
}

/** Sets text only where it differs, so that screen readers hear changes alone. */
export function setText(element: Element, text: string): void {
  if (element.textContent !== text) element.textContent = text;
}
