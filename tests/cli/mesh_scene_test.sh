#!/bin/bash
# A region of Debian's Colin27 scan is meshed, pressed on in a scene of its own, recorded and replayed bit for bit.
# Usage: mesh_scene_test.sh FILUM ROOT
filum=$1 root=$2
scan=/usr/share/mricron/templates/ch2bet.nii.gz
[ -x "$(dirname "$filum")/filum_mesh" ] || { echo "SKIPPED: install libcgal-dev and libnifti-dev to build filum mesh"; exit 77; }
[ -f "$scan" ] || { echo "SKIPPED: install mricron-data for a scan"; exit 77; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() { echo "mesh_scene_test: $*"; cat "$work"/*.err "$work"/*.json 2>/dev/null | head -c 3000; exit 1; }
"$filum" mesh "$scan" --extracted --at -45,40,45 --radius 30 --depth 25 --fine 4 --coarse 7 --out "$work/region" --json >"$work/mesh.json" 2>"$work/mesh.err" || fail "mesh"
node -e '
  const d = JSON.parse(require("fs").readFileSync(process.argv[1]));
  if (d.nodes < 500 || d.quality.worst_radius_ratio < 0.05 || d.grey_ml <= 0 || d.white_ml <= 0) { console.error(d); process.exit(1); }
' "$work/mesh.json" || fail "not a usable mesh"
"$filum" run press-to-target --root "$root" --input demo --model "$work/region/brain.yaml" --longest 4 --record "$work/press" --json >"$work/run.json" 2>"$work/run.err" || fail "run"
node -e 'const d = JSON.parse(require("fs").readFileSync(process.argv[1])); if (!(d.pressure.force_n > 0.01)) { console.error(d.pressure); process.exit(1); }' "$work/run.json" || fail "no force"
rm -r "$work/region" # the recording holds the mesh
"$filum" replay "$work/press" --json 2>"$work/replay.err" | grep -q '"identical": *true' || fail "replay differs"
"$filum" mesh "$scan" --at 0,0,90 --radius 500 --out "$work/none" 2>"$work/bad.err"
[ $? -eq 2 ] || fail "a window wider than a head must be refused"
