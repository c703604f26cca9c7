// SPDX-License-Identifier: Apache-2.0
// Whether the scene that the server tells of is the one that was shown.
import type { SessionState } from "./protocol/messages";

export interface SceneChange {
  /** It reaches elsewhere: one looks for it anew. */
  isElsewhere: boolean;
  /** Positions in it are of other objects. */
  hasOtherObjects: boolean;
}

export class ShownScene {
  private bounds: string | undefined;
  private names: string | undefined;

  /** Nothing is another than nothing; what was shown before a reconnection counts. */
  next({
    sceneBounds,
    objectNames,
  }: Pick<SessionState, "sceneBounds" | "objectNames">): SceneChange {
    const { min, max } = sceneBounds ?? {};
    if (min === undefined || max === undefined)
      return { isElsewhere: false, hasOtherObjects: false };
    const bounds = [min.x, min.y, min.z, max.x, max.y, max.z].join();
    const names = JSON.stringify(objectNames);
    const isElsewhere = this.bounds !== undefined && this.bounds !== bounds;
    const hasOtherObjects = isElsewhere || (this.names !== undefined && this.names !== names);
    this.bounds = bounds;
    this.names = names;
    return { isElsewhere, hasOtherObjects };
  }
}
