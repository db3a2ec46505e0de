#!/bin/bash
# The demonstration of the badly placed retractor: put in askew by somebody else, taken from its arm, laid anew, left on its arm;
# recorded, replayed bit for bit, scored the same again; with tissue half as stiff the pressure is lower.
# Usage: brain_demo_test.sh FILUM ROOT
filum=$1 root=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() { echo "brain_demo_test: $*"; cat "$work"/*.err "$work"/run.json 2>/dev/null | head -c 3000; exit 1; }
"$filum" run retractor-correction --root "$root" --input demo --record "$work/brain" --json >"$work/run.json" 2>"$work/run.err" || fail "run"
"$filum" run retractor-correction --root "$root" --input demo --stiffness 0.5 --longest 5 --record "$work/soft" --json >"$work/soft.json" 2>"$work/soft.err" || fail "run of soft tissue"
"$filum" replay "$work/brain" --json 2>"$work/replay.err" | grep -q '"identical": *true' || fail "replay differs"
"$filum" replay "$work/soft" --json 2>"$work/replay.err" | grep -q '"identical": *true' || fail "replay of soft tissue differs"
"$filum" score "$work/brain" --json >"$work/score.json" 2>"$work/score.err" || fail "score"
node -e '
  const [run, soft, score] = process.argv.slice(1).map((f) => JSON.parse(require("fs").readFileSync(f)));
  const names = run.events.map((e) => e.name), p = run.pressure;
  const arm = names.filter((n) => n.startsWith("arm-")).join();
  const same = JSON.stringify(score.score.items.map((i) => i.points)) === JSON.stringify(run.score.items.map((i) => i.points));
  if (!run.finished || !run.passed || arm !== "arm-freed,arm-locked" || p.hold_peak_mmhg >= 20 || p.exposed < 0.7 || p.peak_mmhg < 1.5 * p.hold_peak_mmhg || !same ||
      soft.pressure.peak_mmhg > 0.7 * p.peak_mmhg) { console.error(run.finished, run.passed, arm, p, soft.pressure, same); process.exit(1); }
' "$work/run.json" "$work/soft.json" "$work/score.json" || fail "not as it should be"
