// SPDX-License-Identifier: Apache-2.0
// Where the browser keeps what a person has named.

/** What of a browser's storage is needed. */
export type NamedStorage = Pick<Storage, "getItem" | "setItem">;

/** Of a browser that keeps nothing for this page. */
const none: NamedStorage = {
  getItem: () => null,
  setItem: () => {
    throw new Error("this browser keeps nothing");
  },
};

/** The browser's own; where it forbids that, as with all cookies blocked, the mere look throws. */
export function browserStorage(): NamedStorage {
  try {
    return window.localStorage;
  } catch {
    return none;
  }
}
