#!/usr/bin/env bash
# Unit tests and small cases under the address and undefined behaviour sanitizers, in a build
# directory of their own. Usage: sanitizers.sh SOURCE_DIR BUILD_DIR
set -euo pipefail
source_dir=$1
build_dir=$2
tests=(arc_end_test arc_end_objectivity_test arc_end_as_printed_test j2_plastic_test j2_plastic_arc_end_test
  projection_test output_test fidcd_test mesh_file_test reproducible_sums_test coupled_solver_test
  semismooth_newton_test)

source "$source_dir/tests/checks/sanitized_build.sh"
sanitized_build "$source_dir" "$build_dir" akmon "${tests[@]}"

for test in "${tests[@]}"; do
  echo "$test"
  "$build_dir/tests/$test" --gtest_brief=1
done
run() {
  echo "akmon $1.prm"
  local name=$1 options=()
  shift
  for change in "$@"; do
    options+=(--set "$change")
  done
  "$build_dir/akmon" "$source_dir/prm/$name.prm" "${options[@]}" --set "Output directory=$build_dir/$name"
}

run one_cell
run crossed_bricks
run poured_spheres "Bodies/ball/Copies/Count=2, 2, 2" "Time/End=0.04"
run block_tower "Time/End=0.02"
run lap_joint "Time/End=2e-5"
