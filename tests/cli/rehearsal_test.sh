#!/bin/bash
# A rehearsal that goes on from a state in its midst ends in the state of a run from the start, bit for bit, and refuses a script that looks elsewhere or moves otherwise before it.
# Usage: rehearsal_test.sh FILUM REHEARSAL ROOT
filum=$(realpath "$1") rehearsal=$(realpath "$2") root=$(realpath "$3")
script=$root/curricula/artery-knot/demonstration.yaml
work=$(mktemp -d)
trap 'for pipe in first_*; do [ -p "$pipe" ] && echo quit >"$pipe"; done; rm -rf "$work"' EXIT
cd "$work" || exit 1
fail() { echo "rehearsal_test: $*"; tail -n 3 ./*.out; exit 1; }
hash_of() { grep -o '"why":"end".*' "$1" | sed 's/.*"hash":"\([0-9a-f]*\)".*/\1/'; }
"$rehearsal" "$root" artery-knot "$script" first 4 3 >first.out || fail "first"
echo "go again $script 4" >first_3.0
grep -v "at: { needle" "$script" >other.yaml
for _ in $(seq 200); do grep -qs '^done' again.out && break; sleep 0.1; done
[ -n "$(hash_of again.out)" ] && [ "$(hash_of again.out)" = "$(hash_of first.out)" ] || fail "another state"
whole=$("$filum" run artery-knot --root "$root" --input demo --longest 4 --json | sed 's/.*"state_hash": *"\([0-9a-f]*\)".*/\1/')
[ "$(hash_of first.out)" = "$whole" ] || fail "not the state of filum run: $whole"
echo "go other $PWD/other.yaml 4" >first_3.0
for _ in $(seq 200); do grep -qs '^done' other.out && break; sleep 0.1; done
grep -q "^failed: .*up to there" other.out || fail "took a script that had looked elsewhere"
sed '0,/"0.8219 mm"/s//"0.7219 mm"/' "$script" >moved.yaml
cmp -s "$script" moved.yaml && fail "no key to move"
echo "go moved $PWD/moved.yaml 4" >first_3.0
for _ in $(seq 200); do grep -qs '^done' moved.out && break; sleep 0.1; done
grep -q "^failed: .*up to there" moved.out || fail "took a script that had moved otherwise"
