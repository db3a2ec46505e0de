#!/bin/bash
# Datasets as large as the test's generator makes them (a still hand: 12 records, 45,000 rows; a block: 10 records, 15,000 rows; a blade whose tissue is
# meshed) and a still hand's record of four million rows (1 kHz for over an hour) are reconciled below 1 GB of resident memory. Usage: memory_test.sh FILUM ROOT [LIMIT_MB]
filum=$1 root=$2 limit=${3:-1000}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

mkdir "$work/hand"
{
  printf 'format: filum-experiment/1\ntitle: hand\nsource: test\nrig: tip-hold\nspecimen: { sensor: optical }\nmodel:\n  file: hand/still\nchannels:\n  - { name: time, column: t, unit: s }\n'
  for axis in x y z; do printf '  - { name: %s, column: %s, unit: um, kind: output, noise: "4 um" }\n' $axis $axis; done
  printf 'trials:\n'
  for k in 1 2 3 4 5 6 7 8 9 10 11 12; do printf '  - { file: r%s.csv, protocol: { support: free } }\n' $k; done
} >"$work/hand/experiment.yaml"
for k in 1 2 3 4 5 6 7 8 9 10 11 12; do
  awk -v seed=$k 'BEGIN { srand(seed); print "t,x,y,z"; for (i = 0; i < 3750; ++i) { t = i / 150; s = t; for (a = 0; a < 3; ++a) { g = -6; for (j = 0; j < 12; ++j) g += rand(); s = s "," 4 * g + 9 * sin(7.54 * t + seed + a) } print s } }' >"$work/hand/r$k.csv"
done

source "$root/tests/reconcile/make_block.sh"
make_block "$work/block" 0.5 2 1500 1 "a:1:A b:1:A c:4:B d:4:B e:2:C f:2:C g:8:D h:8:D i:3:E j:3:E"

# the same records as those of a blade, whose tissue is meshed
mkdir "$work/blade"
printf 'format: filum-experiment/1\ntitle: blade\nsource: test\nrig: spatula-press\nspecimen: { shape: box, length: "60 mm", width: "50 mm", height: "20 mm", blade_length: "14 mm", blade_width: "7 mm" }\nmodel: { file: brain/linear, free: [youngs_modulus] }\nchannels:\n  - { name: time, column: t, unit: s }\n  - { name: depth, column: z, unit: mm, kind: input }\n  - { name: force, column: F, unit: mN, kind: output, noise: "0.02 mN" }\ntrials:\n' >"$work/blade/experiment.yaml"
for run in a:1 c:4 e:2 g:8; do
  printf '  - { file: %s.csv, protocol: { rate: "%s mm/s" } }\n' "${run%:*}" "${run#*:}" >>"$work/blade/experiment.yaml"
  awk -F, 'NR == 1 { print "t,z,F"; next } { printf "%s,%.6f,%.6f\n", $1, -$2, -$3 }' "$work/block/${run%:*}.csv" >"$work/blade/${run%:*}.csv"
done

# noise from a generator that costs nothing, and a heart beat of 1.2 Hz
mkdir "$work/long"
sed -e '/^trials:/,$d' -e 's/, noise: "4 um"//' "$work/hand/experiment.yaml" >"$work/long/experiment.yaml"
printf 'trials:\n  - { file: r.csv, protocol: { support: free } }\n' >>"$work/long/experiment.yaml"
awk 'BEGIN { print "t,x,y,z"; s = 1; for (i = 0; i < 4000000; ++i) { w = 9 * sin(0.00754 * i); r = ""; for (a = 0; a < 3; ++a) { s = (s * 16807) % 2147483647; r = r sprintf(",%.3f", w + s / 1e8 - 10.7) } printf "%.3f%s\n", i / 1000, r } }' >"$work/long/r.csv"

python3 - "$filum" "$work" "$limit" "$root" <<'PY'
import resource, subprocess, sys
filum, work, limit, root = sys.argv[1:]
for name in ("hand", "block", "blade", "long"):
    done = subprocess.run([filum, "reconcile", f"{work}/{name}", "--out", f"{work}/out-{name}"], capture_output=True, text=True, cwd=root)
    most = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss / 1024  # the largest child so far
    if name == "long" and not ("pulsation" in done.stdout and "thinned to one in 67" in open(f"{work}/out-long/report.json").read()):
        sys.exit(f"long: {done.stdout} {done.stderr}")
    print(name, done.stdout.split("\n")[0], f"{most:.0f} MB at most so far")
    if done.returncode != 0:
        sys.exit(f"{name} failed: {done.stderr}")
    if not most < float(limit):
        sys.exit(f"{name}: {most:.0f} MB, expected below {limit} MB")
PY
