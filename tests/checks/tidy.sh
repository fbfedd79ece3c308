#!/usr/bin/env bash
# clang-tidy 14 with the checks of .clang-tidy over the sources of the time step, in large batches (most of its
# time goes into deal.II's headers), or over the files named, each alone; any finding fails. In batches the
# HeaderFilterRegex tells whose findings count.
# Usage: tidy.sh SOURCE_DIR BUILD_DIR [SOURCE_FILE]...      Exit status 77 (skipped) without clang-tidy 14.
set -euo pipefail
source_dir=$1
build_dir=$2
shift 2

tidy=''
for candidate in clang-tidy-14 clang-tidy; do
  if command -v "$candidate" >/dev/null && [[ $("$candidate" --version) == *"version 14."* ]]; then
    tidy=$candidate
    break
  fi
done
if [[ -z $tidy ]]; then
  echo "skipped: no clang-tidy 14 here (Debian 12: apt install clang-tidy)"
  exit 77
fi

# GCC's precompiled header is nothing for clang: every source must, and does, stand without it.
database=$build_dir/tidy
commands=$database/compile_commands.json
batches=ON
(($# == 0)) || batches=OFF
cmake -S "$source_dir" -B "$database" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_COMPILER=g++ \
  -DCMAKE_EXPORT_COMPILE_COMMANDS=ON -DAKMON_UNITY="$batches" -DAKMON_BATCH=20 -DAKMON_TESTS=OFF >/dev/null
sed -E -e 's/ -Winvalid-pch//g; s/ -include [^ "]*cmake_pch\.hxx//g; s/ -Wno-(maybe-)?uninitialized//g; s/ -Werror / /g' \
  -i "$commands"

cd "$source_dir"
files=("$@")
if ((${#files[@]} == 0)); then
  mapfile -t files < <(grep -lE '/source/(contact|rigid|time|material|forces)/' "$database"/CMakeFiles/akmon_core.dir/Unity/*.cxx)
fi
# Named, because clang-tidy looks for its configuration beside the batches, where none need be.
options=(-p "$database" --config-file=.clang-tidy --quiet --warnings-as-errors='*')
findings=$database/findings.txt
status=0
printf '%s\n' "${files[@]}" | xargs -P "$(nproc)" -n 1 "$tidy" "${options[@]}" >"$findings" 2>&1 || status=$?
if ((status)); then
  grep -v -E '^[0-9]+ warnings? |^Suppressed |^Use -header-filter' "$findings" | cut -c 1-240
  exit 1
fi
echo "${#files[@]} files or batches have no findings"
