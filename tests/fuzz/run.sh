#!/bin/sh
# Fuzz each harness fuzz_<name>.c for some seconds under ASan and UBSan: with libFuzzer if there is a clang, else with
# mutations that know nothing of coverage. What is found is left in build/fuzz.
#
#     tests/fuzz/run.sh [seconds [name...]]       CLANG=clang-19 CLANG_FLAGS=... choose another clang
set -eu
cd "$(dirname "$0")/../.."
seconds=${1:-120}
[ $# -gt 0 ] && shift
clang=${CLANG:-clang}
sanitize="-g -O1 -fno-sanitize-recover=all -fno-omit-frame-pointer -ffp-contract=off -fno-math-errno"
# The cores are the folders of src with C files but for the FMI layer, the plants' template and the binding.
cores=$(ls -d "$PWD"/src/*/*.c | sed 's|/[^/]*$||' | sort -u | grep -v -E '/(fmi|plant|python)$')
include=$(for core in $cores; do printf ' -I%s' "$core"; done)
[ $# -gt 0 ] || set -- $(ls tests/fuzz/fuzz_*.c | sed 's|.*/fuzz_\(.*\)\.c|\1|')
if command -v "$clang" > /dev/null; then
    compile="$clang ${CLANG_FLAGS:-} $sanitize -fsanitize=address,undefined"
    instrument=-fsanitize=fuzzer-no-link
    link=-fsanitize=fuzzer
else
    echo "no clang: mutations without coverage"
    compile="gcc $sanitize -fsanitize=address,undefined"
    instrument=
    link=tests/fuzz/driver.c
fi
rm -rf build/fuzz/cores
mkdir -p build/fuzz/cores
# shellcheck disable=SC2086
(cd build/fuzz/cores && for core in $cores; do $compile $instrument $include -c "$core"/*.c; done)
for name in "$@"; do
    corpus=tests/fuzz/corpus_$name
    target=build/fuzz/fuzz_$name
    # shellcheck disable=SC2086
    $compile $link $include tests/fuzz/fuzz_$name.c build/fuzz/cores/*.o -lm -o $target
    if [ -n "$instrument" ]; then
        mkdir -p $target.found
        if ! $target -max_total_time="$seconds" -timeout=20 -artifact_prefix=build/fuzz/$name- \
            -print_final_stats=1 $target.found $corpus > $target.log 2>&1; then
            tail -40 $target.log
            exit 1
        fi
        tail -6 $target.log
    else
        $target "${seconds}s" $corpus/*
    fi
done
