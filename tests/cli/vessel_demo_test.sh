#!/bin/bash
# The demonstration of a stitch in a vessel: both walls in full thickness, outside-in then inside-out, no lapse, the leak of the open join by
# sector; its recording replays bit for bit.
# Usage: vessel_demo_test.sh FILUM ROOT
filum=$1 root=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() { echo "vessel_demo_test: $*"; head -c 3000 "$work"/run.json; exit 1; }
"$filum" run vessel-stitch --root "$root" --input demo --record "$work/stitch.filum" --json >"$work/run.json" 2>"$work/run.err" || fail "run: $(cat "$work/run.err")"
node -e '
  const d = JSON.parse(require("fs").readFileSync(process.argv[1])), s = d.stitches, l = d.leak;
  const stitch = s.length === 1 && s[0].depth_share > 0.999 && s[0].bite_thicknesses.every((b) => b > 1 && b < 3);
  const sum = l.per_sector.reduce((a, b) => a + b, 0);
  const leak = l.per_sector.length === 8 && Math.abs(sum - l.total_ml_per_min) < 1e-6 * sum && sum > 0;
  if (!d.finished || !d.passed || !stitch || d.lapses.length !== 0 || !leak || d.tissue_soundness !== 1) { console.error(d.finished, d.passed, s, d.lapses, l); process.exit(1); }
' "$work/run.json" || fail "not the stitch asked for"
"$filum" replay "$work/stitch.filum" --json | grep -q '"identical": *true' || fail "replay differs"
