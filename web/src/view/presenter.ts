// SPDX-License-Identifier: Apache-2.0
// Which of the pictures that arrive are decoded, and when they are drawn: at once, or at the word
// that all screens behind a swap barrier have theirs.

export interface PresenterEvents<Picture, Decoded> {
  decode(picture: Picture): Promise<Decoded>;
  /** It will not be decoded: a newer one has come. */
  skip?(picture: Picture): void;
  draw(frameNumber: number, decoded: Decoded): void;
  /** It will not be drawn. */
  drop(decoded: Decoded): void;
  /** It has been decoded, and waits to be presented. */
  ready(frameNumber: number): void;
  failed(frameNumber: number): void;
}

interface Work<Picture> {
  frameNumber: number;
  picture: Picture;
  waits: boolean;
}

/** While a picture is decoded, only the newest of those that arrive is kept. */
export class Presenter<Picture, Decoded> {
  private newest: Work<Picture> | null = null;
  private isBusy = false;
  private held: { frameNumber: number; decoded: Decoded } | null = null;
  /** Said to be presented before it was decoded. */
  private presented = 0;

  constructor(private readonly events: PresenterEvents<Picture, Decoded>) {}

  /** Frame numbers ascend, until they begin anew. `waits`: until it is presented. */
  show(frameNumber: number, picture: Picture, waits: boolean): void {
    if (this.newest !== null) this.events.skip?.(this.newest.picture);
    this.newest = { frameNumber, picture, waits };
    if (!this.isBusy) void this.work();
  }

  /** Draws that picture, now or once it is decoded; nothing where a newer one has come. */
  present(frameNumber: number): void {
    this.presented = frameNumber;
    if (this.held?.frameNumber !== frameNumber) return;
    this.events.draw(frameNumber, this.held.decoded);
    this.held = null;
  }

  /** What comes now is of another connection. */
  forget(): void {
    if (this.held !== null) this.events.drop(this.held.decoded);
    this.held = null;
    this.presented = 0;
  }

  private async work(): Promise<void> {
    this.isBusy = true;
    while (this.newest !== null) {
      const work = this.newest;
      this.newest = null;
      const decoded = await this.events.decode(work.picture).catch(() => null);
      if (decoded === null) this.events.failed(work.frameNumber);
      else this.decoded(work, decoded);
    }
    this.isBusy = false;
  }

  private decoded({ frameNumber, waits }: Work<Picture>, decoded: Decoded): void {
    if (this.held !== null) this.events.drop(this.held.decoded);
    this.held = null;
    if (!waits || this.presented === frameNumber) {
      this.events.draw(frameNumber, decoded);
      return;
    }
    this.held = { frameNumber, decoded };
    this.events.ready(frameNumber);
  }
}
