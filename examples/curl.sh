#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# The calls most asked for, by curl: curl.sh http://127.0.0.1:8080 FOLDER
# A server with tokens wants one, in EYRIE_TOKEN.
set -euo pipefail
server=${1:?usage: curl.sh SERVER FOLDER}/api/v1
folder=${2:?usage: curl.sh SERVER FOLDER}
# By a file, since everybody on this machine sees what commands are given as arguments.
token() { [[ -z ${EYRIE_TOKEN:-} ]] || echo "Authorization: Bearer $EYRIE_TOKEN"; }
ask() { curl --silent --show-error --fail-with-body --header @<(token) "$@"; }
mkdir -p "$folder"

# What there is.
ask "$server/status" -o "$folder/status.json"
ask "$server/configuration" -o "$folder/configuration.json"

# A picture of it, in one line.
ask "$server/image?width=320&height=180" -o "$folder/picture.png"

# A picture as it is wanted; --json alone asks for JSON that has it as base64.
ask "$server/image" -o "$folder/picture.jpg" --header 'Accept: image/jpeg' --json \
    '{"width":320,"height":180,"tauPixels":0.5,"shading":"SHADING_FLAT","format":"IMAGE_FORMAT_JPEG"}'

# The same with the sun low in the west, and without the scene's second object.
ask "$server/image" -o "$folder/evening.png" --header 'Accept: image/png' --json \
    '{"width":320,"height":180,"look":{"sun":{"azimuthDegrees":270,"elevationDegrees":15},"hiddenObjects":[1]}}'

# The upper half of a larger one: posters come in parts, as many as one likes.
ask "$server/image" -o "$folder/upper.png" --header 'Accept: image/png' --json \
    '{"width":640,"height":360,"part":{"y":180,"width":640,"height":180}}'

# What is in its middle.
ask "$server/pick" -o "$folder/pick.json" --json '{"width":320,"height":180,"x":160,"y":90}'

# The answer again, only if it has changed.
tag=$(ask --head "$server/scene" | tr -d '\r' | sed -n 's/^[Ee][Tt]ag: //p')
ask "$server/scene" --header "If-None-Match: $tag" -o /dev/null -w 'scene: %{http_code}\n'

# Who is looking, and at what; examples/sessions.py moves their camera.
ask "$server/sessions" -o "$folder/sessions.json"

# What the last frame took: the first event of a stream of them, which curl would go on reading.
ask --no-buffer --max-time 2 "$server/statistics?perSecond=1" | head -n 1 > "$folder/frame.txt" || true

# What data there are for scenes, and what is being imported.
ask "$server/data-sets" -o "$folder/data-sets.json"
ask "$server/operations" -o "$folder/operations.json"

# What goes wrong says so, and what to do.
curl --silent --header @<(token) "$server/image?width=0"
