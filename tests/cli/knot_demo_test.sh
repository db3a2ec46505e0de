#!/bin/bash
# The demonstrations of knots, by device poses only: each must be called what it is; the square knot (with needle holder or a second forceps) and the surgeon's must be cut, hold and pass,
# the square knot's recording replay bit for bit, and the granny must not pass. Usage: knot_demo_test.sh FILUM ROOT
filum=$1 root=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() { echo "knot_demo_test: $*"; head -c 3000 "$work"/run.json; exit 1; }
cd "$root" || exit 1

# tied KNOT CLASS THROWS CUTS PASSES [option ...]: runs the demonstration of KNOT and looks at what was tied.
tied() {
  local knot=$1 class=$2 throws=$3 cuts=$4 passes=$5
  shift 5
  "$filum" run "$knot" --input demo --json "$@" >"$work/run.json" 2>"$work/run.err" || fail "$knot: $(cat "$work/run.err")"
  node -e '
    const [file, wanted, throws, cuts, passes] = process.argv.slice(1);
    const d = JSON.parse(require("fs").readFileSync(file));
    const count = (name) => d.events.filter((e) => e.name === name).length;
    if (d.knot.class !== wanted || count("throw-laid") < Number(throws) || count("cut") !== Number(cuts) || String(d.passed) !== passes) { console.error(d.knot, d.events, d.passed); process.exit(1); }
  ' "$work/run.json" "$class" "$throws" "$cuts" "$passes" || fail "$knot: not $class"
}

tied knot-granny granny 2 2 false
tied knot-surgeons surgeons 2 2 true
tied knot-two-forceps square 2 2 true
tied knot-square square 2 2 true --record "$work/knot.filum"
"$filum" replay "$work/knot.filum" --json >"$work/replay.json" || fail "replay: $(cat "$work/replay.json")"
grep -q '"identical": *true' "$work/replay.json" || fail "replay differs: $(cat "$work/replay.json")"
