#!/bin/sh
# Makes golden pictures anew, all or those named: update.sh [NAME...]. Look at every one before
# committing it: from then on it is what the effect must look like.
# ROIL_BINARY_DIR: where the program was built (default: build).
set -eu
ROIL_SOURCE_DIR=$(cd "$(dirname "$0")/../.." && pwd)
export ROIL_SOURCE_DIR
export ROIL_BINARY_DIR="${ROIL_BINARY_DIR:-$ROIL_SOURCE_DIR/build}"
golden=$ROIL_SOURCE_DIR/tests/golden
[ $# -gt 0 ] || {
    # shellcheck disable=SC2046 # a list
    set -- $(sed -n 's/^\([^# ][^ ]*\) .*/\1/p' "$golden/pictures.txt")
}
for name; do
    "$golden/render.sh" "$name" "$golden/$name.png"
done
