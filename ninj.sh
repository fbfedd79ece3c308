unshare -m bash -c 'mount --bind /tmp/w/exp /work/main && cd /work/main && ninja -C build '"$*"' 2>&1 | grep -E "error|warning|FAILED|ninja:" | cut -c1-300 | head -20'
