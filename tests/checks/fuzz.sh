#!/usr/bin/env bash
# The readers of parameter files, meshes and checkpoints under libFuzzer with the address and
# undefined behaviour sanitizers: no crash, no hang, no report. What broke once is kept in
# tests/fuzz/corpus and is tried first. Usage: fuzz.sh SOURCE_DIR BUILD_DIR [SECONDS PER READER]
# Exit status 77 (skipped) without Clang 14.
set -euo pipefail
source_dir=$1
build_dir=$2
seconds=${3-200}

compiler=$(command -v clang++-14 || command -v clang++ || true)
if [[ -z $compiler ]]; then
  echo "skipped: no Clang here (Debian 12: apt install clang)"
  exit 77
fi
options=()
if command -v ccache >/dev/null; then
  options+=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache)
fi
cmake -S "$source_dir" -B "$build_dir" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_COMPILER="$compiler" \
  -DAKMON_SANITIZE=address,undefined,fuzzer-no-link -DAKMON_TESTS=OFF -DAKMON_FUZZ=ON "${options[@]}" >/dev/null
ninja -C "$build_dir" -j "$(nproc)" fuzz_parameters fuzz_mesh fuzz_checkpoint | tail -n 30 | cut -c 1-240

# Open MPI leaves memory to the system when it ends.
export ASAN_OPTIONS=detect_leaks=0:allocator_may_return_null=1
export UBSAN_OPTIONS=halt_on_error=1:print_stacktrace=1
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
status=0
for reader in parameters mesh checkpoint; do
  found=$build_dir/found/$reader
  seeds=$build_dir/seeds/$reader
  mkdir -p "$found" "$seeds"
  [[ $reader != parameters ]] || cp "$source_dir"/prm/*.prm "$seeds"
  [[ $reader != checkpoint ]] || cp "$build_dir"/seed_run/checkpoint_*.h5 "$seeds" 2>/dev/null || true
  dictionary=()
  [[ ! -f $source_dir/tests/fuzz/$reader.dict ]] || dictionary=("-dict=$source_dir/tests/fuzz/$reader.dict")
  log=$build_dir/$reader.log
  "$build_dir/tests/fuzz/fuzz_$reader" "${dictionary[@]}" -max_total_time="$seconds" -timeout=20 -rss_limit_mb=4000 \
    -max_len=20000 -print_final_stats=1 -artifact_prefix="$build_dir/$reader-" \
    "$found" "$source_dir/tests/fuzz/corpus/$reader" "$seeds" >"$log" 2>&1 || status=1
  grep -E '^stat::number_of_executed_units|^SUMMARY|ERROR:|runtime error|Test unit written' "$log" | cut -c 1-240 || true
done
exit "$status"
