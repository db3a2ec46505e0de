#!/bin/bash
# The kernel for wider registers must bring no function that others share: the linker might take it for all, and processors without such
# registers could not run it. Usage: vessel_wall_wide_symbols_test.sh OBJECT
symbols=$(nm -C "$1") || exit 1
grep -q ' T filum::add_wide_forces(' <<<"$symbols" || { echo "$1 has no add_wide_forces"; exit 1; }
if others=$(grep -E ' [TWV] ' <<<"$symbols" | grep -v -e 'Lanes<float, 64>'); then
  echo "not of the wide kernel alone: $others"
  exit 1
fi
echo "$(grep -c -E ' [TW] ' <<<"$symbols") functions, all of the wide kernel"
