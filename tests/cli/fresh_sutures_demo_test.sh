#!/bin/bash
# A demonstration of several stitches, each with a fresh suture and at its own turn of the clamp, by device poses and buttons only: all tied with square knots that stay
# when their ends are cut, none torn, every end cut, the join leaks less than MOST ml/min in all, and the recording is replayed bit for bit. Usage: fresh_sutures_demo_test.sh FILUM ROOT TASK STITCHES MOST
filum=$1 root=$2 task=$3 stitches=$4 most=$5
if [ "${FILUM_WHOLE_STITCHES:-0}" = 0 ]; then
  echo "SKIPPED: minutes for each stitch; FILUM_WHOLE_STITCHES=1 sews and ties them all"
  exit 77
fi
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() { echo "fresh_sutures_demo_test: $*"; head -c 3000 "$work"/run.json; exit 1; }
"$filum" run "$task" --root "$root" --input demo --record "$work/run.filum" --json >"$work/run.json" 2>"$work/run.err" || fail "run: $(cat "$work/run.err")"
node -e '
  const d = JSON.parse(require("fs").readFileSync(process.argv[1])), s = d.stitches, n = Number(process.argv[2]);
  const count = (name) => d.events.filter((e) => e.name === name).length;
  const tied = s.length === n && s.every((k) => k.knot === "square" && k.throws === 2 && k.tail_mm > 0.3 && k.tail_mm < 3);
  const clean = count("cut") === 2 * n && count("tear") === 0 && count("thread-break") === 0 && count("stitch-out-of-turn") === 0 && count("suture-fresh") === n - 1;
  if (!d.finished || !d.passed || !tied || !clean || !(d.leak.total_ml_per_min < Number(process.argv[3]))) { console.error(d.finished, d.passed, s, d.leak, d.events); process.exit(1); }
' "$work/run.json" "$stitches" "$most" || fail "not the stitches asked for"
"$filum" replay "$work/run.filum" >"$work/replay.out" 2>&1 || fail "replay: $(cat "$work/replay.out")"
