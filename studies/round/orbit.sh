#!/usr/bin/env bash
# A blown candle from all round: the rig in three dimensions, and beside it a model of its films, as one film.
#
#   studies/round/orbit.sh OUT.mp4 [MODEL.wisp [SPEED [WIND]]]     default: two.wisp, as docs/studies/round.md learns it,
#                                                                  0.5 m/s, and 0.7 of the wind that the model has heard
set -euo pipefail
out=$1 model=${2:-two.wisp} speed=${3:-0.5} wind=${4:-0.7}
bin=$(dirname "$0")/../../build/release/bin
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
"$bin/wisp_verify_round" film "$folder/rig" --seconds 7 --angles 0 --from 45 --wind "$speed" --orbit 6 --side 26 --cell 1.6 >/dev/null
# Towards x and z, which is to the right of a camera at 315°.
"$bin/wisp" run "$model" --frames 420 --wind "$wind" --wind-direction 315 --orbit 6 --quiet -o "$folder/model.mp4" >/dev/null
ffmpeg -v error -y -ss 1 -i "$folder/rig.0.mp4" -ss 1 -i "$folder/model.mp4" -filter_complex \
  '[0:v]scale=-2:480[a];[1:v]scale=-2:480[b];[a][b]hstack=shortest=1' -an "$out"
echo "$out"
