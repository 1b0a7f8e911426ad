#!/bin/sh
# Fuzz each harness for some seconds under ASan and UBSan: with libFuzzer if there is a clang, else with mutations
# that know nothing of coverage. What is found is left in build/fuzz.
#
#     tests/fuzz/run.sh [seconds]         CLANG=clang-19 CLANG_FLAGS=... choose another clang
set -eu
cd "$(dirname "$0")/../.."
seconds=${1:-120}
clang=${CLANG:-clang}
sanitize="-g -O1 -fno-sanitize-recover=all -fno-omit-frame-pointer -ffp-contract=off -fno-math-errno"
sources="-Isrc/mcc src/mcc/[a-z]*.c"
mkdir -p build/fuzz
for name in program api; do
    corpus=tests/fuzz/corpus_$name
    target=build/fuzz/fuzz_$name
    if command -v "$clang" > /dev/null; then
        # shellcheck disable=SC2086
        "$clang" ${CLANG_FLAGS:-} $sanitize -fsanitize=fuzzer,address,undefined $sources \
            tests/fuzz/fuzz_$name.c -lm -o $target
        mkdir -p $target.found
        if ! $target -max_total_time="$seconds" -timeout=20 -artifact_prefix=build/fuzz/$name- \
            -print_final_stats=1 $target.found $corpus > $target.log 2>&1; then
            tail -40 $target.log
            exit 1
        fi
        tail -6 $target.log
    else
        echo "no clang: mutations without coverage"
        # shellcheck disable=SC2086
        gcc $sanitize -fsanitize=address,undefined $sources tests/fuzz/fuzz_$name.c tests/fuzz/driver.c -lm -o $target
        $target "${seconds}s" $corpus/*
    fi
done
