#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Makes every call that a running Eyrie's OpenAPI document has, by its example, and holds the
answers against the document's schemas: check_api.py http://127.0.0.1:PORT

There is to be a viewer in the session "example".
"""
import json
import re
import sys
import time
import urllib.error
import urllib.request

SERVER = sys.argv[1].rstrip("/") + "/api/v1"
ORDER = ["put", "post", "patch", "get", "delete"]  # what is read or removed has been put before


def content(answer):
    """The JSON; of an answer that goes on, that of its first event."""
    if answer.headers["Content-Type"] != "text/event-stream":
        return json.load(answer)
    for line in answer:
        if line.startswith(b"data: "):
            return json.loads(line.removeprefix(b"data: "))
    return None


def await_operations():
    """What they make is asked for afterwards."""
    for _ in range(600):
        operations = ask("get", "/operations")[2]["operations"]
        if all(one["state"] not in ("OPERATION_STATE_WAITING", "OPERATION_STATE_RUNNING")
               for one in operations):
            return
        time.sleep(0.2)


def await_scene():
    """Renderers open again what was put."""
    for _ in range(600):
        if ask("get", "/status")[2]["ready"]:
            return
        time.sleep(0.2)


def ask(method, path, body=None):
    request = urllib.request.Request(
        SERVER + path, method=method.upper(), data=None if body is None else json.dumps(body).encode(),
        headers={"Accept": "application/json", "Content-Type": "application/json"})
    try:
        with urllib.request.urlopen(request, timeout=120) as answer:
            return answer.status, answer.headers["Content-Type"], content(answer)
    except urllib.error.HTTPError as error:
        return error.code, error.headers["Content-Type"], json.load(error)


DOCUMENT = ask("get", "/openapi.json")[2]


def resolved(schema):
    if "$ref" not in schema:
        return schema
    at = DOCUMENT
    for name in schema["$ref"].removeprefix("#/").split("/"):
        at = at[name]
    return at


TYPES = {"object": dict, "array": list, "string": str, "integer": int, "number": (int, float),
         "boolean": bool}


def mismatches(value, schema, where):
    """What of `value` is not as `schema`, of JSON Schema what the document uses, has it."""
    schema = resolved(schema)
    if "anyOf" in schema:
        if all(list(mismatches(value, one, where)) for one in schema["anyOf"]):
            yield f"{where}: {value!r} is none of {schema['anyOf']}"
        return
    if "enum" in schema and value not in schema["enum"]:
        yield f"{where}: {value!r} is not one of {schema['enum']}"
        return
    kind = schema.get("type")
    if kind and (not isinstance(value, TYPES[kind])
                 or isinstance(value, bool) != (kind == "boolean")):
        yield f"{where}: {value!r} is no {kind}"
        return
    if "pattern" in schema and not re.search(schema["pattern"], value):
        yield f"{where}: {value!r} is not of the form {schema['pattern']}"
    if kind == "array":
        for i, element in enumerate(value):
            yield from mismatches(element, schema["items"], f"{where}[{i}]")
    if kind == "object":
        known = schema.get("properties", {})
        for name in schema.get("required", []):
            if name not in value:
                yield f"{where}: {name} is missing"
        for name, member in value.items():
            if name not in known:
                yield f"{where}.{name} is not in the document"
            else:
                yield from mismatches(member, known[name], f"{where}.{name}")


def checked(operation, where, status, content_type, answer, expected):
    if status != expected:
        yield f"{where}: {status} in place of {expected}: {answer}"
        return
    responses = operation["responses"]
    response = responses.get(str(status), responses["default"])
    if content_type not in response["content"]:
        yield f"{where}: {content_type} is not in the document"
        return
    yield from mismatches(answer, response["content"][content_type]["schema"], where)


def run(path, method, operation):
    query = []
    for parameter in operation["parameters"]:
        if parameter["in"] == "path":
            path = path.replace("{" + parameter["name"] + "}", parameter["example"])
        elif "example" in parameter:
            query.append(f"{parameter['name']}={parameter['example']}")
    body = None
    if "requestBody" in operation:
        content = operation["requestBody"]["content"]["application/json"]
        # Of some the example is what is there: any server answers it.
        body = content["example"] if "example" in content else ask("get", path)[2]
        yield from mismatches(body, content["schema"], f"{method} {path} asked")
    where = f"{method} {path}"
    url = path + ("?" + "&".join(query) if query else "")
    yield from checked(operation, where, *ask(method, url, body), 200)
    strange = path + "?strange=1"
    yield from checked(operation, where + " with a strange field", *ask(method, strange, body), 400)


def main():
    calls = [(path, method, operation) for path, methods in DOCUMENT["paths"].items()
             for method, operation in methods.items()]
    calls.sort(key=lambda call: ORDER.index(call[1]))
    puts = [call for call in calls if call[1] == "put"]
    wrong = [text for call in puts for text in run(*call)]
    await_scene()
    wrong += [text for call in calls if call[1] == "post" for text in run(*call)]
    await_operations()
    wrong += [text for call in calls if call[1] not in ("put", "post") for text in run(*call)]
    print("\n".join(wrong))
    print(f"{len(calls)} calls, {len(wrong)} answers that are not as documented")
    raise SystemExit(1 if wrong else 0)


main()
