#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Pictures all around the scene, several in flight at a time: numbered JPEGs in a folder.

    turntable.py http://127.0.0.1:8080 FOLDER [PICTURES]

A server with tokens wants one, in EYRIE_TOKEN.
"""
import concurrent.futures
import json
import math
import os
import sys
import urllib.error
import urllib.request

IN_FLIGHT = 4  # the server draws one while it encodes others


def ask(server, path, body=None):
    """The answer's bytes."""
    headers = {"Content-Type": "application/json"}
    if "EYRIE_TOKEN" in os.environ:
        headers["Authorization"] = "Bearer " + os.environ["EYRIE_TOKEN"]
    request = urllib.request.Request(
        f"{server}/api/v1{path}", headers=headers,
        data=None if body is None else json.dumps(body).encode())
    try:
        with urllib.request.urlopen(request, timeout=120) as answer:
            return answer.read()
    except urllib.error.HTTPError as error:
        raise SystemExit(json.load(error)["detail"]) from None
    except urllib.error.URLError as error:
        raise SystemExit(f"{server} does not answer: {error.reason}") from None


def render(server, camera):
    return ask(server, "/image", {
        "camera": camera, "width": 320, "height": 180, "format": "IMAGE_FORMAT_JPEG",
    })


def turned(home, turn):
    """`home` with its eye moved around a vertical axis through its target."""
    x, y, z = (e - t for e, t in zip(home["eye"], home["target"]))
    cosine, sine = math.cos(turn), math.sin(turn)
    offset = (cosine * x - sine * y, sine * x + cosine * y, z)
    return {**home, "eye": [t + o for t, o in zip(home["target"], offset)]}


def main():
    server, folder = sys.argv[1].rstrip("/"), sys.argv[2]
    try:
        count = int(sys.argv[3]) if len(sys.argv) > 3 else 8
    except ValueError:
        raise SystemExit(__doc__) from None
    if count < 1:
        raise SystemExit(__doc__)
    os.makedirs(folder, exist_ok=True)
    session = json.loads(ask(server, "/status"))["session"]
    if "home" not in session:
        raise SystemExit(session["problem"])
    cameras = [turned(session["home"], 2 * math.pi * i / count) for i in range(count)]
    with concurrent.futures.ThreadPoolExecutor(IN_FLIGHT) as pool:
        for i, jpeg in enumerate(pool.map(lambda camera: render(server, camera), cameras)):
            with open(os.path.join(folder, f"{i:04}.jpg"), "wb") as out:
                out.write(jpeg)
    print(f"{count} pictures in {folder}")


if __name__ == "__main__":
    if len(sys.argv) not in (3, 4):
        raise SystemExit(__doc__)
    main()
