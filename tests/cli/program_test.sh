#!/bin/bash
# Exit codes and clear errors of the program, as a user meets them. Usage: program_test.sh FILUM
filum=$1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
failures=0

# expect CODE TEXT ARGUMENTS...: the program exits with CODE and says TEXT on stdout or stderr.
expect() {
  local code=$1 text=$2
  shift 2
  "$filum" "$@" >"$work/out" 2>"$work/err"
  local got=$?
  if [ $got -ne "$code" ] || ! cat "$work/out" "$work/err" | grep -qF -- "$text"; then
    echo "filum $*: exit $got, expected $code with \"$text\"; it said:"
    cat "$work/out" "$work/err"
    failures=$((failures + 1))
  fi
}

expect 2 "subcommand"
expect 2 "nonsense" nonsense
for name in train run replay score export list doctor; do expect 0 "Usage" $name --help; done
expect 0 '"tasks":[' list --json
expect 2 "knot-square" run no-such-task --json
expect 2 "no-such-input" run knot-square --input no-such-input --json
expect 2 "--root" run knot-square --root "$work"
echo "not a recording" >"$work/wrong"
expect 2 "$work/wrong" replay "$work/wrong" --json
expect 2 "$work/wrong" score "$work/wrong" --json
expect 2 "$work/absent" replay "$work/absent"
expect 2 "--address" train --address "no address"

[ $failures -eq 0 ] || exit 1
