#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Holds pictures of random scenes against their sources, and pictures of several renderers against
those of one.

    bench/random_scenes.py build/release/bin/eyrie COUNT SEED FILE.eyt|FILE.eym...

Each scene has one to four of the files, moved, turned, scaled, sheared or mirrored, near the origin
or up to 6,400 km from it. It is played along `orbit`, `walkthrough`, `worst` or from random places
through lenses of 1 to 170 degrees, at a random tau, by `eyrie bench --reference`; then one picture
is drawn in one process and by two to four, in a random way of sharing, objects with random looks.
The files' sources must be where they were imported from. Prints what is beyond what is promised, or
differs; exit status 1 where anything is.
"""
import json
import math
import random
import subprocess
import sys
import tempfile
from pathlib import Path


def rotation(rng):
    """Rows of a random one, of a unit quaternion."""
    w, x, y, z = (rng.gauss(0, 1) for _ in range(4))
    n = 2 / (w * w + x * x + y * y + z * z)
    return [[1 - n * (y * y + z * z), n * (x * y - w * z), n * (x * z + w * y)],
            [n * (x * y + w * z), 1 - n * (x * x + z * z), n * (y * z - w * x)],
            [n * (x * z - w * y), n * (y * z + w * x), 1 - n * (x * x + y * y)]]


def times(a, b):
    return [[sum(a[i][k] * b[k][j] for k in range(3)) for j in range(3)] for i in range(3)]


def placed(rng, file, bounds, origin):
    """The file about a metre wide, somewhere around `origin`; and that place."""
    low, high = bounds
    extent = max(h - l for l, h in zip(low, high)) or 1
    turn = rotation(rng) if rng.random() < 0.6 else [[1, 0, 0], [0, 1, 0], [0, 0, 1]]
    scale = 10 ** rng.uniform(-0.5, 0.5) / extent * rng.choice([1, 1, 1, 5, 0.2])
    sides = [scale * (rng.uniform(0.3, 3) if rng.random() < 0.4 else 1) *
             (-1 if rng.random() < 0.1 else 1) for _ in range(3)]
    shear = rng.uniform(-1, 1) if rng.random() < 0.25 else 0
    linear = times(turn, [[sides[0], 0, sides[0] * shear], [0, sides[1], 0], [0, 0, sides[2]]])
    centre = [(l + h) / 2 for l, h in zip(low, high)]
    place = [o + rng.uniform(-0.8, 0.8) for o in origin]
    matrix = []
    for row, at in zip(linear, place):
        matrix += row + [at - sum(a * c for a, c in zip(row, centre))]
    made = {"terrain" if file.endswith(".eyt") else "mesh": file,
            "transform": {"matrix": matrix + [0, 0, 0, 1]}}
    if "mesh" in made and rng.random() < 0.2:
        made["singleSided"] = True
    return made, place


def anywhere(rng, place):
    out = [rng.gauss(0, 1) for _ in range(3)]
    far = 10 ** rng.uniform(-1.5, 1.2) / math.hypot(*out)
    return {"eye": [p + far * o for p, o in zip(place, out)],
            "target": [p + rng.uniform(-0.5, 0.5) for p in place],
            "up": rng.choice([[0, 0, 1], [0, 1, 0], [0.3, 0.2, 0.9]]),
            "fovyDegrees": rng.choice([1, 5, 20, 45, 60, 90, 120, 150, 170])}


def run(*command):
    return subprocess.run(command, capture_output=True, text=True, timeout=1800, check=False)


def judge(rng, eyrie, folder, scene, places):
    """What is wrong, if anything; None where nothing is seen."""
    flight = rng.choice(["orbit", "walkthrough", "worst", str(folder / "flight.json")])
    keys = [{"seconds": i, "camera": anywhere(rng, rng.choice(places))} for i in range(8)]
    (folder / "flight.json").write_text(json.dumps({"keys": keys}))
    ended = run(eyrie, "bench", scene, "--flight", flight, "--tau",
                rng.choice(["0.5", "1", "2", "4", "8"]), "--size",
                rng.choice(["160x90", "97x131", "320x180"]), "--frames", "8", "--repeats", "1",
                "--reference", "--reference-frames", "8", "-o", str(folder / "report"), "--quiet")
    if "nothing was measured" in ended.stderr or "no frame of the flight" in ended.stderr:
        return None
    return ended.stderr.strip()[-300:] if ended.returncode else ""


def object_looks(rng, objects):
    """Of some of them: shadings and colours of their own."""
    looks = []
    for i in range(objects):
        look = {"object": i}
        if rng.random() < 0.4:
            kinds = ["SMOOTH", "FLAT", "GOURAUD", "WIREFRAME"]
            look["shading"] = f"SHADING_{rng.choice(kinds)}"
        if rng.random() < 0.4:
            look["colour"] = [rng.random() for _ in range(3)]
        looks.append(look)
    return looks


def differences(rng, eyrie, folder, scene, places):
    (folder / "camera.json").write_text(json.dumps(anywhere(rng, rng.choice(places))))
    (folder / "look.json").write_text(json.dumps({"objects": object_looks(rng, len(places))}))
    command = [eyrie, "render", scene, "--camera", str(folder / "camera.json"), "--size", "320x200",
               "--look", str(folder / "look.json"),
               "--tau", rng.choice(["0.5", "1", "4"]), "--shading",
               rng.choice(["smooth", "flat", "gouraud", "wireframe"]), "--quiet"]
    way = rng.choice(["2D", "DB", "DB-static", "direct-send", "DB-2D"])
    for name, more in (("a", []), ("b", ["--renderers", rng.choice("234"), "--compound", way])):
        ended = run(*command, "-o", str(folder / f"{name}.png"), "--depth",
                    str(folder / f"{name}.pfm"), *more)
        if ended.returncode:
            return ended.stderr.strip()[-300:]
    same = all((folder / f"a.{kind}").read_bytes() == (folder / f"b.{kind}").read_bytes()
               for kind in ("png", "pfm"))
    return "" if same else f"{way} differs from one renderer's picture"


def main():
    eyrie, files = sys.argv[1], sys.argv[4:]
    try:
        count, seed = int(sys.argv[2]), int(sys.argv[3])
    except ValueError:
        raise SystemExit(__doc__) from None
    bounds = {}
    for file in files:
        told = json.loads(run(eyrie, "info", file, "--json").stdout)["bounds"]
        bounds[str(Path(file).resolve())] = (told["min"], told["max"])
    judged = wrong = 0
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for i in range(count):
            rng = random.Random(f"{seed} {i}")
            far = rng.choice([0, 0, 1e3, 5e5, 6.4e6])
            origin = [far * rng.uniform(-1, 1) for _ in range(3)]
            chosen = rng.choices(sorted(bounds), k=rng.choice([1, 1, 2, 3, 4]))
            made = [placed(rng, file, bounds[file], origin) for file in chosen]
            scene = json.dumps({"objects": [each for each, _ in made]})
            (folder / "scene.json").write_text(scene)
            places = [place for _, place in made]
            found = judge(rng, eyrie, folder, str(folder / "scene.json"), places)
            judged += found is not None
            differ = differences(rng, eyrie, folder, str(folder / "scene.json"), places)
            if found or differ:
                wrong += 1
                print(f"seed {seed}, scene {i}: {found} {differ}\n{scene}", flush=True)
    print(f"{judged} of {count} scenes show something and were judged; {wrong} are wrong")
    return 1 if wrong else 0


if __name__ == "__main__":
    if len(sys.argv) < 5:
        raise SystemExit(__doc__)
    sys.exit(main())
