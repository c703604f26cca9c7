// SPDX-License-Identifier: Apache-2.0
// Keys that are commands by the letter they type, wherever that lies on a keyboard. Where it lies at
// W, A, S, D, Q or E, as O does on Dvorak's, the key does not fly. Keys of other scripts are commands
// by where they lie.

/** By KeyboardEvent.key in lower case: the controls' own, and those that are added. */
const keys = new Set(["r", "f", "t"]);

export function addCommands(added: readonly string[]): void {
  for (const key of added) keys.add(key);
}

const otherScripts = /^(?:(?!\p{Script=Latin})\p{Letter})+$/u;

/** What a key types, as KeyboardEvent.key; of another script than ours, the letter that lies there. */
export function letterOf({ key, code }: Pick<KeyboardEvent, "key" | "code">): string {
  const isLetterHere = otherScripts.test(key) && code.startsWith("Key");
  return isLetterHere ? code.slice("Key".length).toLowerCase() : key;
}

export const isCommand = (key: string): boolean => keys.has(key.toLowerCase());
