#!/bin/bash
# filum reconcile as a user calls it: what is printed where, exit codes, one dataset or many, what is refused. Usage: reconcile_command_test.sh FILUM ROOT
filum=$1 root=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
failures=0
fail() { echo "reconcile_command_test: $*"; failures=$((failures + 1)); }

source "$root/tests/reconcile/make_block.sh"
make_block "$work/data/relaxes" 0.4 4
make_block "$work/data/firm" 0 4

# call CODE ARGUMENTS...: runs it
call() {
  local code=$1
  shift
  timeout 120 "$filum" reconcile "$@" --root "$root" >"$work/out" 2>"$work/err"
  local got=$?
  [ $got -eq "$code" ] || fail "reconcile $*: exit $got, expected $code: $(head -c 400 "$work/err")"
}
says() { grep -qF -- "$1" "$work/out" "$work/err" || fail "nothing said of \"$1\": $(head -c 400 "$work/out" "$work/err")"; }

call 0 "$work/data/relaxes" --out "$work/one"
says "relaxes: effect viscoelastic-relaxation"
grep -q '#' "$work/err" && fail "a progress bar where nobody looks: $(head -c 200 "$work/err")"
for file in report.json report.html model.yaml; do [ -s "$work/one/$file" ] || fail "no $file"; done
call 0 "$work/data/relaxes/" --out "$work/one" --json
node -e 'const d = JSON.parse(require("fs").readFileSync(process.argv[1])), f = JSON.parse(require("fs").readFileSync(process.argv[2]))
  if (d.format !== "filum-reconcile/1" || d.dataset !== "relaxes" || d.effects[0].name !== f.effects[0].name) process.exit(1)' "$work/out" "$work/one/report.json" || fail "--json does not hold the report: $(head -c 300 "$work/out")"
call 0 "$work/data/firm" --out "$work/one"
says "firm: agree"
[ -e "$work/one/model.yaml" ] && fail "the model of the dataset before is still there"
ls "$work/one" | grep -q part && fail "a half-written file is left"

# the same bytes, whatever the threads
call 0 "$work/data/relaxes" --out "$work/t1" --repeatable --threads 1
call 0 "$work/data/relaxes" --out "$work/t3" --repeatable --threads 3
diff -r "$work/t1" "$work/t3" >"$work/diff" || fail "threads change the report: $(head -c 300 "$work/diff")"

# many: a bad one is named and the others are solved; finished ones are left alone unless asked for
make_block "$work/data/bad" 0 4
sed -i 's/^0.0400,/0.0100,/' "$work/data/bad/b.csv"
mkdir "$work/data/no-dataset"
call 2 --all "$work/data" --out "$work/many"
says "bad/b.csv:4: column t"
says "firm: agree"
[ "$(find "$work/many" -name report.json | wc -l)" = 2 ] || fail "two of three should have a report"
stamp=$(stat -c %y "$work/many/firm/report.json")
rm -r "$work/data/bad"
call 0 --all "$work/data" --out "$work/many"
[ "$stamp" = "$(stat -c %y "$work/many/firm/report.json")" ] || fail "a finished one was done again"
call 0 --all "$work/data" --out "$work/many" --again
[ "$stamp" = "$(stat -c %y "$work/many/firm/report.json")" ] && fail "--again did nothing"

# what it is asked wrongly
call 2 --out "$work/x"
says "one folder, or --all FOLDER"
call 2 "$work/data/firm" --all "$work/data" --out "$work/x"
call 2 "$work/none" --out "$work/x"
says "a folder with experiment.yaml"
call 2 "$work/data/no-dataset" --out "$work/x"
says "no-dataset/experiment.yaml"
call 2 --all "$work/data/firm/a.csv" --out "$work/x"
says "a folder of datasets"
[ -e "$work/x" ] && fail "something was written for nothing"
[ $failures -eq 0 ] || exit 1
echo "reconcile_command_test: all as it should be"
