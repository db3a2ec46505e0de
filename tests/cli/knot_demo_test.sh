#!/bin/bash
# The demonstration of a square knot, by device poses only: it must be called a square knot, with every step recognised, both ends cut and the
# knot pulled, and the recording must replay bit for bit. That of the granny must be called a granny and not pass. Usage: knot_demo_test.sh FILUM ROOT
filum=$1 root=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() { echo "knot_demo_test: $*"; head -c 3000 "$work"/run.json; exit 1; }
cd "$root" || exit 1
"$filum" run knot-square --input demo --record "$work/knot.filum" --json >"$work/run.json" 2>"$work/run.err" || fail "run: $(cat "$work/run.err")"
node -e '
  const d = JSON.parse(require("fs").readFileSync(process.argv[1]));
  const count = (name) => d.events.filter((e) => e.name === name).length;
  const wanted = { "loop-formed": 2, "end-passed": 2, "throw-laid": 2, "throw-tightened": 2, cut: 2 };
  const short = Object.entries(wanted).filter(([name, n]) => count(name) < n);
  if (d.knot.class !== "square" || !d.finished || !d.passed || short.length) { console.error(d.knot, d.finished, d.passed, short); process.exit(1); }
' "$work/run.json" || fail "not a square knot"
"$filum" replay "$work/knot.filum" --json >"$work/replay.json" || fail "replay: $(cat "$work/replay.json")"
grep -q '"identical": *true' "$work/replay.json" || fail "replay differs: $(cat "$work/replay.json")"
"$filum" run knot-granny --input demo --json >"$work/run.json" 2>"$work/run.err" || fail "granny: $(cat "$work/run.err")"
node -e '
  const d = JSON.parse(require("fs").readFileSync(process.argv[1]));
  if (d.knot.class !== "granny" || d.passed) { console.error(d.knot, d.passed); process.exit(1); }
' "$work/run.json" || fail "not a granny"
