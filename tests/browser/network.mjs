// SPDX-License-Identifier: Apache-2.0
// The network of two hosts that tests/support/network_link.cpp runs a test in: the browser is on
// one, and servers on the other.
import { readSync, writeSync } from "node:fs";

function given(name) {
  const value = process.env[name];
  if (!value) throw new Error(`set by network_link, which is to run this: ${name}`);
  return value;
}

export class Network {
  #there = given("EYRIE_LINK_THERE");
  #control = Number(given("EYRIE_LINK_CONTROL"));

  /** The other host's. */
  address = given("EYRIE_LINK_ADDRESS");

  /** What starts a program on the other host: a command and its arguments. */
  there(command, args) {
    return ["nsenter", [`--net=${this.#there}`, command, ...args]];
  }

  /**
   * Of the link either way, from now on; what is left out stays as it is. `megabits` a second, 0
   * for no limit; `delay` in milliseconds; `loss`, of the packets, from 0 to 1, which parts the
   * hosts.
   */
  set({ megabits, delay, loss }) {
    if (megabits !== undefined) this.#tell(`rate ${megabits * 1e6}`);
    if (delay !== undefined) this.#tell(`delay ${delay}`);
    if (loss !== undefined) this.#tell(`loss ${loss}`);
  }

  #tell(line) {
    writeSync(this.#control, `${line}\n`);
    const answer = Buffer.alloc(300);
    const said = answer.toString("utf8", 0, readSync(this.#control, answer)).trim();
    if (said !== "ok") throw new Error(said);
  }
}
