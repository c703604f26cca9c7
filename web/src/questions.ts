// SPDX-License-Identifier: Apache-2.0
// What the page asks of the scene's data: points under the pointer, and heights along a line.
import type { Vec3 } from "./camera/camera";
import type { Point } from "./camera/touch";
import { pickOf, placeOf, profileOf, seenPlace } from "./pick";
import type { Place, Shown, ViewerPicked, ViewerProfiled } from "./protocol/messages";
import type { Socket } from "./protocol/socket";
import type { PickedPoint, State } from "./state";
import type { Size } from "./view/size";

/** Points of a profile: enough for a chart, and quick. */
const profileSamples = 160;

/** A double click's own clicks are no farther from it, in CSS pixels. */
const doubleClickSlack = 8;

const cannotAsk = { kind: "problem", text: "The server cannot be asked now" } as const;

/** What was clicked at, of the picture that was seen then. */
interface Click {
  at: Point;
  shown: Shown;
  place: Place;
  /** The camera is to turn there. */
  turns: boolean;
  /** What is there may be added to what is measured. */
  measures: boolean;
  /** What was added. */
  measured?: PickedPoint;
}

export class Questions {
  private pickSequence = 0;
  /** Not answered yet. */
  private asked: Click | null = null;
  /** The server answers the newest only: while measuring, each click waits for those before it. */
  private waiting: Click[] = [];
  /** The last two that are not to turn the camera. */
  private clicks: readonly Click[] = [];
  private profileSequence = 0;
  /** A walk's question for ground, and who waits for the answer. */
  private ground: {
    sequence: number;
    answered: (answer: ViewerProfiled | undefined) => void;
  } | null = null;
  private readonly unwatch: readonly (() => void)[];

  constructor(
    private readonly socket: Pick<Socket, "pick" | "profile">,
    private readonly state: State,
    /** Turns the camera to a point. */
    private readonly turn: (to: Vec3) => void,
  ) {
    this.unwatch = [
      // Where heights are drawn otherwise, measured points lie elsewhere.
      state.shown.watch((shown) => {
        const [first] = state.measured.value;
        if (first !== undefined && first.exaggeration !== shown?.exaggeration)
          state.measured.set([]);
      }),
      state.measuring.watch(() => (this.waiting = [])),
      state.pick.watch((pick) => {
        if (pick !== null) return;
        this.asked = null;
        this.waiting = [];
      }),
    ];
  }

  close(): void {
    for (const end of this.unwatch) end();
  }

  private get hidden(): readonly number[] {
    return this.state.look.value.hidden;
  }

  /** Asks what is at a point of the canvas; false where it cannot be asked now. */
  pick(at: Point, canvas: Size, turns: boolean): boolean {
    if (turns) this.takeBack(at);
    const shown = this.state.shown.value;
    if (shown === null) return false;
    const place = seenPlace(shown, placeOf(at, canvas, shown));
    if (place === undefined) {
      this.state.pick.set({ kind: "nothing" });
      return false;
    }
    const click: Click = { at, shown, place, turns, measures: !turns };
    if (!turns) this.clicks = [...this.clicks.slice(-1), click];
    if (this.asked === null || !this.state.measuring.value) return this.ask(click);
    this.waiting.push(click);
    return true;
  }

  private ask(click: Click): boolean {
    const sequence = this.pickSequence + 1;
    if (!this.socket.pick(sequence, click.shown, click.place)) {
      this.waiting = [];
      this.state.pick.set(cannotAsk);
      return false;
    }
    this.pickSequence = sequence;
    this.asked = click;
    this.state.pick.set({ kind: "asking" });
    return true;
  }

  /** A double click there measures nothing: its two clicks were none of their own. */
  private takeBack(at: Point): void {
    const isNear = (click: Click) =>
      Math.hypot(click.at.x - at.x, click.at.y - at.y) <= doubleClickSlack;
    const own = this.clicks.filter(isNear);
    for (const click of own) click.measures = false;
    this.waiting = this.waiting.filter((click) => !own.includes(click));
    const { measured } = this.state;
    const kept = measured.value.filter((point) => !own.some((click) => click.measured === point));
    if (kept.length < measured.value.length) measured.set(kept);
  }

  picked(answer: ViewerPicked): void {
    const { state, asked } = this;
    if (Number(answer.sequence) !== this.pickSequence || asked === null) return;
    this.asked = null;
    const names = state.session.value?.objectNames ?? [];
    const pick = pickOf(answer, names, asked.shown.exaggeration);
    state.pick.set(pick);
    if (pick.kind === "point" && asked.turns) this.turn(pick.position);
    else if (pick.kind === "point" && asked.measures) this.measure(asked, pick);
    const next = this.waiting.shift();
    if (next !== undefined) this.ask(next);
  }

  private measure(click: Click, point: PickedPoint): void {
    const { measuring, measured, shown } = this.state;
    if (!measuring.value || point.exaggeration !== shown.value?.exaggeration) return;
    click.measured = point;
    measured.set([...measured.value, point]);
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
    if (!this.socket.profile(sequence, from, to, profileSamples, this.hidden))
      return this.state.profile.set(cannotAsk);
    this.profileSequence = sequence;
    this.state.profile.set({ kind: "asking", from, to });
  }

  profiled(answer: ViewerProfiled): void {
    if (Number(answer.sequence) === this.ground?.sequence) return this.groundAnswered(answer);
    const asked = this.state.profile.value;
    if (Number(answer.sequence) !== this.profileSequence || asked?.kind !== "asking") return;
    this.state.profile.set(profileOf(answer, asked.from, asked.to));
  }

  /** The server can be asked again. */
  opened(): void {
    if (this.state.pick.value === cannotAsk) this.state.pick.set(null);
    if (this.state.profile.value === cannotAsk) this.state.profile.set(null);
  }

  /** No answers come any more. */
  lost(): void {
    this.groundAnswered(undefined);
    this.asked = null;
    this.waiting = [];
    if (this.state.pick.value?.kind === "asking") this.state.pick.set(null);
    if (this.state.profile.value?.kind === "asking") this.state.profile.set(null);
  }
}
