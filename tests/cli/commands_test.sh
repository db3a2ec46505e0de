#!/bin/bash
# Every command that needs no device, once on something small: a session of a second is run, recorded, replayed, scored, exported and analysed.
# Usage: commands_test.sh FILUM ROOT
filum=$1 root=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
failures=0
fail() { echo "commands_test: $*"; failures=$((failures + 1)); }

# json CALL... : runs it; then `check EXPRESSION` looks at the document as d.
json() { what="$*"; "$filum" "$@" >"$work/out" 2>"$work/err" || fail "$what: exit $?, $(head -c 500 "$work/err")"; }
check() { node -e 'const d = JSON.parse(require("fs").readFileSync(process.argv[1])); if (!eval(process.argv[2])) process.exit(1)' "$work/out" "$1" || fail "$what: not $1 in $(head -c 700 "$work/out")"; }

cat >"$work/second.yaml" <<'SCRIPT'
format: filum-demonstration/1
title: One second
tools:
  - tool: 1
    keys:
      - { t: 0 s, p: [8 mm, 0 mm, 8 mm], handle: [0.6, -0.4, 0.7], opening: [0, 1, 0.6], grip: 12 deg }
      - { t: 1 s, p: [5 mm, 1 mm, 4 mm], grip: 0 deg, stop: true }
SCRIPT
json run needle-loading --root "$root" --input "$work/second.yaml" --record "$work/one.filum" --json
check 'd.task === "needle-loading" && !d.finished && d.needle.takes === 0'
json replay "$work/one.filum" --json
check 'd.identical && d.first_difference === null && d.steps > 400'
json score "$work/one.filum" --json
check 'd.needle.takes === 0'
json export "$work/one.filum" --format csv --out "$work/csv"
[ "$(find "$work/csv" -name '*.csv' | wc -l)" -ge 1 ] || fail "export wrote no table"
json analyse "$work/one.filum" --json
check 'Object.keys(d).length > 0'
json list --json --root "$root"
check 'd.tasks.some((t) => t.name === "needle-course") && d.rigs.length === 8'
what=doctor; "$filum" doctor --json --root "$root" >"$work/out" 2>"$work/err" || [ $? -eq 1 ] || fail "doctor: $(cat "$work/err")"  # 1: a slow machine
check 'd.checks.length > 5 && d.checks.every((c) => typeof c.detail === "string")'
json validate --json track-friction
check 'd.problems.length > 0 && d.problems.every((p) => p.passed)'
json bench --json --root "$root" --wild 2 --wild-seconds 0.02 grasp-transfer
check 'd.wild[0].seeds === 2 && d.wild[0].faults.length === 0'
[ $failures -eq 0 ] || exit 1
