#!/bin/bash
# The main job on real input: frames of hand pose and grip through a pseudo terminal (`--input serial:PATH`), recorded; then the recording's
# device samples through the replay device, and its steps again bit for bit. Usage: serial_run_test.sh FILUM FEEDER ROOT
# A hand takes the thread and lifts it, unhurriedly: a wire does not wait for a trainer that another process holds up. With FILUM_WHOLE_SERIAL=1 the poses of a whole run of the demonstration are sent instead (a wire has no eyes to
# look for the thread with), and must end in a square knot: for an idle machine only, since hands on a wire do not wait for a trainer that falls behind.
filum=$1 feeder=$2 root=$3
work=$(mktemp -d)
feeding=
trap '[ -z "$feeding" ] || kill "$feeding" 2>/dev/null; rm -rf "$work"' EXIT
fail() { echo "serial_run_test: $*"; cat "$work"/*.err 2>/dev/null; exit 1; }

here=$(dirname "$0")
script="$work/take.yaml"
whole=${FILUM_WHOLE_SERIAL:-0}
if [ "$whole" -eq 1 ]; then
  "$filum" run knot-square --record "$work/seen" >"$work/seen.out" 2>"$work/seen.err" || fail "the demonstration exited with $?"
  "$filum" export "$work/seen" --format csv --out "$work/seen.csv" >/dev/null 2>"$work/seen.err" || fail "its export"
  node "$here/poses_of_run.mjs" "$work/seen.csv/samples.csv" >"$script" || fail "its poses"
else
  cat >"$script" <<'YAML'
format: filum-demonstration/1
title: Take the thread and lift it
tools:
  - tool: 0
    keys:
      - { t: "0 s", p: ["-12 mm", "0 mm", "6 mm"], handle: [-0.6, -0.5, 0.7], opening: [0, 1, 0.7], grip: "12 deg" }
      - { t: "700 ms", p: ["-11.5 mm", "0.4 mm", "-0.5 mm"] }
      - { t: "1.2 s", p: ["-11.5 mm", "0.4 mm", "-0.5 mm"] }
      - { t: "2.2 s", p: ["-11.5 mm", "0.4 mm", "-0.5 mm"], grip: "-5 deg" }
      - { t: "3 s", p: ["-10 mm", "1 mm", "3 mm"] }
  - tool: 1
    keys:
      - { t: "0 s", p: ["12 mm", "0 mm", "8 mm"], handle: [0.6, -0.5, 0.7], opening: [0, 1, 0.7], grip: "12 deg" }
      - { t: "3 s", p: ["11 mm", "0 mm", "7 mm"] }
YAML
fi
longest=4
[ "$whole" -eq 0 ] || longest=60

# field FILE NAME: a value of the JSON document.
field() { node -e 'const d = JSON.parse(require("fs").readFileSync(process.argv[1])); console.log(process.argv[2].split(".").reduce((x, k) => x?.[k], d));' "$1" "$2"; }

# The handle says it was calibrated by file 42; the trainer is not given that file.
sed "s/identity: 0/identity: 42/" "$root/models/forceps/default.yaml" >"$work/handle.yaml"
(cd "$root" && exec "$feeder" "$script" --calibration "$work/handle.yaml" --link "$work/port" --drop 0.01 --flip 0.0002 --hold 1) >"$work/feeder.out" 2>"$work/feeder.err" &
feeding=$!
for _ in $(seq 100); do [ -e "$work/port" ] && break; sleep 0.1; done
[ -e "$work/port" ] || fail "the feeder opened no port"
"$filum" run knot-square --input "serial:$work/port" --record "$work/session" --longest $longest --json >"$work/live.json" 2>"$work/live.err" \
  || fail "run over the serial port exited with $?"
[ "$(field "$work/live.json" steps)" -gt 500 ] || fail "too few steps"
"$filum" export "$work/session" --format csv --out "$work/csv" >/dev/null 2>"$work/export.err" || fail "export"
samples=$(find "$work/csv" -name 'samples*.csv' -exec cat {} + | wc -l)
[ "$samples" -gt 500 ] || fail "only $samples device samples were stored"
for count in received lost corrupt; do
  [ "$(field "$work/live.json" devices.0.$count)" -gt 0 ] || fail "no count of samples $count, of a link that drops and damages some"
done
grep -q '"foreign-calibration"' "$work/live.json" || fail "the calibration of another handle is not said"
grep -rq foreign-calibration "$work/csv" || fail "nor recorded"
"$filum" replay "$work/session" --json >"$work/replay.json" 2>"$work/replay.err" || fail "replay exited with $?"
[ "$(field "$work/replay.json" identical)" = true ] || fail "the replay differs: $(cat "$work/replay.json")"
"$filum" run knot-square --input "$work/session" --longest $longest --json >"$work/device.json" 2>"$work/device.err" || fail "run of the replay device exited with $?"
for events in live device; do
  grep -q '"grasp"' "$work/$events.json" || fail "no hand took the thread ($events)"
done
if [ $whole -eq 1 ]; then
  for run in live device; do [ "$(field "$work/$run.json" knot.class)" = square ] || fail "$run: knot $(field "$work/$run.json" knot.class)"; done
fi
echo "over the serial port: $(field "$work/live.json" steps) steps, $samples samples, $(sed -n 's/.*; //p' "$work/feeder.err"); replay identical"
