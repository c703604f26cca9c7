#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""How fast stills come by REST, beside what the renderer could draw.

usage: stills.py EYRIE SCENE [STILLS=60] [WIDTHxHEIGHT=1280x720] [TAU=1] [IN_FLIGHT=4]

Starts `EYRIE serve SCENE` with one renderer, and asks for stills from places on an orbit, each
twice before anything is measured, so that all data are there. Prints how long the renderer takes
for a still when nothing else is asked for (choosing, drawing and fetching it, by its own clock), the
largest error of the stills, and then for every format the stills a second with IN_FLIGHT requests
at any time, and what share that is of the renderer's own rate. Python's standard library only.
"""
import collections
import json
import math
import os
import socket
import subprocess
import sys
import tempfile
import threading
import time

BEGIN = "Eyrie is at http://"


def orbit(home, turn):
    """The home camera, turned about what it looks at."""
    x, y, z = (e - t for e, t in zip(home["eye"], home["target"]))
    cos, sin = math.cos(turn), math.sin(turn)
    turned = (x * cos - y * sin, x * sin + y * cos, z)
    return {**home, "eye": [t + e for t, e in zip(home["target"], turned)]}


class Server:
    def __init__(self, program, scene, cache):
        self.process = subprocess.Popen(
            [program, "serve", scene, "--listen", "127.0.0.1:0", "--renderers", "1"],
            stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True,
            env={**os.environ, "XDG_CACHE_HOME": cache})
        line = ""
        while not line.startswith(BEGIN):
            line = self.process.stdout.readline()
            if not line:
                sys.exit("stills: the server does not start")
        self.place = line[len(BEGIN):].strip().rstrip("/")

    def end(self):
        self.process.terminate()
        self.process.wait()


class Client:
    """One connection, kept. It asks and reads with as little work as can be, for that takes the
    cores from those who draw, too: half of what http.client does."""

    def __init__(self, place):
        self.host = place
        self.socket = socket.create_connection(place.rsplit(":", 1), timeout=120)
        self.room = bytearray(1 << 20)

    def call(self, method, path, body="", accept="*/*"):
        """What is answered, valid until the next call."""
        text = body.encode()
        head = (f"{method} /api/v1{path} HTTP/1.1\r\nHost: {self.host}\r\nAccept: {accept}\r\n"
                f"Content-Type: application/json\r\nContent-Length: {len(text)}\r\n\r\n")
        self.socket.sendall(head.encode() + text)
        end, filled = -1, 0
        while end < 0:
            filled += self.receive(filled)
            end = self.room.find(b"\r\n\r\n", 0, filled)
        head = self.room[:end].decode().lower()
        begin, size = end + 4, int(head.split("content-length:")[1].split("\r\n")[0])
        if begin + size > len(self.room):
            self.room.extend(bytes(begin + size - len(self.room)))
        while filled < begin + size:
            filled += self.receive(filled)
        content = memoryview(self.room)[begin:begin + size]
        if head.split()[1] != "200":
            raise RuntimeError(f"{method} {path} gives {head}: {bytes(content).decode()}")
        return content

    def receive(self, filled):
        size = self.socket.recv_into(memoryview(self.room)[filled:])
        if size == 0:
            raise RuntimeError("the server has hung up")
        return size

    def json(self, method, path, body=""):
        return json.loads(bytes(self.call(method, path, body, "application/json")))


def still(request, form):
    return json.dumps({**request, "format": f"IMAGE_FORMAT_{form}"})


def own_milliseconds(client, asked):
    """Of each still, asked for one by one; and the largest error of all."""
    times, error = [], 0.0
    for request in asked:
        statistics = client.json("POST", "/image", still(request, "RAW"))["statistics"]
        stages = statistics["milliseconds"]
        times.append(sum(float(stages[name]) for name in ("cull", "draw", "readback")))
        error = max(error, float(statistics["tauAchieved"]))
    return times, error


def stills_a_second(clients, asked, form):
    waiting = collections.deque(still(request, form) for request in asked)
    sizes = []

    def fetch(client):
        try:
            while True:
                sizes.append(len(client.call("POST", "/image", waiting.popleft())))
        except IndexError:
            pass  # none is left

    begin = time.perf_counter()
    threads = [threading.Thread(target=fetch, args=(client,)) for client in clients]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    if len(sizes) < len(asked):
        sys.exit("stills: some have not come")
    return len(asked) / (time.perf_counter() - begin), sum(sizes) / len(sizes)


def main():
    if len(sys.argv) < 3 or sys.argv[1] == "--help":
        sys.exit(__doc__)
    program, scene, count, size, tau, in_flight = (sys.argv[1:] + [None] * 4)[:6]
    try:
        count, tau, in_flight = int(count or 60), float(tau or 1), int(in_flight or 4)
        width, height = map(int, (size or "1280x720").split("x"))
    except ValueError:
        sys.exit(__doc__)
    with tempfile.TemporaryDirectory() as cache:
        server = Server(program, scene, cache)
        try:
            clients = [Client(server.place) for _ in range(in_flight)]
            home = clients[0].json("GET", "/status")["session"]["home"]
            asked = [{"camera": orbit(home, 2 * math.pi * i / count), "width": width,
                      "height": height, "tauPixels": tau} for i in range(count)]
            for _ in range(2):
                stills_a_second(clients, asked, "JPEG")
            times, error = own_milliseconds(clients[0], asked)
            own = 1000 * count / sum(times)
            print(f"{width}x{height}, tau {tau:g} (achieved {error:.3g}): the renderer takes "
                  f"{sum(times) / count:.1f} ms a still, {own:.1f} stills/s")
            for form in ("RAW", "JPEG", "PNG"):
                rate, size = stills_a_second(clients, asked, form)
                print(f"{form:5} {rate:6.1f} stills/s, {100 * rate / own:4.0f} % of that, "
                      f"{size / 1000:.0f} kB each, {in_flight} in flight")
        finally:
            server.end()


main()
