// SPDX-License-Identifier: Apache-2.0
// Views that a person has named, kept by the browser.
import type { SharedView } from "./share";
import { decodeView, encodeView } from "./share";
import type { NamedStorage } from "./storage";

export interface Bookmark {
  name: string;
  view: SharedView;
}

const key = "eyrie.bookmarks";

/** In the order of their names; what cannot be read is left out. */
export function readBookmarks(storage: NamedStorage): Bookmark[] {
  try {
    const entries: unknown = JSON.parse(storage.getItem(key) ?? "[]");
    if (!Array.isArray(entries)) return [];
    return entries.flatMap((entry: { name?: unknown; view?: unknown } | null) => {
      if (typeof entry?.name !== "string" || typeof entry.view !== "string") return [];
      const view = decodeView(entry.view);
      return view === undefined ? [] : [{ name: entry.name, view }];
    });
  } catch {
    return [];
  }
}

function write(storage: NamedStorage, bookmarks: readonly Bookmark[]): boolean {
  const sorted = [...bookmarks].sort((a, b) => a.name.localeCompare(b.name));
  try {
    const entries = sorted.map(({ name, view }) => ({ name, view: encodeView(view) }));
    storage.setItem(key, JSON.stringify(entries));
    return true;
  } catch {
    return false; // full, or forbidden
  }
}

const others = (storage: NamedStorage, name: string): Bookmark[] =>
  readBookmarks(storage).filter((one) => one.name !== name);

/** Replaces one of the same name; false where the browser keeps no more. */
export function addBookmark(storage: NamedStorage, name: string, view: SharedView): boolean {
  return write(storage, [...others(storage, name), { name, view }]);
}

export function removeBookmark(storage: NamedStorage, name: string): void {
  write(storage, others(storage, name));
}
