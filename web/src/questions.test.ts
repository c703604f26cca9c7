// SPDX-License-Identifier: Apache-2.0
import { create } from "@bufbuild/protobuf";
import { describe, expect, it } from "vitest";
import type { Camera, Vec3 } from "./camera/camera";
import { ViewerPickedSchema, ViewerProfiledSchema } from "./protocol/gen/eyrie/v1/viewer_pb";
import { Questions } from "./questions";
import { State } from "./state";

const camera: Camera = { eye: [0, -10, 5], target: [0, 0, 0], up: [0, 0, 1], fovyDegrees: 45 };

/** Measuring, with a server that picks when it is told to. */
function measuring() {
  const state = new State();
  state.measuring.set(true);
  let asked = 0;
  const ask = (sequence: number): boolean => (asked = sequence) > 0;
  const socket = { pick: ask, profile: ask };
  const turnedTo: Vec3[] = [];
  const questions = new Questions(socket, state, (to) => turnedTo.push(to));
  const show = (exaggeration: number): void => {
    const picture = { camera, width: 64, height: 36, hidden: [], seen: null, isPacked: false };
    state.shown.set({ ...picture, exaggeration });
  };
  const click = (x = 32, turns = false) =>
    questions.pick({ x, y: 18 }, { width: 64, height: 36 }, turns);
  /** By what was asked last; it tells the answers apart. */
  const answer = (): void => {
    const point = { object: 0, position: { x: asked, y: 2, z: 3 }, error: 0.02 };
    questions.picked(create(ViewerPickedSchema, { sequence: BigInt(asked), point }));
  };
  const answerProfile = () =>
    questions.profiled(create(ViewerProfiledSchema, { sequence: BigInt(asked) }));
  const points = () => state.measured.value.map(({ position: [x] }) => x);
  return { state, questions, show, click, answer, answerProfile, points, turnedTo };
}

describe("Questions", () => {
  it("measure points of one exaggeration only", () => {
    const { state, show, click, answer } = measuring();
    for (const exaggeration of [1, 1, 2]) {
      show(exaggeration);
      click();
      answer();
    }
    expect(state.measured.value.map(({ exaggeration }) => exaggeration)).toEqual([2]);
    show(1);
    expect(state.measured.value).toEqual([]);
  });

  it("know by which heights was picked, however they are drawn when the answer comes", () => {
    const { state, show, click, answer } = measuring();
    show(1);
    click();
    show(2);
    answer();
    expect(state.pick.value).toMatchObject({ kind: "point", exaggeration: 1 });
    expect(state.measured.value).toEqual([]);
  });

  it("measure each click, however late the answers", () => {
    const { state, show, click, answer, points } = measuring();
    show(1);
    for (const x of [10, 30, 50]) click(x);
    for (const count of [1, 2, 3]) {
      expect(state.pick.value).toEqual({ kind: "asking" });
      answer();
      expect(points()).toHaveLength(count);
    }
    expect(points()).toEqual([1, 2, 3]);
    answer();
    expect(points()).toEqual([1, 2, 3]);
  });

  it("that wait are not asked once what was found is closed, or measuring ends", () => {
    for (const end of [
      ({ pick }: State) => pick.set(null),
      ({ measuring, measured }: State) => {
        measuring.set(false);
        measured.set([]);
      },
    ]) {
      const { state, show, click, answer, points } = measuring();
      show(1);
      click(10);
      click(30);
      end(state);
      answer();
      expect(state.pick.value?.kind).not.toBe("asking");
      expect(points()).toEqual([]);
    }
  });

  it("that are lost with the connection are not waited for", () => {
    const { questions, show, click, answer, points } = measuring();
    show(1);
    click(10);
    click(30);
    questions.lost();
    click(50);
    answer();
    expect(points()).toEqual([2]);
  });

  it("that cannot be asked are said not to be, until they can", () => {
    const state = new State();
    const socket = { pick: () => false, profile: () => false };
    const questions = new Questions(socket, state, () => {});
    questions.profile([0, 0, 0], [1, 0, 0]);
    const picture = { camera, width: 64, height: 36, hidden: [], seen: null, isPacked: false };
    state.shown.set({ ...picture, exaggeration: 1 });
    questions.pick({ x: 32, y: 18 }, { width: 64, height: 36 }, false);
    const text = "The server cannot be asked now";
    for (const { value } of [state.profile, state.pick])
      expect(value).toEqual({ kind: "problem", text });
    questions.opened();
    for (const { value } of [state.profile, state.pick]) expect(value).toBeNull();
  });

  it("that were answered stay so when the connection opens again", () => {
    const { state, questions, show, click, answer } = measuring();
    show(1);
    click();
    answer();
    questions.opened();
    expect(state.pick.value?.kind).toBe("point");
  });

  it("of a double click measure nothing, whenever they are answered", () => {
    for (const answersBetween of [0, 1, 2]) {
      const { show, click, answer, points, turnedTo } = measuring();
      show(1);
      click(10);
      click(30);
      click(31);
      for (let i = 0; i < answersBetween + 1; ++i) answer();
      click(31, true);
      for (let i = 0; i < 4; ++i) answer();
      expect(points()).toEqual([1]);
      expect(turnedTo).toHaveLength(1);
    }
  });

  it("of a walk are answered once each, earlier ones by nothing", () => {
    const { questions, answerProfile } = measuring();
    const answers: string[] = [];
    for (const name of ["first", "second"])
      questions.askGround([0, 0, 0], [1, 0, 0], 2, (found) =>
        answers.push(`${name}: ${found === undefined ? "nothing" : "ground"}`),
      );
    expect(answers).toEqual(["first: nothing"]);
    answerProfile();
    expect(answers).toEqual(["first: nothing", "second: ground"]);
  });
});
