// SPDX-License-Identifier: Apache-2.0
import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";
import { copyText } from "./clipboard";

/** Of a page: beside an open sheet nothing takes the focus. */
class FakeElement {
  isInert = false;
  value = "";
  append(area: FakeElement): void {
    area.isInert = this.isInert;
  }
  focus(): void {
    if (!this.isInert) page.activeElement = this;
  }
  select(): void {}
  remove(): void {
    if (page.activeElement === this) page.activeElement = page.body;
  }
}

const page = {
  body: new FakeElement(),
  activeElement: new FakeElement(),
  sheet: null as FakeElement | null,
  copied: "",
  querySelector: (selector: string) => (selector === "dialog[open]" ? page.sheet : null),
  createElement: () => new FakeElement(),
  execCommand: () => {
    page.copied = page.activeElement.value;
    return true; // whatever has the focus
  },
};

describe("a text, where the browser gives the page no clipboard,", () => {
  beforeEach(() => {
    vi.stubGlobal("navigator", {});
    vi.stubGlobal("HTMLElement", FakeElement);
    vi.stubGlobal("document", page);
    page.copied = "";
    page.body.isInert = false;
    page.sheet = null;
  });
  afterEach(() => void vi.unstubAllGlobals());

  it("is copied, and the focus stays where it was", async () => {
    const button = new FakeElement();
    button.focus();
    expect(await copyText("eyrie render")).toBe(true);
    expect(page.copied).toBe("eyrie render");
    expect(page.activeElement).toBe(button);
  });

  it("is copied from within a sheet that makes all else inert", async () => {
    page.sheet = new FakeElement();
    page.body.isInert = true;
    expect(await copyText("eyrie render")).toBe(true);
    expect(page.copied).toBe("eyrie render");
  });

  it("is not said to be where it cannot be selected", async () => {
    page.body.isInert = true;
    expect(await copyText("eyrie render")).toBe(false);
  });
});
