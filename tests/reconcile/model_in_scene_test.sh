#!/bin/bash
# From measurement to trainer: a relaxing block is reconciled, the model it writes changes a retraction as measured, is stored in the
# recording and replayed; switched off it changes nothing; what a scene cannot show is refused. Usage: model_in_scene_test.sh FILUM ROOT
filum=$1 root=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() { echo "$1"; exit 1; }

source "$root/tests/reconcile/make_block.sh"
make_block "$work/block" 0.5 2 500 1 "a:1:A b:1:A c:4:B d:4:B"
"$filum" reconcile "$work/block" --out "$work/out" --json >"$work/report.json" || fail "reconcile failed: $(cat "$work/report.json")"
grep -q '"name":"viscoelastic-relaxation"' "$work/report.json" || fail "not named: $(head -c 600 "$work/report.json")"
[ -f "$work/out/model.yaml" ] || fail "no model.yaml"

field() { python3 -c 'import json,sys; d=json.load(open(sys.argv[1])); print(eval("d"+sys.argv[2]))' "$1" "$2"; }
run() { "$filum" run press-to-target --input demo --longest 12 --json "${@:2}" >"$work/$1.json" || fail "run $1 failed"; }
run plain
run measured --model "$work/out/model.yaml" --record "$work/measured.rec"
sed 's/on: true/on: false/; s/^rig:/on: false\nrig:/' "$work/out/model.yaml" >"$work/off.yaml"
run off --model "$work/off.yaml"
[ "$(field "$work/plain.json" '["state_hash"]')" = "$(field "$work/off.json" '["state_hash"]')" ] || fail "a model that is off changes the scene"
[ "$(field "$work/plain.json" '["state_hash"]')" != "$(field "$work/measured.json" '["state_hash"]')" ] || fail "the model changes nothing"
python3 - "$work/plain.json" "$work/measured.json" <<'PY' || fail "peak pressure does not follow the measured modulus"
import json, sys
plain, measured = (json.load(open(f))["pressure"]["peak_mmhg"] for f in sys.argv[1:])
print("peak pressure", plain, "->", measured, "mmHg")
sys.exit(not 0.3 * plain < measured < 0.72 * plain)  # 2.0 kPa of 2.9 kPa, less what relaxes on the way in
PY
"$filum" replay "$work/measured.rec" --json | grep -q '"identical":true' || fail "the recording with the model does not replay"

"$filum" run knot-throw --input demo --model "$work/out/model.yaml" --json 2>"$work/err" >"$work/text" && fail "a thread took a model of tissue"
cat "$work/err" "$work/text" | grep -q "suture-cantilever" || fail "unclear refusal: $(cat "$work/err")"
"$filum" train --port 0 --model "$work/block/experiment.yaml" 2>"$work/err" >&2 && fail "train took an experiment for a model"
grep -q -- "--model" "$work/err" || fail "unclear refusal of train: $(cat "$work/err")"
exit 0
