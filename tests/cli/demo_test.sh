#!/bin/bash
# What a task's demonstration is offered for: it finishes and reaches the points asked for.
# Usage: demo_test.sh FILUM ROOT TASK
filum=$1 root=$2 task=$3
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$filum" run "$task" --root "$root" --input demo --json >"$work/run.json" 2>"$work/run.err" || { echo "demo_test: $task: $(cat "$work/run.err")"; exit 1; }
node -e '
  const d = JSON.parse(require("fs").readFileSync(process.argv[1]));
  if (d.finished !== true || d.passed !== true) { console.error(d.task, "finished", d.finished, "passed", d.passed, JSON.stringify(d.score).slice(0, 2000)); process.exit(1); }
' "$work/run.json"
