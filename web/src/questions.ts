// SPDX-License-Identifier: Apache-2.0
// What the page asks of the scene's data: points under the pointer, and heights along a line.
import type { Vec3 } from "./camera/camera";
import type { Point } from "./camera/touch";
import { pickOf, placeOf, profileOf, seenPlace } from "./pick";
import type { ViewerPicked, ViewerProfiled } from "./protocol/messages";
import type { Socket } from "./protocol/socket";
import type { State } from "./state";
import type { Size } from "./view/size";

/** Points of a profile: enough for a chart, and quick. */
const profileSamples = 160;

export class Questions {
  private pickSequence = 0;
  /** That the picture had which was clicked. */
  private pickExaggeration = 1;
  private profileSequence = 0;
  /** A walk's question for ground, and who waits for the answer. */
  private ground: {
    sequence: number;
    answered: (answer: ViewerProfiled | undefined) => void;
  } | null = null;
  /** The pick that the camera is to turn to. */
  private turnTo = 0;

  constructor(
    private readonly socket: Pick<Socket, "pick" | "profile">,
    private readonly state: State,
    /** Turns the camera to a point. */
    private readonly turn: (to: Vec3) => void,
  ) {
    // Where heights are drawn otherwise, measured points lie elsewhere.
    state.shown.watch((shown) => {
      const [first] = state.measured.value;
      if (first !== undefined && first.exaggeration !== shown?.exaggeration) state.measured.set([]);
    });
  }

  private get hidden(): readonly number[] {
    return this.state.look.value.hidden;
  }

  /** Asks what is at a point of the canvas; false where it cannot be asked now. */
  pick(at: Point, canvas: Size, turns: boolean): boolean {
    const shown = this.state.shown.value;
    if (shown === null) return false;
    const place = seenPlace(shown, placeOf(at, canvas, shown));
    if (place === undefined) {
      this.state.pick.set({ kind: "nothing" });
      return false;
    }
    const sequence = this.pickSequence + 1;
    if (!this.socket.pick(sequence, shown, place)) {
      this.state.pick.set({ kind: "problem", text: "The server cannot be asked now" });
      return false;
    }
    this.pickSequence = sequence;
    this.pickExaggeration = shown.exaggeration;
    if (turns) this.turnTo = sequence;
    this.state.pick.set({ kind: "asking" });
    return true;
  }

  picked(answer: ViewerPicked): void {
    const { state } = this;
    if (Number(answer.sequence) !== this.pickSequence || state.pick.value === null) return;
    const pick = pickOf(answer, state.session.value?.objectNames ?? [], this.pickExaggeration);
    state.pick.set(pick);
    if (pick.kind !== "point") return;
    if (this.turnTo === this.pickSequence) this.turn(pick.position);
    else if (state.measuring.value && pick.exaggeration === state.shown.value?.exaggeration)
      state.measured.set([...state.measured.value, pick]);
  }

  /**
   * For a walk, in place of what it asked before; false while a person's profile is asked for, or
   * where it cannot be asked.
   */
  askGround(
    from: Vec3,
    to: Vec3,
    samples: number,
    answered: (answer: ViewerProfiled | undefined) => void,
  ): boolean {
    if (this.state.profile.value?.kind === "asking") return false;
    const sequence = this.profileSequence + 1;
    if (!this.socket.profile(sequence, from, to, samples, this.hidden)) return false;
    this.profileSequence = sequence;
    this.groundAnswered(undefined);
    this.ground = { sequence, answered };
    return true;
  }

  private groundAnswered(answer: ViewerProfiled | undefined): void {
    const { ground } = this;
    this.ground = null;
    ground?.answered(answer);
  }

  /** Asks for the heights between two points. */
  profile(from: Vec3, to: Vec3): void {
    this.groundAnswered(undefined); // the server answers the newest only
    const sequence = this.profileSequence + 1;
    if (!this.socket.profile(sequence, from, to, profileSamples, this.hidden)) return;
    this.profileSequence = sequence;
    this.state.profile.set({ kind: "asking", from, to });
  }

  profiled(answer: ViewerProfiled): void {
    if (Number(answer.sequence) === this.ground?.sequence) return this.groundAnswered(answer);
    const asked = this.state.profile.value;
    if (Number(answer.sequence) !== this.profileSequence || asked?.kind !== "asking") return;
    this.state.profile.set(profileOf(answer, asked.from, asked.to));
  }

  /** No answers come any more. */
  lost(): void {
    this.groundAnswered(undefined);
    if (this.state.pick.value?.kind === "asking") this.state.pick.set(null);
    if (this.state.profile.value?.kind === "asking") this.state.profile.set(null);
  }
}
