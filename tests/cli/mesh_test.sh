#!/bin/bash
# filum mesh hands over to the program beside it: every word as it was typed, its exit code, its help; and says what to install
# where that program is not built. Usage: mesh_test.sh FILUM
set -u
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
failures=0
fail() { echo "mesh_test: $*"; failures=$((failures + 1)); }
cp "$1" "$work/filum"

"$work/filum" mesh scan.nii --out region >"$work/out" 2>"$work/err"
[ $? -eq 1 ] || fail "without its program: exit $?"
grep -q 'libcgal-dev' "$work/err" || fail "does not say what to install: $(cat "$work/err")"

cat >"$work/filum_mesh" <<'STUB'
#!/bin/bash
printf '[%s]' "$@"
exit 42
STUB
chmod +x "$work/filum_mesh"
for words in "'a scan.nii' --at -45,40,45 --json" "--help" "--no-such-option" "--radius '30 '"; do
  eval "set -- $words"
  out=$("$work/filum" mesh "$@" 2>&1)
  [ $? -eq 42 ] || fail "mesh $words: not the program's own exit code"
  [ "$out" = "$(printf '[%s]' "$@")" ] || fail "mesh $words: passed on as $out"
done
exit $((failures > 0))
