// SPDX-License-Identifier: Apache-2.0
// Where the scene and its objects reach as they are drawn: with the heights of terrain exaggerated,
// unlike what the server says of them.
import type { Camera } from "./camera/camera";
import type { Bounds } from "./camera/standard";
import { directionOfView, homeIn, standardCamera } from "./camera/standard";
import type { ObjectState, SessionState } from "./protocol/messages";
import { boundsOf, cameraOf } from "./protocol/messages";

type Scene = Pick<SessionState, "home" | "sceneBounds" | "objects">;

/** Each face moves as far as the heights' own does, whatever moves, turns or scales the terrain. */
export function objectBounds(
  object: ObjectState | undefined,
  exaggeration: number,
): Bounds | undefined {
  const [bounds, heights] = [boundsOf(object?.bounds), boundsOf(object?.heights)];
  if (bounds === undefined || heights === undefined) return bounds;
  const drawn = (i: 0 | 1 | 2) => [exaggeration * heights.min[i], exaggeration * heights.max[i]];
  const least = (i: 0 | 1 | 2) => bounds.min[i] + Math.min(...drawn(i)) - heights.min[i];
  const most = (i: 0 | 1 | 2) => bounds.max[i] + Math.max(...drawn(i)) - heights.max[i];
  return { min: [least(0), least(1), least(2)], max: [most(0), most(1), most(2)] };
}

/** Of all objects, hidden ones as well; what the server says where it says nothing of objects. */
export function wholeBounds(scene: Scene, exaggeration: number): Bounds | undefined {
  const all = scene.objects.flatMap((object) => objectBounds(object, exaggeration) ?? []);
  if (exaggeration === 1 || all.length === 0) return boundsOf(scene.sceneBounds);
  const each = (of: (...values: number[]) => number, end: "min" | "max") =>
    ([0, 1, 2] as const).map((i) => of(...all.map((bounds) => bounds[end][i])));
  const [x = 0, y = 0, z = 0] = each(Math.min, "min");
  const [right = 0, back = 0, top = 0] = each(Math.max, "max");
  return { min: [x, y, z], max: [right, back, top] };
}

/** The lowest and the highest ground, in metres; of all that there is in a scene without terrain. */
export function groundHeights({ objects, sceneBounds }: Scene): [number, number] | undefined {
  const terrains = objects.flatMap(({ heights }) => boundsOf(heights) ?? []);
  const whole = boundsOf(sceneBounds);
  const all = terrains.length > 0 || whole === undefined ? terrains : [whole];
  if (all.length === 0) return undefined;
  return [Math.min(...all.map(({ min }) => min[2])), Math.max(...all.map(({ max }) => max[2]))];
}

/** All of the scene in a picture of any shape, from where the server shows it first. */
export function homeOf(scene: Scene, exaggeration: number, aspect: number): Camera | undefined {
  const [home, bounds] = [cameraOf(scene.home), wholeBounds(scene, exaggeration)];
  if (home === undefined || bounds === undefined) return undefined;
  const isAsServed =
    exaggeration === 1 || !scene.objects.some(({ heights }) => heights !== undefined);
  if (isAsServed) return homeIn(home, bounds, aspect);
  return standardCamera(directionOfView(home), bounds, aspect, home.fovyDegrees);
}
