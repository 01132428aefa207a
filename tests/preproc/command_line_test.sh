#!/bin/sh
# belvedere-build keeps its promises to scripts: exit codes, where output goes, which files are left.
# usage: command_line_test.sh PROGRAM
program=$1
folder=$(mktemp -d) || exit 1
trap 'rm -rf "$folder"' EXIT
cd "$folder" || exit 1
failures=0

fail() {
  echo "$1"
  failures=$((failures + 1))
}

# expect CODE ARGUMENT...: runs the program, checks its exit code; leaves its output in out and err
expect() {
  wanted=$1
  shift
  "$program" "$@" >"$folder/out" 2>"$folder/err"
  code=$?
  [ $code -eq "$wanted" ] || fail "belvedere-build $*: exit code $code, not $wanted: $(cat "$folder/err")"
}

# one_line: the last command said one line on standard error and nothing on standard output
one_line() {
  if [ -s "$folder/out" ] || [ "$(wc -l <"$folder/err")" -ne 1 ]; then
    fail "not one line on standard error alone: $(cat "$folder/out" "$folder/err")"
  fi
}

# A north-up picture of 8 x 4 pixels over the whole Earth.
printf 'P5\n8 4\n255\n%032d' 0 >grey.pgm
# layer NAME KIND PATH MORE: one with a source, as a spec has it
layer() {
  printf '[[layer]]\nname = "%s"\nkind = "%s"\n  [[layer.source]]\n  path = "%s"\n  %s\n' "$@"
}
for kind in elevation imagery; do
  layer $kind $kind grey.pgm 'georeference = [-180, -90, 180, 90]'
done >spec.toml

expect 0 --help
expect 2
expect 2 spec.toml
expect 2 spec.toml --out dataset --report a.html --no-report
[ -e dataset ] && fail "a wrong command line built something"

expect 0 spec.toml --out dataset
one_line
grep -q '</html>' dataset/report.html || fail "a build leaves no report in the dataset"
expect 0 spec.toml --out dataset --report elsewhere.html
grep -q '</html>' elsewhere.html || fail "--report writes none"
[ -e dataset/report.html ] && fail "the report of an earlier build is left in the dataset"
expect 0 spec.toml --out dataset
expect 0 spec.toml --out dataset --no-report
[ -e dataset/report.html ] && fail "--no-report leaves the report of an earlier build"
expect 1 spec.toml --out dataset --report missing/report.html
grep -q 'is built, but not its report' "$folder/err" || fail "a report that cannot be written: $(cat "$folder/err")"
expect 0 verify dataset
grep -q "all 64 pages are good, digest [0-9a-f]\{8\}$" "$folder/out" || fail "verify says: $(cat "$folder/out")"

# What is added, removed and made anew.
tr 0 z <grey.pgm | sed '2s/.*/8 4/' >more.pgm
cat >more.toml <<TEXT
[[layer]]
name = "elevation"
kind = "elevation"
  [[layer.source]]
  path = "more.pgm"
  georeference = [10, 40, 20, 50]
TEXT
expect 2 add dataset
expect 2 remove dataset
expect 1 add missing more.toml
one_line
[ -e missing ] || [ -e missing.partial ] && fail "add makes a folder where no dataset is"
expect 0 add dataset more.toml
one_line
grep -q 'new or changed' "$folder/err" || fail "add says: $(cat "$folder/err")"
expect 1 add dataset more.toml
one_line
expect 0 verify dataset
expect 0 update dataset --json
grep -q '"written": 0' "$folder/out" || fail "update of what has not changed: $(cat "$folder/out")"
expect 1 remove dataset more.pgm --layer imagery
one_line
expect 0 remove dataset more.pgm --layer elevation --no-report
one_line
expect 0 verify dataset
grep -q "all 64 pages are good" "$folder/out" || fail "verify after remove says: $(cat "$folder/out")"

expect 2 export dataset --layer imagery
expect 2 export dataset --layer imagery --out a.tif --level 23
expect 2 export dataset --layer imagery --out a.tif --extent 1 2 3
expect 1 export dataset --layer roads --out a.tif
one_line
expect 1 export missing --layer imagery --out a.tif
one_line
expect 1 export dataset --layer elevation --out a.mbtiles
one_line
expect 0 export dataset --layer elevation --out a.tif --extent -10 -10 10 10 --level 0
one_line
[ -s a.tif ] || fail "no GeoTIFF"
expect 0 export dataset --layer elevation --out a.tif --extent -10 -10 10 10 --no-fill
expect 0 export dataset --layer imagery --out a.mbtiles --extent -10 -10 10 10
[ -s a.mbtiles ] || fail "no tiles"

printf 'lat,lon,name\n47.1,9.5,Here\n47.2,9.6,There\n' >places.csv
layer places vector places.csv 'features = "place"' >vectors.toml
expect 0 vectors.toml --out vectors --no-report
expect 0 query vectors --near 47.1 9.5 --within 100
grep -q '"name":"Here"' out || fail "query does not find the place: $(cat out)"
[ "$(wc -l <out)" -eq 1 ] || fail "query finds what is too far away"
expect 0 query vectors --name nowhere
[ -s out ] || [ -s err ] && fail "query finds nothing and says something"
expect 1 query vectors --layer roads
one_line
expect 1 query vectors --where 'nonsense ='
one_line
expect 1 query dataset --name here
one_line
expect 1 query missing
one_line
expect 2 query
expect 2 query vectors --near 91 0
expect 2 query vectors --within 5
expect 2 query vectors --class lake
expect 2 query vectors --extent 3 0 1 1

left=$(find . -name '*.partial' | wc -l)
[ "$left" -eq 0 ] || fail "$left partial files are left"
exit $((failures > 0))
