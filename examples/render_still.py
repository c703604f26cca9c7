#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""A picture and its depths from a running Eyrie, with nothing but Python's standard library.

    render_still.py http://127.0.0.1:8080 picture.png

A server with tokens wants one, in EYRIE_TOKEN.
"""
import base64
import json
import math
import os
import struct
import sys
import urllib.error
import urllib.request


def call(server, method, path, body=None):
    """The answer's JSON; an exception that says what is wrong otherwise."""
    headers = {"Accept": "application/json", "Content-Type": "application/json"}
    if "EYRIE_TOKEN" in os.environ:
        headers["Authorization"] = "Bearer " + os.environ["EYRIE_TOKEN"]
    request = urllib.request.Request(
        f"{server}/api/v1{path}",
        method=method,
        data=None if body is None else json.dumps(body).encode(),
        headers=headers,
    )
    try:
        with urllib.request.urlopen(request, timeout=120) as answer:
            return json.load(answer)
    except urllib.error.HTTPError as error:
        problem = json.load(error)
        raise SystemExit(f"{problem['title']}: {problem['detail']}") from None
    except urllib.error.URLError as error:
        raise SystemExit(f"{server} does not answer: {error.reason}") from None


def main():
    server, file = sys.argv[1].rstrip("/"), sys.argv[2]
    width, height = 320, 180

    # Without a camera the picture is seen from where the page starts. This one is a little nearer.
    session = call(server, "GET", "/status")["session"]
    if "home" not in session:
        raise SystemExit(session["problem"])
    camera = session["home"]
    camera["eye"] = [e + 0.2 * (t - e) for e, t in zip(camera["eye"], camera["target"])]

    picture = call(server, "POST", "/image", {
        "camera": camera, "width": width, "height": height, "tauPixels": 0.5, "withDepth": True,
    })
    with open(file, "wb") as out:
        out.write(base64.b64decode(picture["image"]))

    depths = struct.unpack(f"<{width * height}f", base64.b64decode(picture["depth"]))
    hit = [metres for metres in depths if math.isfinite(metres)]
    statistics = picture["statistics"]
    print(f"{file}: {statistics['triangles']} triangles, error at most "
          f"{float(statistics['tauAchieved']):.3g} pixels")
    if hit:
        print(f"{len(hit) / len(depths):.0%} of the pixels show something, "
              f"{min(hit):.4g} to {max(hit):.4g} m away")

    # What the picture's middle shows, in the data at their finest.
    picked = call(server, "POST", "/pick", {
        "camera": camera, "width": width, "height": height, "x": width / 2, "y": height / 2,
    })
    if "point" in picked:
        at = picked["point"]["position"]
        print(f"in the middle: {picked['objectName']} at {at['x']:.6g} {at['y']:.6g} {at['z']:.6g}")


if __name__ == "__main__":
    if len(sys.argv) != 3:
        raise SystemExit(__doc__)
    main()
