// SPDX-License-Identifier: Apache-2.0
// Pictures of H.264 streams, decoded by WebCodecs. A picture is decoded only right after the one
// that it is made from, so that none is ever shown that lacks something.
import type { VideoPlace } from "../protocol/parts";

/** High profile, level 5.2: the largest that the server makes. */
const config: VideoDecoderConfig = { codec: "avc1.640034", optimizeForLatency: true };

/** False where pages are not secure (plain http from another machine), and in browsers without. */
export async function canShowVideo(): Promise<boolean> {
  if (typeof VideoDecoder === "undefined") return false;
  try {
    return (await VideoDecoder.isConfigSupported(config)).supported === true;
  } catch {
    return false;
  }
}

/** Whether a picture can be decoded after `last`. */
export function follows(last: VideoPlace | undefined, next: VideoPlace): boolean {
  if (next.isKey) return true;
  return last?.stream === next.stream && last.picture + 1n === next.picture;
}

export interface VideoEvents {
  /** To be closed by who gets it. */
  decoded(order: number, picture: VideoFrame): void;
  /** Nothing more will be decoded; `order` is of the newest that was to be. */
  failed(order: number): void;
}

/**
 * Decodes streams one after the other, until something is wrong with one. `order`, by which pictures
 * are told apart, ascends.
 */
export class VideoPictures {
  private readonly decoder: VideoDecoder;
  private last: VideoPlace | undefined;
  private newest = 0;
  private hasFailed = false;

  constructor(private readonly events: VideoEvents) {
    this.decoder = new VideoDecoder({
      output: (picture) => this.events.decoded(picture.timestamp, picture),
      error: () => this.fail(),
    });
  }

  decode(order: number, bytes: Uint8Array<ArrayBuffer>, place: VideoPlace): void {
    this.newest = order;
    if (this.hasFailed || !follows(this.last, place)) {
      this.fail();
      return;
    }
    try {
      if (this.last?.stream !== place.stream) this.decoder.configure(config);
      const type = place.isKey ? "key" : "delta";
      this.decoder.decode(new EncodedVideoChunk({ type, timestamp: order, data: bytes }));
      this.last = place;
    } catch {
      this.fail();
    }
  }

  private fail(): void {
    this.hasFailed = true;
    if (this.decoder.state !== "closed") this.decoder.close();
    this.events.failed(this.newest);
  }
}
