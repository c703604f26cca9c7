// SPDX-License-Identifier: Apache-2.0
import { create } from "@bufbuild/protobuf";
import { describe, expect, it } from "vitest";
import type { Camera } from "./camera/camera";
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
  const questions = new Questions(socket, state, () => {});
  const show = (exaggeration: number): void => {
    const picture = { camera, width: 64, height: 36, hidden: [], seen: null, isPacked: false };
    state.shown.set({ ...picture, exaggeration });
  };
  const click = () => questions.pick({ x: 32, y: 18 }, { width: 64, height: 36 }, false);
  const answer = (): void => {
    const point = { object: 0, position: { x: 1, y: 2, z: 3 }, error: 0.02 };
    questions.picked(create(ViewerPickedSchema, { sequence: BigInt(asked), point }));
  };
  const answerProfile = () =>
    questions.profiled(create(ViewerProfiledSchema, { sequence: BigInt(asked) }));
  return { state, questions, show, click, answer, answerProfile };
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
