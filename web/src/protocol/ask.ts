// SPDX-License-Identifier: Apache-2.0

/** How the user is let in again; it ends once that is so. */
type SignIn = () => Promise<void>;
let signIn: SignIn | undefined;

/** What is refused for want of a token waits for this, and is asked once more. */
export function onUnknown(how: SignIn | undefined): void {
  signIn = how;
}

async function reach(address: string, request: RequestInit): Promise<Response> {
  try {
    return await fetch(address, request);
  } catch {
    throw new Error("the server does not answer; see that it runs, and try again");
  }
}

const aborted = (signal: AbortSignal | null | undefined): Promise<void> =>
  new Promise((resolve) => signal?.addEventListener("abort", () => resolve(), { once: true }));

/** As fetch; throws an Error, for the user to read, where no server answers. */
export async function ask(address: string, request: RequestInit): Promise<Response> {
  const response = await reach(address, request);
  if (response.status !== 401 || signIn === undefined) return response;
  await Promise.race([signIn(), aborted(request.signal)]);
  return reach(address, request);
}
