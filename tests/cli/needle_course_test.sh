#!/bin/bash
# The first three eyes of the needle course, by device poses and grip only: the needle in at the ring and out at the square, handed from the holder
# to the forceps and back; holes within 0.2 mm of their marks on average, the needle never dropped, the thread whole; the recording replays bit for bit.
# Usage: needle_course_test.sh FILUM ROOT
filum=$1 root=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() { echo "needle_course_test: $*"; head -c 3000 "$work"/run.json; exit 1; }
"$filum" run needle-course --root "$root" --input "$root/tests/cli/needle_course_eyes.yaml" --record "$work/eyes.filum" --json >"$work/run.json" 2>"$work/run.err" || fail "run: $(cat "$work/run.err")"
node -e '
  const d = JSON.parse(require("fs").readFileSync(process.argv[1])), n = d.needle;
  const count = (name) => d.events.filter((e) => e.name === name).length;
  const eyes = count("goal-done") - 1;  // the first goal is to take the needle
  if (eyes !== 3 || n.takes !== 5 || n.drops !== 0 || !(n.present_error_m < 0.2e-3) || count("thread-break") !== 0) { console.error(eyes, n); process.exit(1); }
' "$work/run.json" || fail "not three eyes"
"$filum" replay "$work/eyes.filum" --json | grep -q '"identical": *true' || fail "replay differs"
