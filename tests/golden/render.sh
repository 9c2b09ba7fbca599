#!/bin/sh
# render.sh NAME FILE.png: renders a golden picture as pictures.txt says; small, since each is kept
# in the repository. ROIL_SOURCE_DIR and ROIL_BINARY_DIR are set by ctest or update.sh.
set -eu
line=$(grep "^$1 " "$ROIL_SOURCE_DIR/tests/golden/pictures.txt") || {
    echo "$1 is not in tests/golden/pictures.txt" >&2
    exit 1
}
file=$2
# shellcheck disable=SC2086 # words of the line
set -- $line
effect=$2 frame=$3
shift 3
case $file in
/*) ;;
*) file=$PWD/$file ;;
esac
cd "$ROIL_SOURCE_DIR" # the picture says what it was made of: no path of this machine
exec "$ROIL_BINARY_DIR/roil" render "effects/$effect" --frames "$frame" --size 240x135 -o "$file" "$@"
