// SPDX-License-Identifier: Apache-2.0
// Keys that are commands by the letter they type, wherever that lies on a keyboard. Where it lies at
// W, A, S, D, Q or E, as O does on Dvorak's, the key does not fly.

/** By KeyboardEvent.key in lower case: the controls' own, and those that are added. */
const keys = new Set(["r", "f", "t"]);

export function addCommands(added: readonly string[]): void {
  for (const key of added) keys.add(key);
}

export const isCommand = (key: string): boolean => keys.has(key.toLowerCase());
