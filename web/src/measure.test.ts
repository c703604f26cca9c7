// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import type { Vec3 } from "./camera/camera";
import { project } from "./camera/camera";
import { standardCamera, standardViews } from "./camera/standard";
import type { MeasuredPoint } from "./measure";
import { mapArea, mapLength, pathLength, rise } from "./measure";
import { axis, bandOf, logAxis } from "./panel/chart";
import { areaWithError, lengthWithError } from "./panel/format";
import { captionOf, overlayRuns, rowsOf } from "./panel/measure";
import { bandwidthDrawing, errorDrawing, speedErrorDrawing, stagesDrawing } from "./panel/plots";
import { chartOf, heightAlong } from "./profile";
import { bandwidth, FrameHistory } from "./view/history";

const point = (x: number, y: number, z: number, error = 0): MeasuredPoint => ({
  position: [x, y, z],
  error,
});

/** Numbers from 0 to 1, the same in each run. */
function randomNumbers(seed: number): () => number {
  let state = seed;
  return () => (state = (Math.imul(state, 1664525) + 1013904223) >>> 0) / 2 ** 32;
}

describe("measures", () => {
  const square = [point(500_000, 0, 0), point(500_003, 0, 4), point(500_003, 3, 4)];

  it("are those of known figures", () => {
    expect(pathLength(square).value).toBe(8);
    expect(mapLength(square).value).toBe(6);
    expect(rise(square).value).toBe(4);
    expect(mapArea(square).value).toBe(4.5);
    expect(mapArea([]).value).toBe(0);
    expect(rise([]).value).toBe(0);
  });

  it("are never farther off than they say, wherever the true points are", () => {
    const random = randomNumbers(1);
    let tightest = 0;
    for (let trial = 0; trial < 500; ++trial) {
      const points = Array.from({ length: 3 + Math.floor(5 * random()) }, () =>
        point(100 * random(), 100 * random(), 20 * random(), 3 * random()),
      );
      const moved = points.map(({ position, error }) => {
        const [azimuth, z] = [2 * Math.PI * random(), 2 * random() - 1];
        const flat = error * Math.sqrt(1 - z * z);
        return point(
          position[0] + flat * Math.cos(azimuth),
          position[1] + flat * Math.sin(azimuth),
          position[2] + error * z,
        );
      });
      for (const measure of [pathLength, mapLength, rise]) {
        const off = Math.abs(measure(moved).value - measure(points).value);
        expect(off).toBeLessThanOrEqual(measure(points).error + 1e-9);
      }
      const { value, error } = mapArea(points);
      const off = Math.abs(mapArea(moved).value - value);
      expect(off).toBeLessThanOrEqual(error + 1e-9);
      tightest = Math.max(tightest, off / error);
    }
    expect(tightest).toBeGreaterThan(0.3); // nor is the bound idle
  });
});

describe("standard views", () => {
  it("have all of the scene in the picture, and not much else", () => {
    const bounds = { min: [10, 20, 0] as Vec3, max: [110, 60, 15] as Vec3 };
    for (const view of standardViews)
      for (const aspect of [0.5, 1, 16 / 9]) {
        const camera = standardCamera(view, bounds, aspect, 45);
        let widest = 0;
        for (let corner = 0; corner < 8; ++corner) {
          const at = project(
            camera,
            [0, 1, 2].map(
              (i) => (corner & (1 << i) ? bounds.max : bounds.min)[i],
            ) as unknown as Vec3,
            aspect,
          );
          expect(at).toBeDefined();
          for (const share of at ?? []) widest = Math.max(widest, Math.abs(share - 0.5));
        }
        expect(widest).toBeLessThanOrEqual(0.5);
        expect(widest).toBeGreaterThan(0.45);
      }
  });

  it("look down from the top with north up, and south from the north", () => {
    const bounds = { min: [0, 0, 0] as Vec3, max: [100, 100, 10] as Vec3 };
    const [top, , , north] = standardViews.map((view) => standardCamera(view, bounds, 1, 45));
    const atNorth = project(top!, [50, 100, 0], 1);
    expect(atNorth?.[1]).toBeLessThan(0.1);
    expect(north!.eye[1]).toBeGreaterThan(100);
  });
});

describe("a profile", () => {
  const samples = [0, 1, 2, 3].map((i) =>
    i === 2 ? undefined : { position: [3 * i, 4 * i, 10 * i] as Vec3, error: 0.5 },
  );

  it("counts its way on the map, and leaves gaps where nothing is", () => {
    const chart = chartOf({ from: [0, 0, 0], to: [9, 12, 0], samples });
    expect(chart.length).toBe(15);
    expect([chart.lowest, chart.highest]).toEqual([0, 30]);
    expect(chart.error).toBe(0.5);
    expect(chart.runs.map((run) => run.map(([way]) => way))).toEqual([[0, 5], [15]]);
  });

  it("says how near its points are to the source, not how far off heights", () => {
    const chart = chartOf({ from: [0, 0, 0], to: [9, 12, 0], samples });
    expect(captionOf(chart)).toBe(
      "0.00 m to 30.00 m; each point within 505 mm of the source, in whatever direction",
    );
  });

  it("tells the height of the nearest sample", () => {
    const profile = { from: [0, 0, 0] as Vec3, to: [9, 12, 0] as Vec3, samples };
    expect(heightAlong(profile, 0.3)).toBe(10);
    expect(heightAlong(profile, 0.6)).toBeUndefined();
  });
});

describe("the card of measures", () => {
  const points = [point(0, 0, 10, 0.5), point(30, 40, 10, 0.25), point(30, 0, 10, 0.25)];

  it("says how far off each number may be", () => {
    const texts = rowsOf(points, 1).map(([name, value]) => `${name}: ${value}`);
    expect(texts).toEqual([
      "Length: 90.0 m ± 1.25 m",
      "On the map: 90.0 m ± 1.25 m",
      "Rise: 0 mm ± 750 mm",
      "Area: 600 m² ± 20.2 m²",
    ]);
    expect(rowsOf(points.slice(0, 1), 1)).toEqual([]);
    expect(rowsOf(points, 2)[0]?.[2]).toContain("as drawn with heights × 2");
  });

  it("says that of what is written", () => {
    const units: Record<string, number> = { km: 1e3, m: 1, mm: 1e-3, µm: 1e-6, nm: 1e-9 };
    const metresOf = (text: string): number => {
      const [digits = "", unit = ""] = text.split(" ");
      const size = unit.endsWith("²") ? (units[unit.slice(0, -1)] ?? NaN) ** 2 : units[unit];
      return Number(digits.replace("−", "-")) * (size ?? NaN);
    };
    const random = randomNumbers(2);
    for (let trial = 0; trial < 2000; ++trial) {
      const value = 10 ** (14 * random() - 6) * (random() < 0.2 ? -1 : 1);
      const error = Math.abs(value) * 10 ** (-7 * random());
      const texts = [lengthWithError(value, error), areaWithError(Math.abs(value), error)];
      texts.forEach((text, i) => {
        const [written = NaN, off = NaN] = text.split(" ± ").map(metresOf);
        const lost = Math.abs(written - (i === 0 ? value : Math.abs(value)));
        expect(off * (1 + 1e-9)).toBeGreaterThanOrEqual(error + lost);
        expect(off).toBeLessThan(1.08 * error + 1e-8); // nor much more
      });
    }
    expect(lengthWithError(0.0478125, 2.06e-7)).toBe("47.81250 mm ± 206 nm");
    expect(lengthWithError(-1677.2, 1.75)).toBe("−1.6772 km ± 1.75 m");
    expect(lengthWithError(0, 0)).toBe("0.000000 m ± 0 nm");
    expect(areaWithError(0.0002612, 1.996e-9)).toBe("261.2000 mm² ± 2000 µm²");
  });

  it("marks points in the picture, and parts the line behind the eye", () => {
    const camera = { eye: [0, -10, 0], target: [0, 0, 0], up: [0, 0, 1], fovyDegrees: 45 } as const;
    const shown = {
      camera,
      width: 100,
      height: 100,
      exaggeration: 1,
      hidden: [],
      seen: null,
      isPacked: false,
    };
    const runs = overlayRuns([point(0, 0, 0), point(0, -20, 0), point(1, 0, 0)], shown);
    expect(runs.length).toBe(2);
    expect(runs[0]?.[0]?.[0]).toBeCloseTo(50);
    expect(overlayRuns(points, null)).toEqual([]);
  });
});

describe("charts", () => {
  it("have axes that may run either way", () => {
    expect(axis(10, 0, 64)(10)).toBeCloseTo(0);
    expect(axis(10, 0, 64)(0)).toBe(64);
    expect(axis(3, 3, 64)(3)).toBe(32);
    expect(logAxis(1, 100, 64)(10)).toBeCloseTo(32);
    expect(logAxis(1, 100, 64)(0)).toBe(0);
    expect(logAxis(1, 100, 64)(Infinity)).toBe(64);
  });

  it("close the area between two lines", () => {
    expect(
      bandOf(
        [
          [0, 1],
          [2, 3],
        ],
        [
          [0, 5],
          [2, 6],
        ],
      ),
    ).toBe("M0.0,1.0L2.0,3.0L2.0,6.0L0.0,5.0Z");
  });
});

const entry = (total: number, tauAchieved: number) => ({
  time: 0,
  cull: 1,
  draw: 2,
  readback: 3,
  total,
  tauAsked: 1,
  tauAchieved,
  bytes: 0,
  linkBytesPerSecond: 0,
});
const heights = (part: ReturnType<typeof errorDrawing>["parts"][number] | undefined): number[] =>
  [...String(part?.attributes.d).matchAll(/,([\d.]+)/g)].map(([, y]) => Number(y));

describe("plots", () => {
  it("show larger errors higher up", () => {
    const { parts, text } = errorDrawing([entry(10, 0.1), entry(10, 1), entry(10, 8)]);
    const [fine, same, coarse] = heights(parts[1]);
    expect(fine).toBeGreaterThan(same ?? 0);
    expect(same).toBeGreaterThan(coarse ?? 64);
    expect(text).toBe("8.00 px of 1.00 px asked");
  });

  it("show errors without a bound at the top", () => {
    const entries = [entry(10, 0.1), entry(10, Infinity)];
    expect(heights(errorDrawing(entries).parts[1])[1]).toBe(0);
    expect(speedErrorDrawing(entries).parts[1]?.attributes.cy).toBe("3.0");
    expect(errorDrawing(entries).text).toBe("∞ px of 1.00 px asked");
  });

  it("pile stages up to the whole", () => {
    const { parts, text } = stagesDrawing([entry(10, 1), entry(10, 1)]);
    expect(heights(parts[3]).slice(0, 2)).toEqual([0, 0]);
    expect(heights(parts[0]).slice(2)).toEqual([64, 64]);
    expect(text).toBe("10 ms: cut 1, drawing 2, readback 3");
  });
});

describe("bandwidth", () => {
  it("counts what came in each span", () => {
    const entries = [
      { time: 0, bytes: 99 },
      { time: 1400, bytes: 1000 },
      { time: 1600, bytes: 500 },
      { time: 2000, bytes: 250 },
    ];
    expect(bandwidth(entries, 2000, 500, 2)).toEqual([16_000, 12_000]);
  });

  it("of the link is told in plain numbers", () => {
    const told = (linkBytesPerSecond: number): string => {
      const history = new FrameHistory();
      history.add({ ...entry(10, 1), linkBytesPerSecond });
      return bandwidthDrawing(history, 0).text;
    };
    expect(told(18.8e6)).toBe("0.0 Mbit/s, the link carries 150 or more");
    expect(told(0.43e6)).toBe("0.0 Mbit/s, the link carries 3.4 or more");
  });

  it("is plotted for half a minute, however many frames came", () => {
    const history = new FrameHistory();
    const end = 100_000;
    for (let i = 900; i-- > 0; )
      history.add({ ...entry(10, 1), time: end - (i * 30_000) / 900, bytes: 1000 });
    const plotted = heights(bandwidthDrawing(history, end).parts[0]);
    expect(plotted).toHaveLength(60);
    expect(Math.max(...plotted)).toBeLessThan(64);
    expect(history.arrivals).toHaveLength(900);
    history.add({ ...entry(10, 1), time: end + 15_000 });
    expect(history.arrivals).toHaveLength(451);
  });
});
