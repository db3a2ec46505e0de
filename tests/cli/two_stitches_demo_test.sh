#!/bin/bash
# The demonstration of two stitches across from each other on one thread, by device poses only: both tied with square knots that stay when their
# ends are cut, the first one still drawn when the second is done, no torn wall, no broken thread, and a join that leaks less than 2 ml/min in every sector (with
# nothing tied 13 to 20); the recording is replayed bit for bit. Usage: two_stitches_demo_test.sh FILUM ROOT
filum=$1 root=$2
if [ "${FILUM_WHOLE_STITCHES:-0}" = 0 ]; then
  echo "SKIPPED: four minutes and more; FILUM_WHOLE_STITCHES=1 sews and ties both"
  exit 77
fi
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() { echo "two_stitches_demo_test: $*"; head -c 3000 "$work"/run.json; exit 1; }
"$filum" run artery-two-stitches --root "$root" --input demo --record "$work/run.filum" --json >"$work/run.json" 2>"$work/run.err" || fail "run: $(cat "$work/run.err")"
node -e '
  const d = JSON.parse(require("fs").readFileSync(process.argv[1])), s = d.stitches;
  const count = (name) => d.events.filter((e) => e.name === name).length;
  const tied = s.length === 2 && s.every((k) => k.knot === "square" && k.throws === 2 && k.tail_mm > 0.3 && k.tail_mm < 3 && k.slack_mm < 1.6);
  const clean = count("cut") === 4 && count("tear") === 0 && count("thread-break") === 0 && count("stitch-out-of-turn") === 0;
  const drawn = d.leak.per_sector.length === 8 && d.leak.per_sector.every((q) => q < 2);
  if (!d.finished || !d.passed || !tied || !clean || !drawn) { console.error(d.finished, d.passed, s, d.leak, d.events); process.exit(1); }
' "$work/run.json" || fail "not the stitches asked for"
"$filum" replay "$work/run.filum" >"$work/replay.out" 2>&1 || fail "replay: $(cat "$work/replay.out")"
