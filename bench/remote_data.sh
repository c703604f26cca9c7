#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# What it costs to draw terrain that lies on a web server: bench/remote_data.sh EYRIE DEM.eyt CAMERA.json
# Draws one complete picture from the local file, from nginx on the loopback with nothing kept, and
# once more from what was kept. Prints for each the median wall and processor time of RUNS (5)
# whole runs of `eyrie render`, and the bytes that nginx sent.
set -euo pipefail
eyrie=$(realpath "$1") data=$(realpath "$2") camera=$(realpath "$3") runs=${RUNS:-5} port=${PORT:-8089}
work=$(mktemp -d)
trap 'kill $(cat "$work/pid") 2>/dev/null; rm -rf "$work"' EXIT
cat >"$work/nginx.conf" <<TEXT
$([[ $EUID -eq 0 ]] && echo "user root;")
worker_processes 1;
pid $work/pid;
events {}
http {
  client_body_temp_path $work/b; proxy_temp_path $work/p; fastcgi_temp_path $work/f;
  uwsgi_temp_path $work/u; scgi_temp_path $work/s;
  log_format bytes '\$body_bytes_sent';
  access_log $work/access.log bytes;
  server { listen 127.0.0.1:$port; root $(dirname "$data"); }
}
TEXT
/usr/sbin/nginx -p "$work" -e "$work/error.log" -c "$work/nginx.conf"

# measure NAME PATH: KEEP=1 keeps the cache between runs
measure() {
    local seconds=()
    : >"$work/access.log"
    for ((i = 0; i < runs; ++i)); do
        [[ ${KEEP:-} ]] || rm -rf "$work/cache"
        seconds+=("$( { TIMEFORMAT='%R %U %S'; time "$eyrie" render "$2" --camera "$camera" \
            --size 1280x720 --tau 1 --cache "$work/cache" --quiet -o "$work/out.png"; } 2>&1 |
            awk '{print $1, $2 + $3}')")
    done
    printf '%-14s' "$1"
    for column in 1 2; do
        printf '%s\n' "${seconds[@]}" | sort -n -k$column | awk -v c=$column -v n=$((runs / 2 + 1)) \
            'NR == n {printf "%6.2f s", $c}'
    done
    awk -v runs="$runs" '{sum += $1} END {printf "%12.0f bytes a run, %.0f requests", sum / runs, NR / runs}' \
        "$work/access.log"
    echo "  $(md5sum <"$work/out.png" | cut -c1-8)"
}

echo "$(stat -c %s "$data") bytes; wall, processor time, bytes fetched, picture"
measure local "$data"
measure cold "http://127.0.0.1:$port/$(basename "$data")"
KEEP=1 measure cached "http://127.0.0.1:$port/$(basename "$data")"
