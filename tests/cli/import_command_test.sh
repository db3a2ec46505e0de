#!/bin/bash
# filum import on small tables in the published form: what comes out is a dataset that reconcile reads, in the right units. Usage: import_command_test.sh FILUM ROOT
filum=$1 root=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
failures=0
fail() { echo "import_command_test: $*"; failures=$((failures + 1)); }
call() { # CODE ARGUMENTS...
  local code=$1
  shift
  timeout 120 "$filum" "$@" >"$work/out" 2>"$work/err"
  local got=$?
  [ $got -eq "$code" ] || fail "$*: exit $got, expected $code: $(head -c 400 "$work/err")"
}
says() { grep -qF -- "$1" "$work/out" "$work/err" || fail "nothing said of \"$1\": $(head -c 400 "$work/out" "$work/err")"; }

# brain: stretch (or shear strain) and nominal stress in kPa; a cube of 5 mm has 25 mm2, so 1 kPa is 25 mN
mkdir "$work/brain"
for region in cortex basal-ganglia corona-radiata corpus-callosum; do
  for mode in compression:-1 tension:1; do
    awk -v sign="${mode#*:}" 'BEGIN { print "stretch,stress_kPa"; for (i = 0; i <= 20; ++i) printf "%.6f,%.6f\n", 1 + sign * 0.005 * i, sign * 0.01 * i }' >"$work/brain/${region}_${mode%:*}.csv"
  done
  awk 'BEGIN { print "shear_strain,stress_kPa"; for (i = 0; i <= 20; ++i) printf "%.6f,%.6f\n", 0.01 * i, 0.007 * i }' >"$work/brain/${region}_shear.csv"
done
call 0 import brain-budday2017 "$work/brain" --out "$work/sets"
[ "$(wc -l <"$work/out")" = 4 ] || fail "four regions, but: $(cat "$work/out")"
grep -q '^20,-0.5,-5$' "$work/sets/brain-cortex/compression.csv" || fail "not -0.5 mm and -5 mN at a stretch of 0.9: $(tail -1 "$work/sets/brain-cortex/compression.csv")"
grep -q '^20,1,3.5$' "$work/sets/brain-cortex/shear.csv" || fail "not 1 mm and 3.5 mN at a shear of 0.2: $(tail -1 "$work/sets/brain-cortex/shear.csv")"
call 0 reconcile "$work/sets/brain-cortex" --out "$work/report" --root "$root"
says "brain-cortex: "

# muscle: Cauchy stress over stretch is nominal stress
mkdir "$work/muscle"
for name in F XF; do
  for run in 10 20 30 005 01 05; do
    awk 'BEGIN { print "time_s,stretch,stress_kPa"; for (i = 0; i <= 20; ++i) printf "%.3f,%.6f,%.6f\n", i, 1 - 0.01 * i, -0.1 * i; print "20,0.8,-2" }' >"$work/muscle/${name}_$run.csv"
  done
done
call 0 import muscle-vanloocke "$work/muscle" --out "$work/sets"
grep -q '^20,-1,-62.5$' "$work/sets/muscle-along/run-10.csv" || fail "not -2 kPa / 0.8 on 25 mm2: $(tail -1 "$work/sets/muscle-along/run-10.csv")"
[ "$(wc -l <"$work/sets/muscle-along/run-10.csv")" = 22 ] || fail "a time that stands twice is not left out"
grep -q 'run-05.csv.*hold_out: true' "$work/sets/muscle-across/experiment.yaml" || fail "the fastest ramp is not held out"

# load cells: pairs of axes with the third unloaded; beams: means of forty readings wholly on or off, each time on and off a trial
mkdir "$work/cells"
for cell in 1 2 3 4; do
  awk 'BEGIN { print "force_x,force_y,force_z,corrected_x,corrected_y,corrected_z"; for (a = 0; a < 3; ++a) for (i = (a > 0); i <= 4; ++i) {
    f[0] = f[1] = f[2] = 0; f[a] = 100 * i; printf "%d,%d,%d,%d,%d,%d\n", f[0], f[1], f[2], 1000 * f[0] + 20 * f[1], 900 * f[1], 800 * f[2] } }' >"$work/cells/3axisCell${cell}CalibrationData.csv"
done
awk 'BEGIN { print "n,ms,us,a,b,c"; for (i = 0; i < 6000; ++i) { on = int(i / 1000) % 2; printf "%d,%d,0,%d,%d,%d\n", i, 1000000 + 113 * i, 600 - 7000 * on, -700 - 6000 * on, 50 - 5000 * on } }' >"$work/cells/loadingTest.csv"
call 0 import loadcells-fareke "$work/cells" --out "$work/cellsets"
[ "$(wc -l <"$work/out")" = 27 ] || fail "24 pairs and three beams, but: $(wc -l <"$work/out")"
grep -q '^0.980665,0,100000$' "$work/cellsets/loadcell-1-x-by-y/along.csv" || fail "100 gram-force is 0.980665 N: $(head -3 "$work/cellsets/loadcell-1-x-by-y/along.csv")"
[ "$(grep -c 'file: cycle' "$work/cellsets/loadcell-beam-635/experiment.yaml")" = 3 ] || fail "three times on and off: $(tail -4 "$work/cellsets/loadcell-beam-635/experiment.yaml")"
cut -d, -f4 "$work"/cellsets/loadcell-beam-635/cycle-*.csv | grep -v counts | sort -u | paste -sd, | grep -qx -- '-6400.0,600.0' || fail "means across a change of the weight: $(cut -d, -f4 "$work"/cellsets/loadcell-beam-635/cycle-*.csv | sort -u | head -5)"
call 0 reconcile "$work/cellsets/loadcell-1-x-by-y" --out "$work/report" --root "$root"
says "cross-talk"

call 2 import plasticine "$work/brain" --out "$work/x"
says "brain-budday2017, muscle-vanloocke or loadcells-fareke"
call 2 import brain-budday2017 "$work/none" --out "$work/x"
says "$work/none"
rm "$work/brain/corpus-callosum_shear.csv"
call 2 import brain-budday2017 "$work/brain" --out "$work/y"
says "corpus-callosum_shear.csv"
sed -i '3s/.*/abc,1/' "$work/brain/cortex_tension.csv"
call 2 import brain-budday2017 "$work/brain" --out "$work/z"
says "cortex_tension.csv:3"
[ $failures -eq 0 ] || exit 1
echo "import_command_test: all as it should be"
