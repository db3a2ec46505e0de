#!/bin/bash
# A stitch as it should be, then one with lapses planted by device poses only: exactly those are reported, and the recording replays bit for bit.
# Both walls that the second needle goes through count as bites of their own, so a wide bite is reported for each (stitches 1 and 2, from 0).
# Usage: planted_lapses_test.sh FILUM ROOT
filum=$1 root=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() { echo "planted_lapses_test: $*"; head -c 3000 "$work"/run.json; exit 1; }
"$filum" run vessel-lapses --root "$root" --input demo --record "$work/lapses.filum" --json >"$work/run.json" 2>"$work/run.err" || fail "run: $(cat "$work/run.err")"
node -e '
  const d = JSON.parse(require("fs").readFileSync(process.argv[1])), s = d.stitches;
  const found = d.lapses.map((l) => l.name + " " + l.stitch).sort().join(", ");
  const wanted = "back-wall 1, unequal-spacing -1, wide-bite 1, wide-bite 2";
  const first = s.length === 3 && s[0].bite_thicknesses.every((b) => b > 1 && b < 3);
  if (!d.finished || d.passed || !first || found !== wanted || d.tissue_soundness !== 1) { console.error("found", found, "wanted", wanted, d.finished, d.passed, s); process.exit(1); }
' "$work/run.json" || fail "not exactly the lapses planted"
"$filum" replay "$work/lapses.filum" --json | grep -q '"identical": *true' || fail "replay differs"
