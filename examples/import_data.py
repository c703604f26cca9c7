#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Imports a file of the server's data folder, telling how far it is, and says what came of it.

    import_data.py http://127.0.0.1:8080 survey/dem.tif survey/dem.eyt [--replace]

Without --replace a file of that name is not overwritten.
Ctrl-C calls the import off. A server with tokens wants one of the role admin, in EYRIE_TOKEN.
"""
import json
import os
import sys
import time
import urllib.error
import urllib.request
import uuid

ENDED = ("OPERATION_STATE_DONE", "OPERATION_STATE_FAILED", "OPERATION_STATE_CANCELLED")


def ask(server, method, path, body=None, headers=None):
    headers = {"Content-Type": "application/json", **(headers or {})}
    if "EYRIE_TOKEN" in os.environ:
        headers["Authorization"] = "Bearer " + os.environ["EYRIE_TOKEN"]
    request = urllib.request.Request(
        f"{server}/api/v1{path}", method=method, headers=headers,
        data=None if body is None else json.dumps(body).encode())
    try:
        with urllib.request.urlopen(request, timeout=60) as answer:
            return json.load(answer)
    except urllib.error.HTTPError as error:
        raise SystemExit(json.load(error)["detail"])
    except urllib.error.URLError as error:
        raise SystemExit(f"{server} does not answer: {error.reason}") from None


def begin(server, source, output, replace):
    # The key makes it safe to ask again where an answer got lost.
    return ask(server, "POST", "/imports",
               {"sources": [source], "output": output, "replace": replace},
               {"Idempotency-Key": uuid.uuid4().hex})


def ended(server, operation):
    while operation["state"] not in ENDED:
        time.sleep(0.2)
        operation = ask(server, "GET", f"/operations/{operation['id']}")
        if operation["stage"]:
            left = operation.get("stageSecondsLeft")
            print(f"{operation['stage']}: {operation['stageProgress']:.0%}"
                  + (f", {left:.0f} s left" if left is not None else ""), flush=True)
    return operation


def main():
    arguments = [each for each in sys.argv[1:] if each != "--replace"]
    if len(arguments) != 3:
        raise SystemExit(__doc__)
    server, source, output = arguments[0].rstrip("/"), arguments[1], arguments[2]
    operation = begin(server, source, output, "--replace" in sys.argv)
    try:
        operation = ended(server, operation)
    except KeyboardInterrupt:
        ask(server, "POST", f"/operations/{operation['id']}/cancel", {})
        raise SystemExit("called off")
    if operation["state"] != "OPERATION_STATE_DONE":
        raise SystemExit(operation["problem"] or operation["state"])
    for note in operation["notes"]:
        print(f"{output}: {note}")
    for data_set in ask(server, "GET", "/data-sets")["dataSets"]:
        if data_set["path"] == output:
            print(f"{output}: {data_set['triangles']} triangles, {data_set['levels']} levels, "
                  f"{data_set['bytes']} bytes, {operation['seconds']:.1f} s")


if __name__ == "__main__":
    main()
