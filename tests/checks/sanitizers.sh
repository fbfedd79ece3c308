#!/usr/bin/env bash
# Unit tests and a small case under the address and undefined behaviour sanitizers, in a build
# directory of their own. Usage: sanitizers.sh SOURCE_DIR BUILD_DIR CXX_COMPILER
set -euo pipefail
source_dir=$1
build_dir=$2
compiler=$3
tests=(arc_end_test arc_end_objectivity_test arc_end_as_printed_test j2_plastic_test j2_plastic_arc_end_test
  projection_test output_test fidcd_test)

options=()
if command -v ccache >/dev/null; then
  options+=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache)
fi
cmake -S "$source_dir" -B "$build_dir" -G Ninja -DCMAKE_BUILD_TYPE=Release \
  -DCMAKE_CXX_COMPILER="$compiler" -DAKMON_SANITIZE=address,undefined -DAKMON_TESTS=ON \
  "${options[@]}" >/dev/null
ninja -C "$build_dir" -j "$(nproc)" akmon "${tests[@]}" | tail -n 30 | cut -c 1-240

# Open MPI leaves memory to the system when it ends.
export ASAN_OPTIONS=detect_leaks=0
export UBSAN_OPTIONS=halt_on_error=1:print_stacktrace=1
for test in "${tests[@]}"; do
  echo "$test"
  "$build_dir/tests/$test" --gtest_brief=1
done
echo "akmon one_cell.prm"
"$build_dir/akmon" "$source_dir/prm/one_cell.prm" --set "Output directory=$build_dir/one_cell"
