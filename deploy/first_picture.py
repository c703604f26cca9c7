#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""first_picture.py PORT: asks the Eyrie at 127.0.0.1:PORT for a picture of the
scene from its home camera, as the page does (proto/eyrie/v1/viewer.proto), and prints its size.
Exit status 1 without one that shows triangles. Python's standard library only."""
import base64
import os
import socket
import struct
import sys

VARINT, FIXED64, BYTES = 0, 1, 2
TRIANGLES = 6  # of FrameStatistics


def varint(data, at):
    value = shift = 0
    while True:
        byte = data[at]
        at += 1
        value |= (byte & 0x7F) << shift
        shift += 7
        if byte < 0x80:
            return value, at


def fields(data):
    """A protobuf message as {field: last value}: numbers, or bytes."""
    found, at = {}, 0
    while at < len(data):
        key, at = varint(data, at)
        kind = key & 7
        if kind == VARINT:
            found[key >> 3], at = varint(data, at)
            continue
        size = 8 if kind == FIXED64 else 4
        if kind == BYTES:
            size, at = varint(data, at)
        found[key >> 3] = data[at:at + size]
        at += size
    return found


def encoded(value):
    out = bytearray()
    while value > 0x7F:
        out.append(value & 0x7F | 0x80)
        value >>= 7
    return bytes(out) + bytes([value])


def number(field, value):
    return encoded(field << 3 | VARINT) + encoded(value)


def message(field, content):
    return encoded(field << 3 | BYTES) + encoded(len(content)) + content


class WebSocket:
    def __init__(self, port):
        self.stream = socket.create_connection(("127.0.0.1", port), timeout=60)
        self.reader = self.stream.makefile("rb")
        key = base64.b64encode(os.urandom(16)).decode()
        self.stream.sendall(
            f"GET /ws HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nUpgrade: websocket\r\n"
            f"Connection: Upgrade\r\nSec-WebSocket-Key: {key}\r\n"
            "Sec-WebSocket-Version: 13\r\n\r\n".encode())
        answer = self.reader.readline()
        if b" 101 " not in answer:
            sys.exit(f"first_picture: the server answers {answer!r}")
        while self.reader.readline().strip():
            pass

    def send(self, content):
        mask = os.urandom(4)
        masked = bytes(byte ^ mask[i % 4] for i, byte in enumerate(content))
        size = bytes([0x80 | len(content)]) if len(content) < 126 else struct.pack(
            "!BH", 0x80 | 126, len(content))
        self.stream.sendall(b"\x82" + size + mask + masked)

    def receive(self):
        content = b""
        while True:
            head, size = self.reader.read(2)
            size &= 0x7F
            if size > 125:
                size = struct.unpack("!H" if size == 126 else "!Q",
                                     self.reader.read(2 if size == 126 else 8))[0]
            data = self.reader.read(size)
            if head & 0x0F == 8:
                sys.exit("first_picture: the server ended the connection")
            if head & 0x0F < 8:
                content += data
                if head & 0x80:
                    return content


def main():
    server = WebSocket(int(sys.argv[1]))
    asked = False
    while True:
        answer = fields(server.receive())
        state = fields(answer.get(1, b""))
        if 4 in state and not asked:  # SessionState.home
            view = number(1, 1) + message(2, state[4]) + number(3, 1280) + number(4, 720)
            server.send(message(1, view + encoded(5 << 3 | FIXED64) + struct.pack("<d", 1.0)))
            asked = True
        if 2 in answer:
            frame = fields(answer[2])
            triangles = fields(frame[6]).get(TRIANGLES, 0)
            if frame.get(2, 0) == 1 and triangles > 0:
                print(f"a picture of {frame[3]} x {frame[4]} pixels, {triangles} triangles, "
                      f"{frame[10]} bytes")
                return


main()
