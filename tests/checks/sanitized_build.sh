# To be sourced. sanitized_build SOURCE_DIR BUILD_DIR TARGET...: build with the address and undefined
# behaviour sanitizers, with checks of indices in the standard library and with what tells libFuzzer its
# way through the code, and set what such programs need when they run.
sanitized_build() {
  local source_dir=$1 build_dir=$2 options=() compiler
  shift 2
  if ! compiler=$(command -v clang++-14 || command -v clang++); then
    echo "no Clang here (Debian 12: apt install clang libclang-rt-14-dev)" >&2
    return 1
  fi
  if command -v ccache >/dev/null; then
    options+=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache)
  fi
  # Flags that deal.II was built with by GCC are none of Clang's.
  cmake -S "$source_dir" -B "$build_dir" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_COMPILER="$compiler" \
    -DCMAKE_CXX_FLAGS="-Wno-unknown-warning-option -Wno-ignored-optimization-argument -D_GLIBCXX_ASSERTIONS" \
    -DAKMON_SANITIZE=address,undefined -DAKMON_TESTS=ON -DAKMON_FUZZ=ON "${options[@]}" >/dev/null
  ninja -C "$build_dir" -j "$(nproc)" "$@" | tail -n 30 | cut -c 1-240
  # Open MPI leaves memory to the system when it ends.
  export ASAN_OPTIONS=detect_leaks=0:allocator_may_return_null=1
  export UBSAN_OPTIONS=halt_on_error=1:print_stacktrace=1
}
