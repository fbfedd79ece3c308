#!/usr/bin/env bash
# All C++ files must be as clang-format 14 (Debian 12) leaves them. Usage: format.sh SOURCE_DIR
# Exit status 77 (skipped) without that version: others break lines differently.
set -euo pipefail
cd "$1"

formatter=''
for candidate in clang-format-14 clang-format; do
  if command -v "$candidate" >/dev/null && [[ $("$candidate" --version) == *"version 14."* ]]; then
    formatter=$candidate
    break
  fi
done
if [[ -z $formatter ]]; then
  echo "skipped: no clang-format 14 here (Debian 12: apt install clang-format)"
  exit 77
fi

# Tracked files; all below the source folders where there is no repository.
if ! files=$(git ls-files --cached -- '*.cc' '*.h' 2>/dev/null) || [[ -z $files ]]; then
  files=$(find source include tests -name '*.cc' -o -name '*.h')
fi
mapfile -t files < <(while read -r file; do [[ ! -f $file ]] || echo "$file"; done <<<"$files")
if ! "$formatter" --dry-run --Werror "${files[@]}"; then
  echo "to format: $formatter -i FILE..."
  exit 1
fi
echo "${#files[@]} files are well formatted"
