#!/bin/sh
# belvedere-dis keeps its promises to scripts: exit codes, and where output goes. usage: command_line_test.sh PROGRAM
program=$1
folder=$(mktemp -d) || exit 1
trap 'rm -rf "$folder"' EXIT
failures=0

# expect CODE ARGUMENT...: runs the program, checks its exit code; leaves its output in out and err
expect() {
  wanted=$1
  shift
  "$program" "$@" >"$folder/out" 2>"$folder/err"
  code=$?
  if [ $code -ne "$wanted" ]; then
    echo "belvedere-dis $*: exit code $code, not $wanted"
    failures=$((failures + 1))
  fi
}

# one_line: the last command said one line on standard error and nothing on standard output
one_line() {
  if [ -s "$folder/out" ] || [ "$(wc -l <"$folder/err")" -ne 1 ]; then
    echo "not one line on standard error alone:" && cat "$folder/out" "$folder/err"
    failures=$((failures + 1))
  fi
}

expect 0 --help
expect 0 --version
grep -q '^belvedere-dis [0-9]' "$folder/out" || { echo "--version prints no version"; failures=$((failures + 1)); }
for command in decode extrapolate traffic listen record replay; do expect 0 $command --help; done
expect 2
expect 2 nonsense
expect 2 decode
expect 2 traffic
expect 2 listen 127.0.0.1:43500 --seconds -1
expect 1 decode "$folder/none.pcap" && one_line
expect 1 extrapolate "$folder/none.csv" && one_line
expect 1 listen 127.0.0.1 --seconds 1 && one_line
expect 1 listen 203.0.113.77:43500 --seconds 1 && one_line
expect 1 traffic --to 127.0.0.1:43500 --scenario atlantis --seconds 1 && one_line
expect 1 record --listen 127.0.0.1:43500 --out "$folder/none/x.pcap" --seconds 1 && one_line

: >"$folder/empty.bin"
expect 0 decode "$folder/empty.bin"
grep -q '"rejected":"header shorter' "$folder/out" || { echo "an empty datagram is not rejected"; failures=$((failures + 1)); }

printf 'id,drm,x0,y0,z0,psi0_rad,theta0_rad,phi0_rad,vx,vy,vz,ax,ay,az,wx,wy,wz,dt_s\na,2,1,2,3,0,0,0,10,0,0,0,0,0,0,0,0,2\n' >"$folder/v.csv"
expect 0 extrapolate "$folder/v.csv"
[ "$(tail -n 1 "$folder/out")" = "a,21,2,3,0,0,0,10,0,0" ] || { echo "extrapolate:" && cat "$folder/out"; failures=$((failures + 1)); }

exit $failures
