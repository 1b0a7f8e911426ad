#!/bin/sh
# Fuzz each harness fuzz_<name>.c for some seconds under ASan and UBSan: with libFuzzer if there is a clang, else with
# mutations that know nothing of coverage. The harness fmi is made with every FMU, which share its time. What is found
# is left in build/fuzz.
#
#     tests/fuzz/run.sh [seconds [name...]]       CLANG=clang-19 CLANG_FLAGS=... choose another clang
set -eu
cd "$(dirname "$0")/../.."
seconds=${1:-120}
[ $# -gt 0 ] && shift
clang=${CLANG:-clang}
sanitize="-DFLOW_AGAIN=2000 -g -O1 -fno-sanitize-recover=all -fno-omit-frame-pointer -ffp-contract=off -fno-math-errno"
# The cores are the folders of src with C files but for the FMI layer, the plants' template and the binding.
cores=$(ls -d "$PWD"/src/*/*.c | sed 's|/[^/]*$||' | sort -u | grep -v -E '/(fmi|plant|python)$')
include=$(for core in $cores; do printf ' -I%s' "$core"; done)
[ $# -gt 0 ] || set -- $(ls tests/fuzz/fuzz_*.c | sed 's|.*/fuzz_\(.*\)\.c|\1|') fmi
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
# run NAME CORPUS SECONDS: what is linked as build/fuzz/fuzz_NAME
run() {
    target=$PWD/build/fuzz/fuzz_$1
    if [ -n "$instrument" ]; then
        mkdir -p "$target.found"
        if ! "$target" -max_total_time="$3" -timeout=20 -artifact_prefix="$PWD/build/fuzz/$1-" \
            -print_final_stats=1 "$target.found" "$PWD/$2" > "$target.log" 2>&1; then
            tail -40 "$target.log"
            exit 1
        fi
        tail -6 "$target.log"
    else
        "$target" "${3}s" "$PWD/$2"/*
    fi
}
# The FMI layer with an FMU; what is generated is made here, so no build is needed.
fmi() {
    fmu=$1
    gen=build/fuzz/gen/$fmu
    for make in generate flags; do
        ${PYTHON:-.venv/bin/python} src/pack.py $make fmus/$fmu $gen
    done
    headers=$(${PYTHON:-.venv/bin/python} -c "import fmpy; print(fmpy.__path__[0])")/c-code
    plant=$(ls $gen/plant.c 2> /dev/null || true)
    # shellcheck disable=SC2086
    $compile $link -w $include -I$gen -Ifmus/$fmu -Isrc/fmi -Isrc/plant -I"$headers" -Itests/fuzz -Itests/fuzz/fmi \
        tests/fuzz/fmi/*.c $gen/fmi2/fmu_main.c $plant build/fuzz/cores/*.o -lm -o build/fuzz/fuzz_fmi_$fmu
}
for name in "$@"; do
    if [ $name = fmi ]; then
        fmus=$(ls fmus/*/fmu.toml | sed 's|fmus/\(.*\)/fmu.toml|\1|')
        for fmu in $fmus; do
            fmi $fmu
            run fmi_$fmu tests/fuzz/corpus_fmi $((seconds / $(echo "$fmus" | wc -l)))
        done
        continue
    fi
    # shellcheck disable=SC2086
    $compile $link $include tests/fuzz/fuzz_$name.c build/fuzz/cores/*.o -lm -o build/fuzz/fuzz_$name
    run $name tests/fuzz/corpus_$name "$seconds"
done
