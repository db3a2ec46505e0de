#!/usr/bin/env bash
# filum_camera from pictures: guided calibration by commands, calibration from a folder, what is refused.
#   guide_test.sh FILUM_CAMERA FILUM_BOARD_PICTURES
set -euo pipefail
camera=$1 pictures=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() { echo "guide_test: $*" >&2; exit 1; }
refused() { # EXIT_CODE TEXT COMMAND...
  local code=$1 text=$2 got=0
  shift 2
  "$@" >"$work/out" 2>"$work/err" || got=$?
  [[ $got -eq $code ]] || fail "exit $got instead of $code: $*"
  grep -qF -- "$text" "$work/err" || fail "no word of \"$text\": $(cat "$work/err")"
}
expect() { node -e 'const d = JSON.parse(process.argv[1]); process.exit(eval(process.argv[2]) ? 0 : 1)' "$1" "$2" || fail "$2: $1"; }

mkdir "$work/pictures"
"$pictures" "$work/pictures" >/dev/null
# The guide reads on while commands come: the first "calibrate" comes too early and is refused with the reason.
coproc guide { "$camera" guide --source "$work/pictures/view_%03d.png" --folder "$work/made" --name "test camera" 2>"$work/guide.err"; }
state=
wait_for() { # EXPRESSION
  local n
  for ((n = 0; n < 4000; ++n)); do
    IFS= read -r -t 30 state <&"${guide[0]}" || fail "the guide fell silent: $(cat "$work/guide.err")"
    node -e 'const d = JSON.parse(process.argv[1]); process.exit(eval(process.argv[2]) ? 0 : 1)' "$state" "$1" && return
  done
  fail "never: $1; last: $state"
}
echo calibrate >&"${guide[1]}"
wait_for 'd.trouble.includes("9 parts") || d.trouble.includes("4 sides")'
wait_for 'd.complete || d.state === "ended"'
expect "$state" 'd.complete && d.views >= 10 && d.wishes.every((w) => w.granted)'
[[ -s $work/made/preview.jpg ]] || fail "no picture to show"
echo calibrate >&"${guide[1]}"
wait_for 'd.state === "done"'
expect "$state" 'Math.abs(d.result.fx - 667) < 6 && d.result.residual_px < 0.3 && d.result.coverage > 0.7 && d.result.uncertainty[0] > 0'
echo "$state" | node -e 'const d = JSON.parse(require("fs").readFileSync(0)); console.log(`guide: ${d.result.views} views, fx ${d.result.fx.toFixed(1)} +- ${d.result.uncertainty[0].toFixed(1)} of 667, residual ${d.result.residual_px.toFixed(3)} px`)'
echo quit >&"${guide[1]}"
wait "$guide_PID" || fail "the guide ended badly"
grep -q 'camera: "test camera"' "$work"/made/camera-*.yaml || fail "no name in the file"

mkdir "$work/few"
cp "$work"/pictures/view_??0.png "$work/few"
"$camera" calibrate --pictures "$work/few" --square 10 --out "$work/folder.yaml" >"$work/out"
sed 's/width: 640/width: 641/' "$work/folder.yaml" >"$work/wide.yaml"
sed 's/^fx: .*/fx: -3/' "$work/folder.yaml" >"$work/negative.yaml"
# A video of another size than the calibration's is refused.
refused 2 "pictures of the size of the calibration" "$camera" track --camera "$work/wide.yaml" --source "$work/pictures/view_%03d.png" --port 18977
refused 2 "--source" "$camera" track --camera "$work/folder.yaml" --source "$work/none.avi" --port 18977
refused 2 "fx" "$camera" track --camera "$work/negative.yaml" --source 0 --port 18977
refused 2 "poses" "$camera" pivot --camera "$work/folder.yaml" --source "$work/pictures/view_%03d.png"
refused 2 "--source" "$camera" guide --source "$work/none.avi" --folder "$work/made"

# Bad arguments are bad input; help is none.
refused 2 "--side" "$camera" sheet --out "$work/sheet.svg" --side 1000
refused 2 "subcommand" "$camera"
"$camera" track --help >"$work/out" || fail "help ended with $?"

# A log is whole up to the picture at which it is ended, and the counts are told.
mkdir "$work/many"
for ((n = 0; n < 6000; ++n)); do ln -s ../pictures/marker.png "$work/many/m_$(printf %04d "$n").png"; done
rows() { if [[ -e $1 ]]; then wc -l <"$1"; else echo 0; fi; }
for signal in INT TERM; do
  log=$work/$signal.csv
  "$camera" track --camera "$work/folder.yaml" --source "$work/many/m_%04d.png" --log "$log" --port 18978 >"$work/out" 2>"$work/err" &
  tracker=$!
  for ((n = 0; n < 300 && $(rows "$log") < 4; ++n)); do sleep 0.1; done
  kill -"$signal" "$tracker"
  code=0
  wait "$tracker" || code=$?
  [[ $code -eq 0 ]] || fail "ended by $signal with $code: $(cat "$work/err")"
  [[ $(rows "$log") -lt 6001 ]] || fail "$signal was not heard"
  poses=$(sed -n 's/^[0-9]* pictures, \([0-9]*\) poses.*/\1/p' "$work/out")
  [[ $poses -gt 0 && $(rows "$log") -eq $((poses + 1)) ]] || fail "$signal: $(rows "$log") lines of \"$poses\" poses: $(cat "$work/out")"
  [[ $(tail -1 "$log" | tr -cd , | wc -c) -eq 31 ]] || fail "$signal: the last line is cut: $(tail -1 "$log")"
done
# A full disk is a failure, and told.
full() { (trap '' XFSZ; ulimit -f 4; exec "$camera" track --camera "$work/folder.yaml" --source "$work/many/m_%04d.png" --log "$work/full.csv" --port 18978); }
refused 1 "space left" full
echo "guide_test: all as expected"
