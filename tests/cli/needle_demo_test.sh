#!/bin/bash
# The demonstration of needle loading passes with the needle taken twice and never dropped, and its recording replays bit for bit.
# Usage: needle_demo_test.sh FILUM ROOT
filum=$1 root=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() { echo "needle_demo_test: $*"; head -c 3000 "$work"/run.json; exit 1; }
"$filum" run needle-loading --root "$root" --input demo --record "$work/needle.filum" --json >"$work/run.json" 2>"$work/run.err" || fail "run: $(cat "$work/run.err")"
node -e '
  const d = JSON.parse(require("fs").readFileSync(process.argv[1])), n = d.needle;
  const held = n.held_at_share >= 0.5 && n.held_at_share <= 0.78;
  if (!d.finished || !d.passed || n.takes !== 2 || n.drops !== 0 || !held) { console.error(d.finished, d.passed, n); process.exit(1); }
' "$work/run.json" || fail "not loaded as asked for"
"$filum" replay "$work/needle.filum" --json | grep -q '"identical": *true' || fail "replay differs"
