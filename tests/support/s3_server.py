#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""An object store on the loopback that answers as S3 does: s3_server.py FOLDER

Objects are FOLDER's files at /BUCKET/KEY, by GET and HEAD, ranges of them, too. Requests are to be
signed (AWS Signature Version 4, in headers) with S3_KEY_ID and S3_SECRET of the environment for
S3_REGION, and to bear S3_SESSION_TOKEN if that is set. Where there is a file S3_GRANTS, so many of
those are granted, counted from when it was written. The first line printed is the port; then a line
a request: method, path, range, status, and the error's code.
"""
import hashlib
import hmac
import http.server
import itertools
import os
import pathlib
import re
import sys
import urllib.parse

FOLDER = pathlib.Path(sys.argv[1])
KEY_ID, SECRET, REGION, SESSION_TOKEN = (
    os.environ["S3_" + name] for name in ("KEY_ID", "SECRET", "REGION", "SESSION_TOKEN"))
GRANTS = pathlib.Path(os.environ["S3_GRANTS"])
HEADER = re.compile(r"AWS4-HMAC-SHA256 Credential=([^/,]+)/(\d{8})/([^/,]+)/s3/aws4_request, ?"
                    r"SignedHeaders=([^,]+), ?Signature=([0-9a-f]{64})")
granted = {}  # by when the file was written: counts from one


def keyed(key, text):
    return hmac.new(key, text.encode(), hashlib.sha256)


def signature(method, target, headers, names, day, region):
    """What the request would be signed with by who knows the secret."""
    path, _, query = target.partition("?")
    pairs = sorted(pair if "=" in pair else pair + "=" for pair in query.split("&") if pair)
    lines = [f"{name}:{' '.join(headers[name].split())}" for name in names]
    canonical = "\n".join([method, path, "&".join(pairs), *lines, "", ";".join(names),
                           headers["x-amz-content-sha256"]])
    scope = f"{day}/{region}/s3/aws4_request"
    key = ("AWS4" + SECRET).encode()
    for part in scope.split("/"):
        key = keyed(key, part).digest()
    digest = hashlib.sha256(canonical.encode()).hexdigest()
    to_sign = "\n".join(["AWS4-HMAC-SHA256", headers["x-amz-date"], scope, digest])
    return keyed(key, to_sign).hexdigest()


def refusal(method, target, headers):
    """The status and code of S3's error, with more for its XML; None of a request that is right."""
    found = HEADER.fullmatch(headers.get("authorization", ""))
    if not found:
        return 403, "AccessDenied", ""
    key_id, day, region, names, given = found.groups()
    names = names.split(";")
    needed = {"host", "x-amz-content-sha256", "x-amz-date"}
    needed.update(name for name in headers if name.startswith("x-amz-"))
    if not needed <= set(names) or any(name not in headers for name in names):
        return 403, "AccessDenied", ""
    if key_id != KEY_ID:
        return 403, "InvalidAccessKeyId", ""
    if headers.get("x-amz-security-token", "") != SESSION_TOKEN:
        return 400, "InvalidToken", ""
    if region != REGION:
        return 400, "AuthorizationHeaderMalformed", f"<Region>{REGION}</Region>"
    if not hmac.compare_digest(given, signature(method, target, headers, names, day, region)):
        return 403, "SignatureDoesNotMatch", ""
    if GRANTS.exists():
        count = granted.setdefault(GRANTS.stat().st_mtime_ns, itertools.count(1))
        if next(count) > int(GRANTS.read_text()):
            return 403, "AccessDenied", ""
    return None


class Handler(http.server.BaseHTTPRequestHandler):
    protocol_version = "HTTP/1.1"
    wbufsize = -1  # headers and body go together

    def do_GET(self):
        headers = {name.lower(): value for name, value in self.headers.items()}
        refused = refusal(self.command, self.path, headers)
        path = FOLDER / urllib.parse.unquote(self.path.partition("?")[0]).lstrip("/")
        if not refused and (".." in path.parts or not path.is_file()):
            refused = 404, "NoSuchKey", ""
        if refused:
            status, code, more = refused
            text = f"<Error><Code>{code}</Code><Message>{code}</Message>{more}</Error>"
            return self.answer(status, text.encode(), {"Content-Type": "application/xml"}, code)
        size = path.stat().st_size
        first, last = 0, size - 1
        span = re.fullmatch(r"bytes=(\d+)-(\d*)", headers.get("range", ""))
        if span:
            first, last = int(span[1]), min(int(span[2] or last), last)
        with path.open("rb") as file:
            file.seek(first)
            body = file.read(last - first + 1)
        given = {"Content-Range": f"bytes {first}-{last}/{size}"} if span else {}
        return self.answer(206 if span else 200, body, given)

    do_HEAD = do_GET

    def answer(self, status, body, headers, code="-"):
        # Before the answer, so that who has that finds the line.
        asked = self.headers.get("Range", "-")
        print(f"{self.command} {self.path} {asked} {status} {code}\n", end="", flush=True)
        self.send_response(status)
        for name, value in {"Content-Length": len(body), **headers}.items():
            self.send_header(name, value)
        self.end_headers()
        if self.command != "HEAD":
            self.wfile.write(body)

    def log_message(self, *_):
        pass


class Server(http.server.ThreadingHTTPServer):
    request_queue_size = 128  # beyond which a connection would take a second to come about


server = Server(("127.0.0.1", 0), Handler)
print(server.server_address[1], flush=True)
server.serve_forever()
