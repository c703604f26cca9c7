// SPDX-License-Identifier: Apache-2.0
// Views of a whole scene from where maps and drawings show things.
import type { Camera, Vec3 } from "./camera";
import { add, axesOf, directionOf, dot, headingOfView, scale, subtract, worldUp } from "./camera";

export interface Bounds {
  min: Vec3;
  max: Vec3;
}

/** Degrees: azimuth of the eye as seen from the scene, anticlockwise from east; and above it. */
export interface Direction {
  azimuth: number;
  elevation: number;
}

export interface StandardView extends Direction {
  name: string;
}

/** By the keys 1 to 7. Seen from the north, one looks south. */
export const standardViews: readonly StandardView[] = [
  { name: "Top", azimuth: -90, elevation: 90 },
  { name: "From south", azimuth: -90, elevation: 0 },
  { name: "From east", azimuth: 0, elevation: 0 },
  { name: "From north", azimuth: 90, elevation: 0 },
  { name: "From west", azimuth: 180, elevation: 0 },
  { name: "Oblique", azimuth: -90, elevation: 35 },
  { name: "Isometric", azimuth: -45, elevation: 35.26438968275466 },
];

/** From where a camera sees what it looks at. */
export function directionOfView(camera: Camera): Direction {
  const { azimuth, elevation } = headingOfView(camera);
  return { azimuth: (azimuth * 180) / Math.PI + 180, elevation: (-elevation * 180) / Math.PI };
}

/** A little of the picture is left around the scene. */
const slack = 1.04;

/** The nearest eye in that direction from where all of `bounds` is in a picture of that shape. */
export function standardCamera(
  { azimuth, elevation }: Direction,
  { min, max }: Bounds,
  aspect: number,
  fovyDegrees: number,
): Camera {
  const radians = Math.PI / 180;
  const away = directionOf({ azimuth: azimuth * radians, elevation: elevation * radians });
  const target = scale(add(min, max), 0.5);
  const probe: Camera = { eye: add(target, away), target, up: worldUp, fovyDegrees };
  const { right, up, forward } = axesOf(probe);
  const tangent = Math.tan((fovyDegrees * radians) / 2);
  let distance = 1e-9;
  for (const x of [min[0], max[0]])
    for (const y of [min[1], max[1]])
      for (const z of [min[2], max[2]]) {
        const corner = subtract([x, y, z], target);
        const across = Math.max(
          Math.abs(dot(corner, right)) / (tangent * Math.max(aspect, 0.1)),
          Math.abs(dot(corner, up)) / tangent,
        );
        distance = Math.max(distance, slack * across - dot(corner, forward));
      }
  return { ...probe, eye: add(target, scale(away, distance)) };
}

/** Of the pictures that the server's home camera frames the scene in, and of all wider ones. */
const homeAspect = 4 / 3;

/** All of the scene, as the server shows it first, in a picture of any shape. */
export function homeIn(home: Camera, bounds: Bounds, aspect: number): Camera {
  if (aspect >= homeAspect) return home;
  return standardCamera(directionOfView(home), bounds, aspect, home.fovyDegrees);
}
