#!/usr/bin/env bash
# Unit tests and a small case under the address and undefined behaviour sanitizers, in a build
# directory of their own. Usage: sanitizers.sh SOURCE_DIR BUILD_DIR
set -euo pipefail
source_dir=$1
build_dir=$2
tests=(arc_end_test arc_end_objectivity_test arc_end_as_printed_test j2_plastic_test j2_plastic_arc_end_test
  projection_test output_test fidcd_test mesh_file_test reproducible_sums_test)

source "$source_dir/tests/checks/sanitized_build.sh"
sanitized_build "$source_dir" "$build_dir" akmon "${tests[@]}"

for test in "${tests[@]}"; do
  echo "$test"
  "$build_dir/tests/$test" --gtest_brief=1
done
echo "akmon one_cell.prm"
"$build_dir/akmon" "$source_dir/prm/one_cell.prm" --set "Output directory=$build_dir/one_cell"
