#!/bin/bash
# How fast belvedere-build makes quadnodes of an image, beside gdal2tiles.py on the same image and cores.
#
#   build_rate.sh BELVEDERE_BUILD IMAGE.jpg [RUNS]
#
# IMAGE covers the Earth, west to east from 180 W, north to south from 90 N. Prints both rates of every run and the median
# ratio. A quadnode has 256 x 256 texels in both.
set -euo pipefail

program="$(realpath "${1:?usage: build_rate.sh BELVEDERE_BUILD IMAGE [RUNS]}")"
image="$(realpath "${2:?usage: build_rate.sh BELVEDERE_BUILD IMAGE [RUNS]}")"
runs="${3:-3}"
jobs=2
work="$(mktemp -d)"
trap 'rm -rf "$work"' EXIT

cat > "$work/spec.toml" <<SPEC
[[layer]]
name = "imagery"
kind = "imagery"
  [[layer.source]]
  path = "$image"
  georeference = [-180, -90, 180, 90]
SPEC
gdal_translate -q -of VRT -a_srs EPSG:4326 -a_ullr -180 90 180 -90 "$image" "$work/image.vrt"

echo "machine: $(grep -m1 'model name' /proc/cpuinfo | cut -d: -f2-), $(nproc) cores, $jobs jobs; $("$program" --version | head -1)"
seconds() { local start; start="$(date +%s.%N)"; "$@" > /dev/null 2>&1; echo "$(date +%s.%N) - $start" | awk '{print $1 - $3}'; }
for run in $(seq "$runs"); do
  ours_s="$(seconds "$program" "$work/spec.toml" --out "$work/dataset" --jobs "$jobs")"
  ours="$("$program" info "$work/dataset" --json | grep -o '"pages": [0-9]*' | tail -1 | grep -o '[0-9]*$')"
  rm -rf "$work/theirs"
  theirs_s="$(seconds gdal2tiles.py --profile=geodetic --processes=$jobs --webviewer=none "$work/image.vrt" "$work/theirs")"
  theirs="$(find "$work/theirs" -name '*.png' | wc -l)"
  echo "$run $ours $ours_s $theirs $theirs_s" | awk '{
    printf "run %d: belvedere-build %d quadnodes in %.2f s = %.0f/s; gdal2tiles %d in %.2f s = %.0f/s; ratio %.1f\n",
           $1, $2, $3, $2 / $3, $4, $5, $4 / $5, ($2 / $3) / ($4 / $5)}'
done | tee "$work/lines"
grep -o 'ratio [0-9.]*' "$work/lines" | awk '{print $2}' | sort -n | awk '{v[NR] = $1} END {printf "median ratio %.1f\n", v[int((NR + 1) / 2)]}'
