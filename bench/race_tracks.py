#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Lays out TORCS race tracks as one scene, and flies along one of them at a driver's height.

usage: race_tracks.py FOLDER OUT [LEAF]

FOLDER holds TRACK/TRACK.acc files (torcs-data; shared/data/scenes/torcs_24tracks_geometry_acc).
Writes OUT/TRACK.eym (by `eyrie import mesh`, which has to be on PATH, with --leaf LEAF),
OUT/scene.json, in which every track stands twice on a grid, OUT/street.json and OUT/above.json,
flights for `eyrie bench`.
"""
import json
import math
import pathlib
import subprocess
import sys

SPACING = 5000.0
DRIVEN = "street-1"


def main_track(path):
    """Middles of the pieces of the track, in order; z up."""
    pieces = {}
    lines = path.read_text(errors="replace").split("\n")
    name = ""
    for i, line in enumerate(lines):
        if line.startswith("name"):
            name = line.split('"')[1]
        elif line.startswith("numvert") and name.startswith("TKMN"):
            points = [list(map(float, l.split()[:3])) for l in lines[i + 1 : i + 1 + int(line.split()[1])]]
            x, y, z = (sum(p[k] for p in points) / len(points) for k in range(3))
            pieces[int(name[4:])] = (x, -z, y)
    return [pieces[key] for key in sorted(pieces)]


def key(seconds, eye, target):
    return {"seconds": seconds, "camera": {"eye": eye, "target": target, "up": [0, 0, 1], "fovyDegrees": 60}}


def street_flight(points, at):
    placed = [[p[k] + at[k] for k in range(3)] for p in points]
    keys = []
    for i, point in enumerate(placed):
        ahead = placed[(i + 1) % len(placed)]
        raised = [point[0], point[1], point[2] + 1.7]
        length = math.dist(ahead, point) or 1
        target = [raised[k] + 50 * (ahead[k] - point[k]) / length for k in range(3)]
        keys.append(key(i * 0.5, raised, target))
    return {"keys": keys}


def main():
    folder, out = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
    leaf = sys.argv[3] if len(sys.argv) > 3 else "8192"
    out.mkdir(parents=True, exist_ok=True)
    tracks = sorted(folder.glob("*/*.acc"))
    side = math.ceil(math.sqrt(2 * len(tracks)))
    objects, driven = [], None
    for track in tracks:
        command = ["eyrie", "import", "mesh", track, "-o", out / (track.stem + ".eym")]
        subprocess.run(command + ["--leaf", leaf, "--quiet"], check=True)
    for i, track in enumerate(tracks + tracks):
        at = [SPACING * (i % side), SPACING * (i // side), 0.0]
        objects.append({"name": f"{track.stem} {i}", "mesh": track.stem + ".eym", "transform": {"translation": at}})
        if track.stem == DRIVEN and driven is None:
            driven = (track, at)
    (out / "scene.json").write_text(json.dumps({"objects": objects}, indent=1))
    points = main_track(driven[0])
    (out / "street.json").write_text(json.dumps(street_flight(points, driven[1])))
    middle = [SPACING * side / 2] * 2
    above = [
        key(i, [middle[0] + 9000 * math.cos(i), middle[1] + 9000 * math.sin(i), 3000], middle + [0.0])
        for i in range(7)
    ]
    (out / "above.json").write_text(json.dumps({"keys": above}))


main()
