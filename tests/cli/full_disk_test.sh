#!/bin/bash
# A disk that fills up while a session is recorded or exported or a store is opened, and a file system that cannot be written. They are mounted for
# the test; where that is not allowed it is skipped, and says why. Usage: full_disk_test.sh FILUM ROOT
filum=$1 root=$2
work=$(mktemp -d)
trap 'umount "$work/full" "$work/small" 2>/dev/null; rm -rf "$work"' EXIT
cd "$root" || exit 1
mkdir "$work/full" "$work/small" "$work/viewer"
echo "<!doctype html>" >"$work/viewer/index.html"
[ "$(id -u)" -eq 0 ] || { echo "SKIPPED: only root may mount a small file system: full disk and read-only file system not tried"; exit 77; }
mount -t tmpfs -o size=64k tmpfs "$work/small" 2>"$work/err" || { echo "SKIPPED: no file system can be mounted here ($(cat "$work/err")): full disk and read-only file system not tried"; exit 77; }

cat >"$work/short.yaml" <<'YAML'
format: filum-demonstration/1
title: Two hands that wait
tools:
  - tool: 0
    keys:
      - { t: "0 s", p: ["-12 mm", "0 mm", "6 mm"], handle: [-0.6, -0.5, 0.7], opening: [0, 1, 0.7], grip: "12 deg" }
      - { t: "500 ms", p: ["-11 mm", "0 mm", "6 mm"] }
YAML
failures=0
# expect WHAT CODE TEXT ARGUMENTS...
expect() {
  local what=$1 code=$2 text=$3
  shift 3
  timeout 60 "$filum" "$@" >"$work/out" 2>"$work/err"
  local got=$?
  if [ $got -ne "$code" ] || ! cat "$work/out" "$work/err" | grep -qF -- "$text"; then
    echo "$what: filum $*: exit $got, expected $code with \"$text\"; it said:"
    head -c 2000 "$work/err"
    failures=$((failures + 1))
  fi
}

# room for a recording's begin (the files of its scene), not for its steps beside their journal
"$filum" run knot-square --input "$work/short.yaml" --record "$work/whole" >/dev/null || exit 1
mount -t tmpfs -o size=$(($(stat -c %s "$work/whole") / 1024 + 32))k tmpfs "$work/full" || exit 1
expect "full disk" 1 "$work/full/session" run knot-square --input "$work/short.yaml" --record "$work/full/session" --json
mount -o remount,ro "$work/full" || exit 1
expect "read-only file system" 2 "$work/full" run knot-square --input "$work/short.yaml" --record "$work/full/other"
expect "store that cannot be written" 1 "a folder that can be written" doctor --store "$work/full" --viewer "$work/viewer"

# a store without room is told from a damaged one: nothing is set aside
head -c 100000 /dev/zero >"$work/small/fill" 2>/dev/null
expect "store on a full disk" 1 "Make room on the disk of the store" doctor --store "$work/small" --viewer "$work/viewer"
ls "$work/small" | grep -q damaged && { echo "a full disk was taken for damage"; failures=$((failures + 1)); }

# an export without room leaves nothing, and the library of HDF5 does not crash as the program ends
umount "$work/small" && mount -t tmpfs -o size=64k tmpfs "$work/small" || exit 1
for format in csv hdf5; do
  expect "$format export onto a full disk" 1 "a disk with space left" export "$work/whole" --format $format --out "$work/small/out"
  [ -z "$(ls -A "$work/small")" ] || { echo "$format export left on a full disk: $(ls -AR "$work/small")"; failures=$((failures + 1)); }
done

[ $failures -eq 0 ] || exit 1
echo "full_disk_test: all as expected"
