#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Has a running Eyrie measure speed against error, tells how far it is, and prints what came of it.

    run_bench.py http://127.0.0.1:8080 survey.bench FILE.html [TAU,TAU...] [--reference] [--replace]

The report stays in the server's data folder under the name given; its page is saved to FILE.html.
With --reference errors are measured, too, against what the data were imported from.
Without --replace a report of that name is not overwritten.
Ctrl-C calls the run off. A server with tokens wants one of the role admin, in EYRIE_TOKEN.
"""
import json
import os
import sys
import time
import urllib.error
import urllib.parse
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
            return answer.read()
    except urllib.error.HTTPError as error:
        raise SystemExit(json.load(error)["detail"]) from None
    except urllib.error.URLError as error:
        raise SystemExit(f"{server} does not answer: {error.reason}") from None


def ended(server, operation):
    told = ""
    while operation["state"] not in ENDED:
        time.sleep(0.2)
        operation = json.loads(ask(server, "GET", f"/operations/{operation['id']}"))
        now = f"{operation['stage']}: {operation['stageProgress']:.0%}"
        if operation["stage"] and now != told:
            told = now
            print(now, flush=True)
    return operation


def main():
    arguments = [each for each in sys.argv[1:] if each not in ("--reference", "--replace")]
    if len(arguments) not in (3, 4):
        raise SystemExit(__doc__)
    server, output, file = arguments[0].rstrip("/"), arguments[1], arguments[2]
    try:
        taus = [float(tau) for tau in (arguments[3] if len(arguments) > 3 else "1,4").split(",")]
    except ValueError:
        raise SystemExit(__doc__) from None
    # Of what is shown now. The key makes it safe to ask again where an answer got lost.
    operation = json.loads(ask(
        server, "POST", "/bench-runs",
        {"output": output, "tauPixels": taus, "width": 320, "height": 180, "frames": 12,
         "repeats": 1, "replace": "--replace" in sys.argv,
         "withReference": "--reference" in sys.argv},
        {"Idempotency-Key": uuid.uuid4().hex}))
    try:
        operation = ended(server, operation)
    except KeyboardInterrupt:
        ask(server, "POST", f"/operations/{operation['id']}/cancel", {})
        raise SystemExit("called off") from None
    if operation["state"] != "OPERATION_STATE_DONE":
        raise SystemExit(operation["problem"] or operation["state"])
    report = "/reports/" + urllib.parse.quote(output)
    for run in json.loads(ask(server, "GET", report))["runs"]:
        measured = f", measured {run['errorPx']['max']:.3g}" if "errorPx" in run else ""
        print(f"{run['label']}: {run['frameMs']['p50']:.1f} ms a frame, promised error at most "
              f"{float(run['tauAchievedMax']):.3g} pixels{measured}")
    with open(file, "wb") as page:
        page.write(ask(server, "GET", report + "?file=REPORT_FILE_PAGE"))


if __name__ == "__main__":
    main()
