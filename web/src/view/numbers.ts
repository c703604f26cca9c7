// SPDX-License-Identifier: Apache-2.0
// What a frame's message says of it, as the page shows it.
import type { Frame } from "../protocol/messages";
import type { Numbers } from "../state";
import { limitingStage } from "./measure";

/** What the page knows of a frame beside its message. */
export type Seen = Pick<Numbers, "exact" | "fps" | "waits" | "inputToDrawnMilliseconds" | "frozen">;

export function numbersOf(frame: Frame, seen: Seen, limitedBefore: string): Numbers {
  const { statistics } = frame;
  const stages = statistics?.milliseconds;
  return {
    ...seen,
    frameNumber: Number(frame.frameNumber),
    viewSequence: Number(frame.viewSequence),
    width: frame.width,
    height: frame.height,
    still: frame.still,
    pixelHash: frame.pixelHash,
    quality: frame.quality,
    tiles: frame.tiles.length,
    isVideo: frame.video !== undefined,
    linkBytesPerSecond: frame.linkBytesPerSecond,
    pictureBytes: Number(frame.pictureBytes),
    tauAsked: statistics?.tauAsked ?? 0,
    budgetMilliseconds: statistics?.budget?.milliseconds ?? 0,
    predictedMilliseconds: statistics?.budget?.predictedMilliseconds ?? 0,
    budgetTau: statistics?.budget?.tauPixels ?? 0,
    tauAchieved: statistics?.tauAchieved ?? 0,
    normalMeanDegrees: statistics?.normalErrorMeanDegrees ?? 0,
    normalDegrees: statistics?.normalErrorDegrees ?? 0,
    complete: statistics?.complete ?? true,
    pagesMissing: Number(statistics?.pagesMissing ?? 0n),
    pagesFailed: Number(statistics?.pagesFailed ?? 0n),
    triangles: Number(statistics?.triangles ?? 0n),
    renderMilliseconds: stages?.total ?? 0,
    cullMilliseconds: stages?.cull ?? 0,
    drawMilliseconds: stages?.draw ?? 0,
    readbackMilliseconds: stages?.readback ?? 0,
    parts: statistics?.parts ?? [],
    limitedBy: limitingStage(stages) || limitedBefore,
  };
}
