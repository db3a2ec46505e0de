#!/bin/bash
# Five lapses planted by device poses only: exactly those are reported, each once, and the recording replays bit for bit. Stitch 0 is whole, its knot square but
# loose, 1 is whole and not tied, 2 the bite that tears out, 3 the wide one, which goes on through the back wall.
# Usage: planted_lapses_test.sh FILUM ROOT
filum=$1 root=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() { echo "planted_lapses_test: $*"; head -c 3000 "$work"/run.json; exit 1; }
"$filum" run anastomosis-lapses --root "$root" --input demo --record "$work/lapses.filum" --json >"$work/run.json" 2>"$work/run.err" || fail "run: $(cat "$work/run.err")"
node -e '
  const d = JSON.parse(require("fs").readFileSync(process.argv[1])), s = d.stitches;
  const found = d.lapses.map((l) => l.name + " " + l.stitch).sort().join(", ");
  const wanted = "back-wall 3, loose-knot 0, unequal-spacing -1, wall-tear 2, wide-bite 3";
  const first = s.length === 4 && [0, 1].every((k) => s[k].bite_thicknesses.every((b) => b > 1 && b < 3));
  const count = (name) => d.events.filter((e) => e.name === name).length;
  const loose = first && s[0].knot === "square" && s[0].throws === 2 && count("cut") === 2 && count("thread-break") === 0;
  const torn = count("torn-out") === 1 && s[2].bite_thicknesses[0] < 1;
  if (!d.finished || d.passed || !d.verdict.includes("a demonstration does not pass") || !loose || !torn || found !== wanted || d.tissue_soundness !== 1) { console.error("found", found, "wanted", wanted, d.finished, d.passed, s); process.exit(1); }
' "$work/run.json" || fail "not exactly the lapses planted"
"$filum" replay "$work/lapses.filum" --json | grep -q '"identical": *true' || fail "replay differs"
