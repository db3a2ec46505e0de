#!/usr/bin/env bash
# The laboratory end to end: demonstration, recording, replay, analysis, export, calibration; and what is refused.
#   laboratory_test.sh FILUM_PROGRAM
set -euo pipefail
filum=$1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

fail() {
  echo "FAILED: $*" >&2
  exit 1
}
# expect JSON_FILE EXPRESSION: a JavaScript expression over `d`
expect() {
  node -e 'const d = JSON.parse(require("fs").readFileSync(process.argv[1])); process.exit(eval(process.argv[2]) ? 0 : 1)' "$1" "$2" ||
    fail "$1: $2"
}
# refused EXIT_CODE COMMAND...
refused() {
  local code=$1 got=0
  shift
  "$@" >refused.out 2>refused.err || got=$?
  [[ $got -eq $code ]] || fail "exit $got instead of $code: $*"
}

"$filum" list --json >list.json
for task in tip-hold trace grasp-transfer; do expect list.json "d.tasks.some((t) => t.name === '$task' && t.curriculum === 'research')"; done
expect list.json "d.curricula.includes('research')"

for task in trace grasp-transfer; do
  "$filum" run "$task" --input demo --record "$task.rec" --json >"$task.json"
  expect "$task.json" "d.finished && d.passed && d.score.total > 80"
  "$filum" replay "$task.rec" --json >replay.json
  expect replay.json "d.identical"
  "$filum" analyse "$task.rec" --json >analysis.json
  expect analysis.json "Array.isArray(d.tremor) && Array.isArray(d.smoothness) && Array.isArray(d.grasp_force)"
  expect analysis.json "d.settings.segment_s === 4 && d.derived_with.startsWith('filum')"
done
expect grasp-transfer.json "d.events.filter((e) => e.name === 'object-placed').length === 3"
# The demonstration's made-up tremor: 40 um rms at 9 Hz.
"$filum" analyse trace.rec --json >analysis.json
expect analysis.json "Math.abs(d.tremor[0].bands[1].rms_m - 40e-6) < 4e-6 && Math.abs(d.tremor[0].peak_hz - 9) < 0.6"
# 0.05 N hold an object; the demonstration squeezes with 0.10 to 0.15 N.
"$filum" analyse grasp-transfer.rec trace.rec --plot plot.svg --page page.html --json >analysis.json
expect analysis.json "d.grasp_force[0].grasps === 3 && Math.abs(d.grasp_force[0].summary.excess_over_slip_limit_n.median - 0.07) < 0.01"
expect analysis.json "d.sessions.length === 2"
grep -q '</svg>' plot.svg || fail "no plot"
grep -q 'noise floor' page.html || fail "no page"

"$filum" export trace.rec --format bids --out bids --json >files.json
expect files.json "d.files.length > 10 && d.files.some((f) => f.endsWith('tracksys-hand0_motion.tsv'))"

# Whatever is derived, a recording stays as it is.
sha256sum trace.rec grasp-transfer.rec >before.sum
"$filum" export trace.rec --format csv --out csv >/dev/null
"$filum" export trace.rec --format hdf5 --out hdf5 >/dev/null
"$filum" score trace.rec --json >score.json
"$filum" analyse trace.rec --clamped trace.rec --json >analysis.json
sha256sum --check --quiet before.sum || fail "a recording was changed by what was derived from it"
grep -q '512 force saturated' csv/*dictionary* || fail "the dictionary does not tell the faults of a handle"

# Calibration from readings: a line is fitted and used; a sensor that does not repeat is refused.
{
  echo "format: filum-calibration-points/1"
  for channel in "angle deg 5" "force N 0.5"; do
    read -r name unit step <<<"$channel"
    echo "$name:"
    for way in upwards downwards; do
      for k in 0 1 2 3 4 5; do
        for repeat in 0 1; do
          count=$((500 + 500 * k + repeat))
          echo "  - { value: $(node -p "$k * $step") $unit, count: $count count, noise: 1 count, approached: $way }"
        done
      done
    done
  done
} >points.yaml
"$filum" calibrate forceps --points points.yaml --out forceps.yaml --sensor SN-1 --json >calibration.json
expect calibration.json "d.good && Math.abs(d.force.gain - 0.001) < 1e-5 && d.angle.hysteresis < 1e-3"
grep -q 'sensor: "SN-1"' forceps.yaml || fail "no sensor in the file"
refused 2 "$filum" calibrate forceps --points points.yaml --out forceps.yaml
sed 's/count: 1500 count/count: 2900 count/' points.yaml >bent.yaml
refused 1 "$filum" calibrate forceps --points bent.yaml --out bent-forceps.yaml
[[ ! -e bent-forceps.yaml ]] || fail "a refused calibration was written"
refused 2 "$filum" calibrate forceps --out x.yaml
refused 2 "$filum" analyse points.yaml
refused 2 "$filum" analyse nothing.rec
refused 2 "$filum" run trace --input haptic:nonsense
refused 2 "$filum" run trace --input igtl:99999
echo "all as it should be"
