#!/usr/bin/env bash
# The quick tests under the address and undefined behaviour sanitizers, in a build directory of their
# own. Usage: sanitizers.sh SOURCE_DIR BUILD_DIR
set -euo pipefail
source_dir=$1
build_dir=$2

source "$source_dir/tests/checks/sanitized_build.sh"
sanitized_build "$source_dir" "$build_dir" quick_tests
ctest --test-dir "$build_dir" -L '^quick$' -E '^style' --parallel "$(nproc)" --output-on-failure --no-tests=error
