// SPDX-License-Identifier: Apache-2.0
// Flights that a person has named, kept by the browser.
import type { NamedStorage } from "../storage";
import { flightJson, flightOfJson } from "./file";
import type { Flight } from "./flight";

const key = "eyrie.flights";

/** In the order of their names; what cannot be read is left out. */
export function readFlights(storage: NamedStorage): Flight[] {
  try {
    const texts: unknown = JSON.parse(storage.getItem(key) ?? "[]");
    if (!Array.isArray(texts)) return [];
    return texts.flatMap((text: unknown) => {
      try {
        return typeof text === "string" ? [flightOfJson(text, "flight")] : [];
      } catch {
        return [];
      }
    });
  } catch {
    return [];
  }
}

/** Whether it is among them as it is now, or has nothing to be kept. */
export const isKept = (storage: NamedStorage, flight: Flight): boolean =>
  flight.keys.length === 0 ||
  readFlights(storage).some((one) => flightJson(one) === flightJson(flight));

function write(storage: NamedStorage, flights: readonly Flight[]): boolean {
  const sorted = [...flights].sort((a, b) => a.name.localeCompare(b.name));
  try {
    storage.setItem(key, JSON.stringify(sorted.map(flightJson)));
    return true;
  } catch {
    return false; // full, or forbidden
  }
}

const others = (storage: NamedStorage, name: string): Flight[] =>
  readFlights(storage).filter((one) => one.name !== name);

/** Replaces one of the same name; false where the browser keeps no more. */
export const keepFlight = (storage: NamedStorage, flight: Flight): boolean =>
  write(storage, [...others(storage, flight.name), flight]);

export function removeFlight(storage: NamedStorage, name: string): void {
  write(storage, others(storage, name));
}
