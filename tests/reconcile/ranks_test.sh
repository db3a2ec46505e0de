#!/bin/bash
# Many datasets under mpirun: reports are the same bytes with 1, 2 and 4 processes; after one process was killed the next start repeats only
# what had no report; the program itself needs no MPI. Usage: ranks_test.sh FILUM ROOT MPIEXEC
filum=$1 root=$2 mpiexec=$3
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() { echo "$1"; exit 1; }
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMPI_MCA_rmaps_base_oversubscribe=1 OMPI_MCA_btl_base_warn_component_unused=0

ldd "$filum" | grep -qi -E "libmpi|opencv" && fail "the program needs MPI or OpenCV: $(ldd "$filum" | grep -i -E 'libmpi|opencv')"

# blocks of 2 kPa, each with another share of relaxation; every fifth has none
source "$root/tests/reconcile/make_block.sh"
for i in 01 02 03 04 05 06 07 08 09 10; do
  make_block "$work/data/block-$i" "$(printf '0.%02d' $((10#$i % 5 * 12)))" 2 300 $((10#$i * 10 + 1))
done

all() { "$mpiexec" -n "$1" "$filum" reconcile --all "$work/data" --out "$2" --repeatable --root "$root" >"$work/log-$1" 2>&1; }
for n in 1 2 4; do
  all "$n" "$work/out$n" || fail "$n processes: $(tail -5 "$work/log-$n")"
  [ "$(find "$work/out$n" -name report.json | wc -l)" = 10 ] || fail "$n processes did not write ten reports"
  diff -r "$work/out1" "$work/out$n" >"$work/diff" || fail "1 and $n processes differ: $(head -c 400 "$work/diff")"
done
grep -q "without MPI" "$work"/log-* && fail "the module was not used: $(grep -h 'without MPI' "$work"/log-*)"

# started by srun without MPI: MPI is not asked (worlds of one process that start at the same moment may abort), they share by number
for n in 0 1; do
  env SLURM_PROCID=$n SLURM_NTASKS=2 "$filum" reconcile --all "$work/data" --out "$work/slurm" --repeatable --root "$root" >"$work/slurm-$n" 2>&1 &
done
wait
diff -r "$work/out1" "$work/slurm" >"$work/diff" || fail "by number: $(head -c 400 "$work/diff")"
shared=$(cat "$work"/slurm-? | grep -c '^[0-9]*/10 block-')
[ "$shared" = 10 ] || fail "by number $shared datasets were solved instead of 10: $(head -c 600 "$work"/slurm-0)"

# one of two processes is killed after the first report is there; on a busy machine all may be finished before that is seen: then again
for _ in $(seq 8); do
  rm -rf "$work/killed"
  all 2 "$work/killed" &
  until [ "$(find "$work/killed" -name report.json 2>/dev/null | wc -l)" -ge 1 ]; do
    kill -0 $! 2>/dev/null || break
    sleep 0.005
  done
  victim=$(pgrep -f -- "^$filum reconcile --all $work/data --out $work/killed" | tail -1)
  [ -n "$victim" ] && kill -9 "$victim"
  wait $!
  status=$?
  whole=$(find "$work/killed" -name report.json | sort)
  kept=$(wc -l <<<"$whole")
  [ "$kept" -lt 10 ] && break
done
[ "$kept" -lt 10 ] || fail "everything was finished before the kill, eight times"
[ "$status" != 0 ] || fail "mpirun did not notice the killed process"
for r in $whole; do cmp -s "$r" "$work/out1/$(basename "$(dirname "$r")")/report.json" || fail "$r is not whole"; done
stamps=$(stat -c '%n %y' $whole)
all 2 "$work/killed" || fail "the second start failed"
[ "$stamps" = "$(stat -c '%n %y' $whole)" ] || fail "finished reports were written again"
find "$work/killed" -name '*.part' -delete
diff -r "$work/out1" "$work/killed" >"$work/diff" || fail "after the kill: $(head -c 400 "$work/diff")"
echo "ten reports equal with 1, 2 and 4 processes; after a kill $kept were kept, $((10 - kept)) repeated"
exit 0
