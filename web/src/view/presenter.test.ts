// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { Presenter } from "./presenter";

/** A presenter of texts, each decoded when the test says so. */
function made() {
  const told: string[] = [];
  const decoding = new Map<string, (isGood: boolean) => void>();
  const presenter = new Presenter<string, string>({
    decode: (picture) =>
      new Promise((resolve, reject) => {
        decoding.set(picture, (isGood) => {
          if (isGood) resolve(picture);
          else reject(new Error("no picture"));
        });
      }),
    draw: (frameNumber) => told.push(`draw ${frameNumber}`),
    drop: (decoded) => told.push(`drop ${decoded}`),
    ready: (frameNumber) => told.push(`ready ${frameNumber}`),
    failed: (frameNumber) => told.push(`failed ${frameNumber}`),
  });
  const decoded = async (picture: string, isGood = true): Promise<void> => {
    decoding.get(picture)?.(isGood);
    await new Promise((resolve) => setTimeout(resolve, 0));
  };
  return { presenter, told, decoded };
}

describe("a presenter", () => {
  it("draws what does not wait as soon as it is decoded", async () => {
    const { presenter, told, decoded } = made();
    presenter.show(1, "a", false);
    expect(told).toEqual([]);
    await decoded("a");
    expect(told).toEqual(["draw 1"]);
  });

  it("keeps what waits until it is presented", async () => {
    const { presenter, told, decoded } = made();
    presenter.show(1, "a", true);
    await decoded("a");
    expect(told).toEqual(["ready 1"]);
    presenter.present(2);
    expect(told).toEqual(["ready 1"]);
    presenter.present(1);
    expect(told).toEqual(["ready 1", "draw 1"]);
    presenter.present(1);
    expect(told).toEqual(["ready 1", "draw 1"]);
  });

  it("draws at once what was presented before it was decoded", async () => {
    const { presenter, told, decoded } = made();
    presenter.show(1, "a", true);
    presenter.present(1);
    await decoded("a");
    expect(told).toEqual(["draw 1"]);
  });

  it("decodes only the newest of what arrives meanwhile", async () => {
    const { presenter, told, decoded } = made();
    presenter.show(1, "a", false);
    presenter.show(2, "b", false);
    presenter.show(3, "c", true);
    await decoded("a");
    await decoded("c");
    expect(told).toEqual(["draw 1", "ready 3"]);
  });

  it("drops what waits when something newer is there", async () => {
    const { presenter, told, decoded } = made();
    presenter.show(1, "a", true);
    await decoded("a");
    presenter.show(2, "b", false);
    presenter.present(1);
    await decoded("b");
    expect(told).toEqual(["ready 1", "draw 1", "draw 2"]);
    presenter.show(3, "c", true);
    await decoded("c");
    presenter.show(4, "d", true);
    await decoded("d");
    presenter.present(3);
    presenter.present(4);
    expect(told.slice(3)).toEqual(["ready 3", "drop c", "ready 4", "draw 4"]);
  });

  it("says what cannot be decoded, and goes on", async () => {
    const { presenter, told, decoded } = made();
    presenter.show(1, "a", true);
    await decoded("a", false);
    presenter.show(2, "b", true);
    await decoded("b");
    expect(told).toEqual(["failed 1", "ready 2"]);
  });

  it("takes numbers of another connection for new ones", async () => {
    const { presenter, told, decoded } = made();
    presenter.present(1);
    presenter.forget();
    presenter.show(1, "a", true);
    await decoded("a");
    expect(told).toEqual(["ready 1"]);
    presenter.forget();
    presenter.present(1);
    expect(told).toEqual(["ready 1", "drop a"]);
  });
});
