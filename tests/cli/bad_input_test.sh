#!/bin/bash
# What goes wrong outside: each with a clear error, the right exit code and nothing stored lost. Usage: bad_input_test.sh FILUM ROOT
filum=$1 root=$2
work=$(mktemp -d)
server=
trap '[ -z "$server" ] || kill "$server" 2>/dev/null; rm -rf "$work"' EXIT
failures=0
cat >"$work/short.yaml" <<'YAML'
format: filum-demonstration/1
title: Two hands that wait
tools:
  - tool: 0
    keys:
      - { t: "0 s", p: ["-12 mm", "0 mm", "6 mm"], handle: [-0.6, -0.5, 0.7], opening: [0, 1, 0.7], grip: "12 deg" }
      - { t: "500 ms", p: ["-11 mm", "0 mm", "6 mm"] }
YAML

# expect WHAT CODE TEXT ARGUMENTS...
expect() {
  local what=$1 code=$2 text=$3
  shift 3
  timeout 60 "$filum" "$@" >"$work/out" 2>"$work/err"
  local got=$?
  if [ $got -ne "$code" ] || ! cat "$work/out" "$work/err" | grep -qF -- "$text"; then
    echo "$what: filum $*: exit $got, expected $code with \"$text\"; it said:"
    head -c 2000 "$work/err"
    failures=$((failures + 1))
  fi
}

expect "a session to spoil" 0 "score" run knot-square --input "$work/short.yaml" --record "$work/good"
expect "sound recording" 0 '"identical":true' replay "$work/good" --json
cp "$work/good" "$work/newer"
printf '\0\0\0\143' | dd of="$work/newer" bs=1 seek=60 conv=notrunc status=none # user_version in the header of an SQLite file
expect "store of a newer version" 2 "$work/newer" replay "$work/newer" --json
head -c 20000 "$work/good" >"$work/cut"
expect "truncated recording" 2 "$work/cut" replay "$work/cut" --json
expect "recording that exists already" 2 "$work/good" run knot-square --input "$work/short.yaml" --record "$work/good"
expect "and is as it was" 0 '"identical":true' replay "$work/good" --json
expect "no such serial port" 2 "$work/none" run knot-square --input "serial:$work/none" --longest 1
sed 's/gain: 0.01 deg/gain: .nan deg/' "$root/models/forceps/default.yaml" >"$work/forceps.yaml"
expect "NaN in a calibration" 2 "forceps.yaml" run trace --input "serial:$work/none" --forceps "$work/forceps.yaml" --longest 1
head -n 12 "$root/models/forceps/default.yaml" >"$work/half.yaml"
expect "half a calibration" 2 "half.yaml" run trace --input "serial:$work/none" --forceps "$work/half.yaml" --longest 1
expect "calibration without a handle" 2 "--forceps" run trace --input demo --forceps "$work/half.yaml"
sed 's/"12 deg"/"12 furlong"/' "$work/short.yaml" >"$work/unit.yaml"
expect "unknown unit" 2 "furlong" run knot-square --input "$work/unit.yaml"
sed 's/"-12 mm"/".nan mm"/' "$work/short.yaml" >"$work/nan.yaml"
expect "NaN in a script" 2 "nan.yaml" run knot-square --input "$work/nan.yaml"
printf 'format: filum-suture/1\ntitle: no numbers\n' >"$work/model.yaml"
expect "model without numbers" 2 "model.yaml" run knot-square --input "$work/short.yaml" --model "$work/model.yaml"

mkdir "$work/viewer" && echo "<!doctype html>" >"$work/viewer/index.html"
port=$((20000 + RANDOM % 20000))
FILUM_STORE="$work/store" "$filum" train --port $port --viewer "$work/viewer" >"$work/server.out" 2>&1 &
server=$!
for _ in $(seq 100); do grep -q "http" "$work/server.out" && break; sleep 0.1; done
FILUM_STORE="$work/store" expect "port in use" 2 "$port" train --port $port --viewer "$work/viewer"
kill "$server"; wait "$server" 2>/dev/null; server=

[ $failures -eq 0 ] || exit 1
echo "bad_input_test: all as expected"
