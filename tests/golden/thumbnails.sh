#!/bin/sh
# Makes the small pictures of shipped effects, which the start page of `roil live` shows, from their
# golden pictures: effects/gallery/small/NAME.png. Needs ffmpeg.
set -eu
golden=$(dirname "$0")
effects=$golden/../../effects
mkdir -p "$effects/gallery/small"
for effect in "$effects"/*.lua; do
    name=$(basename "$effect" .lua)
    stem=$(echo "$name" | tr _ -)
    rm -f "$effects/gallery/small/$name.png"
    for picture in "$golden/$stem".png "$golden/$stem"-[0-9]*.png "$golden/$stem"-*.png; do
        if [ ! -f "$picture" ] || [ -f "$effects/gallery/small/$name.png" ]; then continue; fi
        ffmpeg -loglevel error -y -i "$picture" -map_metadata -1 -vf "scale=256:144:force_original_aspect_ratio=increase,crop=256:144,split[a][b];[a]palettegen=max_colors=128[p];[b][p]paletteuse" \
            -frames:v 1 "$effects/gallery/small/$name.png" </dev/null
    done
done
