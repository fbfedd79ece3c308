#!/usr/bin/env bash
# The readers of parameter files, meshes and checkpoints under libFuzzer with the address and
# undefined behaviour sanitizers: no crash, no hang, no report. What broke once is kept in
# tests/fuzz/corpus and is tried first; what is new goes into BUILD_DIR/found and serves the next time.
# Usage: fuzz.sh SOURCE_DIR BUILD_DIR [SECONDS], the seconds for all readers side by side.
set -euo pipefail
source_dir=$1
build_dir=$2
seconds=${3-320} # more than ten minutes of computing on two cores
readers=(parameters mesh checkpoint)

source "$source_dir/tests/checks/sanitized_build.sh"
sanitized_build "$source_dir" "$build_dir" "${readers[@]/#/fuzz_}"

export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
export TMPDIR=$build_dir/fuzz_tmp
mkdir -p "$TMPDIR"
trap 'rm -rf "$TMPDIR"' EXIT

fuzz() {
  local reader=$1 places=("$build_dir/found/$1" "$source_dir/tests/fuzz/corpus/$1") options=()
  mkdir -p "${places[0]}"
  if [[ $reader == parameters ]]; then
    places+=("$source_dir/prm")
    options+=("-dict=$source_dir/tests/fuzz/parameters.dict")
  fi
  "$build_dir/tests/fuzz/fuzz_$reader" "${options[@]}" -max_total_time="$seconds" -timeout=20 -rss_limit_mb=4000 \
    -max_len=20000 -print_final_stats=1 -artifact_prefix="$build_dir/$reader-" "${places[@]}"
}

processes=()
for reader in "${readers[@]}"; do
  fuzz "$reader" >"$build_dir/$reader.log" 2>&1 &
  processes+=($!)
done
status=0
for i in "${!readers[@]}"; do
  wait "${processes[i]}" || status=1
  echo "${readers[i]}"
  grep -E '^stat::number_of_executed_units|^SUMMARY|ERROR:|runtime error|not one line|Test unit written' \
    "$build_dir/${readers[i]}.log" | cut -c 1-240 || true
done
exit "$status"
