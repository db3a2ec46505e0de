#!/bin/bash
# The demonstration of one stitch with its whole knot, by device poses only: a square knot that holds both bites and stays when both ends are
# cut, no torn wall, no broken thread, the edges drawn together beside it (less than a tenth of the leak is in its two sectors); the recording of
# stitch-knot, which stands for them all, replays bit for bit. Usage: stitch_knot_demo_test.sh FILUM ROOT TASK
filum=$1 root=$2 task=$3
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() { echo "stitch_knot_demo_test: $*"; head -c 3000 "$work"/run.json; exit 1; }
"$filum" run "$task" --root "$root" --input demo --record "$work/knot.filum" --json >"$work/run.json" 2>"$work/run.err" || fail "run: $(cat "$work/run.err")"
node -e '
  const d = JSON.parse(require("fs").readFileSync(process.argv[1])), s = d.stitches;
  const count = (name) => d.events.filter((e) => e.name === name).length;
  const tied = s.length === 1 && s[0].knot === "square" && s[0].throws === 2 && s[0].tail_mm > 0.3 && s[0].tail_mm < 3;
  const clean = count("cut") === 2 && count("tear") === 0 && count("thread-break") === 0;
  const drawn = d.leak.per_sector[1] + d.leak.per_sector[2] < 0.1 * d.leak.total_ml_per_min && s[0].slack_mm < 1.6;
  if (!d.finished || !d.passed || !tied || !clean || !drawn) { console.error(d.finished, d.passed, s, d.leak, d.events); process.exit(1); }
' "$work/run.json" || fail "not the knot asked for"
[ "$task" != stitch-knot ] || "$filum" replay "$work/knot.filum" --json | grep -q '"identical": *true' || fail "replay differs"
