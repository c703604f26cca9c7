#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Who sees what on a running Eyrie; takes a session's viewers somewhere, or sends them away.

    sessions.py http://127.0.0.1:8080                                  lists them
    sessions.py http://127.0.0.1:8080 SESSION EYE TARGET               such as 0,-10,3 0,0,0
    sessions.py http://127.0.0.1:8080 SESSION close

A server with tokens wants one, in EYRIE_TOKEN: of the role control to move, of admin to close.
"""
import json
import os
import sys
import urllib.error
import urllib.parse
import urllib.request


def ask(server, method, path, body=None):
    headers = {"Content-Type": "application/json"}
    if "EYRIE_TOKEN" in os.environ:
        headers["Authorization"] = "Bearer " + os.environ["EYRIE_TOKEN"]
    request = urllib.request.Request(
        f"{server}/api/v1{path}", method=method, headers=headers,
        data=None if body is None else json.dumps(body).encode())
    try:
        with urllib.request.urlopen(request, timeout=60) as answer:
            return json.load(answer)
    except urllib.error.HTTPError as error:
        raise SystemExit(json.load(error)["detail"]) from None
    except urllib.error.URLError as error:
        raise SystemExit(f"{server} does not answer: {error.reason}") from None


def tell(session):
    camera = session.get("view", {}).get("camera")
    eye = ", ".join(f"{metres:.6g}" for metres in camera["eye"]) if camera else "nowhere yet"
    print(f"{session['id']}: from {eye}; {session['framesDrawn']} frames")
    for viewer in session["viewers"]:
        print(f"  viewer {viewer['id']} {'leads' if viewer['leads'] else 'watches'}, "
              f"{viewer['width']}x{viewer['height']}, "
              f"{viewer['codec'].removeprefix('PICTURE_CODEC_')}, "
              f"{viewer['picturesSent']} pictures")


def main():
    server, arguments = sys.argv[1].rstrip("/"), sys.argv[2:]
    if not arguments:
        for session in ask(server, "GET", "/sessions")["sessions"]:
            tell(session)
        return
    path = "/sessions/" + urllib.parse.quote(arguments[0])
    if arguments[1:] == ["close"]:
        ask(server, "DELETE", path)
        return
    try:
        eye, target = ([float(metres) for metres in place.split(",")] for place in arguments[1:])
    except ValueError:
        raise SystemExit(__doc__) from None
    ask(server, "PATCH", path, {"camera": {"eye": eye, "target": target}})
    tell(ask(server, "GET", path))


if __name__ == "__main__":
    if len(sys.argv) not in (2, 4, 5):
        raise SystemExit(__doc__)
    main()
