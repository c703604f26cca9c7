// SPDX-License-Identifier: Apache-2.0

/** As fetch; throws an Error, for the user to read, where no server answers. */
export async function ask(address: string, request: RequestInit): Promise<Response> {
  try {
    return await fetch(address, request);
  } catch {
    throw new Error("the server does not answer; see that it runs, and try again");
  }
}
