#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What frames take and how exact they are, as they are drawn: a line a frame, at most 4 a second.

    watch_statistics.py http://127.0.0.1:8080 [LINES]

Ends after so many lines, when the server does, or with Ctrl-C. A server with tokens wants one, in
EYRIE_TOKEN.
"""
import json
import os
import sys
import urllib.error
import urllib.request


def events(server):
    """The data of each server-sent event, as it comes."""
    headers = {}
    if "EYRIE_TOKEN" in os.environ:
        headers["Authorization"] = "Bearer " + os.environ["EYRIE_TOKEN"]
    request = urllib.request.Request(f"{server}/api/v1/statistics?perSecond=4", headers=headers)
    with urllib.request.urlopen(request, timeout=60) as answer:
        for line in answer:
            if line.startswith(b"data: "):  # between them are comments and empty lines
                yield json.loads(line.removeprefix(b"data: "))


def main():
    server = sys.argv[1].rstrip("/")
    try:
        lines = int(sys.argv[2]) if len(sys.argv) > 2 else None
    except ValueError:
        raise SystemExit(__doc__) from None
    try:
        for count, event in enumerate(events(server), start=1):
            statistics = event["statistics"]
            print(f"frame {event['frame']} of {event['session'] or 'a program'}: "
                  f"{statistics['milliseconds']['total']:.1f} ms, {statistics['triangles']} "
                  f"triangles, error at most {float(statistics['tauAchieved']):.3g} pixels, "
                  f"{event['leftOut']} left out", flush=True)
            if count == lines:
                return
    except urllib.error.HTTPError as error:
        raise SystemExit(json.load(error)["detail"]) from None
    except urllib.error.URLError as error:
        raise SystemExit(f"{server} does not answer: {error.reason}") from None
    except KeyboardInterrupt:
        pass


if __name__ == "__main__":
    if len(sys.argv) not in (2, 3):
        raise SystemExit(__doc__)
    main()
