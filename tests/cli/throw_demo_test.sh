#!/bin/bash
# The demonstration of the first throw, by device poses only: the thread must end as one half knot round the post, with every step recognised,
# and the recording must replay bit for bit. Usage: throw_demo_test.sh FILUM ROOT
filum=$1 root=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() { echo "throw_demo_test: $*"; head -c 3000 "$work"/run.json; exit 1; }
cd "$root" || exit 1
"$filum" run knot-throw --input demo --record "$work/throw.filum" --json >"$work/run.json" 2>"$work/run.err" || fail "run: $(cat "$work/run.err")"
node -e '
  const d = JSON.parse(require("fs").readFileSync(process.argv[1]));
  const names = d.events.map((e) => e.name);
  const missing = ["loop-formed", "end-passed", "throw-laid", "throw-tightened"].filter((n) => !names.includes(n));
  if (d.knot.class !== "overhand" || !d.finished || missing.length) { console.error(d.knot, d.finished, missing); process.exit(1); }
' "$work/run.json" || fail "not a throw"
"$filum" replay "$work/throw.filum" --json >"$work/replay.json" || fail "replay: $(cat "$work/replay.json")"
grep -q '"identical": *true' "$work/replay.json" || fail "replay differs: $(cat "$work/replay.json")"
