#!/bin/sh
# check.sh NAME: renders the picture and compares it with the golden one.
# check.sh --complete: every effect has a golden picture, and every golden picture is made by one.
# ROIL_SOURCE_DIR and ROIL_BINARY_DIR are set by ctest.
set -eu
golden=$ROIL_SOURCE_DIR/tests/golden
made=$ROIL_BINARY_DIR/golden

if [ "$1" = --complete ]; then
    status=0
    for effect in "$ROIL_SOURCE_DIR"/effects/*.lua; do
        name=$(basename "$effect")
        grep -q "^[^# ][^ ]* $name " "$golden/pictures.txt" || {
            echo "effects/$name has no golden picture: name one in tests/golden/pictures.txt"
            status=1
        }
    done
    for picture in "$golden"/*.png; do
        name=$(basename "$picture" .png)
        grep -q "^$name " "$golden/pictures.txt" || {
            echo "$name.png is not in tests/golden/pictures.txt"
            status=1
        }
    done
    exit $status
fi

if [ ! -f "$golden/$1.png" ]; then
    echo "tests/golden/$1.png is missing: make it with tests/golden/update.sh $1, and look at it" >&2
    exit 1
fi
mkdir -p "$made"
"$golden/render.sh" "$1" "$made/$1.png"
"$ROIL_BINARY_DIR/golden_compare" "$golden/$1.png" "$made/$1.png" "$made/$1-difference.png"
