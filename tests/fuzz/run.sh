#!/bin/sh
# Fuzz each harness fuzz_<name>.c for some seconds under ASan and UBSan: with libFuzzer if there is a clang, else with
# the driver beside this file, which gcc tells of branches. The harness fmi is made with every FMU, which share its time.
# Inputs that reach what none did stay in build/fuzz/<name>.found for the next time, as few as do; what fails is left
# in build/fuzz, too. Each time the inputs are other ones; a seed that is given draws the same from the same corpora.
#
#     tests/fuzz/run.sh [seconds [name...]]       SEED=7    CLANG=clang-19 CLANG_FLAGS=... choose another clang
#                                                 TIMEOUT=600 for an input on a machine that is busy with other work [s]
set -eu
cd "$(dirname "$0")/../.."
seconds=${1:-120}
[ $# -gt 0 ] && shift
seed=${SEED:-$(od -An -N3 -tu4 /dev/urandom | tr -d ' ')}
echo "seed $seed; the same again: SEED=$seed"
clang=${CLANG:-clang}
built=$PWD/build/fuzz
sanitize="-DFLOW_AGAIN=2000 -g -O1 -fno-sanitize-recover=all -fno-omit-frame-pointer -ffp-contract=off -fno-math-errno"
sanitize="$sanitize -fsanitize=address,undefined"
cores=$(ls -d "$PWD"/src/*/*/core.toml | sed 's|/[^/]*$||')
include=$(for core in $cores; do printf ' -I%s' "$core"; done)
headers=$(${PYTHON:-.venv/bin/python} -c "import fmpy; print(fmpy.__path__[0])")/c-code
fmi_include="-I$PWD/tests/fuzz -I$PWD/tests/fuzz/fmi -I$headers"
[ $# -gt 0 ] || set -- $(ls tests/fuzz/fuzz_*.c | sed 's|.*/fuzz_\(.*\)\.c|\1|') fmi
if command -v "$clang" > /dev/null; then
    compiler="$clang ${CLANG_FLAGS:-} $sanitize"
    seen=-fsanitize=fuzzer-no-link
    link=-fsanitize=fuzzer
else
    echo "no clang: the driver of our own"
    compiler="gcc $sanitize"
    seen=-fsanitize-coverage=trace-pc
    link=$built/driver.o
fi
# objects FOLDER OPTIONS FILE...: compile into it, as many at once as there are processors.
objects() {
    folder=$built/$1 options=$2
    shift 2
    rm -rf "$folder"
    mkdir -p "$folder"
    # shellcheck disable=SC2086
    printf '%s\n' "$@" | (cd "$folder" && xargs -n 8 -P "$(nproc)" $compiler $seen $options -c)
}
# shellcheck disable=SC2046
objects cores "$include" $(for core in $cores; do ls "$core"/*.c; done)
$compiler -c tests/fuzz/driver.c -o "$built/driver.o"
# run NAME CORPUS SECONDS: what is linked as build/fuzz/fuzz_NAME
run() {
    target=$built/fuzz_$1 found=$built/$1.found
    mkdir -p "$found"
    if [ "$link" = -fsanitize=fuzzer ]; then
        if ! "$target" -seed="$seed" -max_total_time="$3" -timeout=${TIMEOUT:-120} -artifact_prefix="$built/$1-" \
            -print_final_stats=1 "$found" "$PWD/$2" > "$target.log" 2>&1; then
            tail -40 "$target.log"
            exit 1
        fi
        rm -rf "$found.fewer"
        mkdir "$found.fewer"
        cp "$2"/* "$found.fewer"
        "$target" -merge=1 "$found.fewer" "$found" >> "$target.log" 2>&1
        for given in "$2"/*; do rm "$found.fewer/${given##*/}"; done
        rm -rf "$found"
        mv "$found.fewer" "$found"
        echo "$1: $(sed -n 's/stat::number_of_executed_units: *//p' "$target.log" | head -1) inputs hold," \
            "$(sed -n 's/stat::average_exec_per_sec: *//p' "$target.log" | head -1) a second, $(ls "$found" | wc -l) kept"
    else
        echo "$1: $("$target" "${3}s@$seed" "+$found" "$PWD/$2"/*)"
    fi
}
# The FMI layer with an FMU; what is generated is made here, so no build is needed.
fmi() {
    fmu=$1
    gen=build/fuzz/gen/$fmu
    ${PYTHON:-.venv/bin/python} src/pack.py generate fmus/$fmu $gen
    plant=$(ls $gen/plant.c 2> /dev/null || true)
    # shellcheck disable=SC2086
    $compiler $seen -w $include -I$gen -Ifmus/$fmu -Isrc/fmi -Isrc/plant $fmi_include -include tests/fuzz/fmi/fence.h \
        tests/fuzz/fmi/inside.c $gen/fmi2/fmu_main.c $plant $3 "$built"/harness/*.o "$built"/cores/*.o -lm \
        -Wl,--wrap=memset,--wrap=__asan_memset -o "$built/fuzz_fmi_$fmu"
    run fmi_$fmu tests/fuzz/corpus_fmi "$2"
}
for name in "$@"; do
    case $name in
    fmi*)
        fmus=$(ls fmus/*/fmu.toml | sed 's|fmus/\(.*\)/fmu.toml|\1|')
        # shellcheck disable=SC2046
        objects harness "-w $fmi_include" $(ls "$PWD"/tests/fuzz/fmi/*.c | grep -v /inside.c)
        if [ $name = fmi ]; then
            for fmu in $fmus; do
                fmi $fmu $((seconds / $(echo "$fmus" | wc -l) + 1)) $link # 0 would be no limit
            done
        else
            fmi "${name#fmi_}" "$seconds" $link
        fi
        ;;
    *)
        # shellcheck disable=SC2086
        $compiler $seen $include -Itests/core tests/fuzz/fuzz_$name.c $link "$built"/cores/*.o -lm -o "$built/fuzz_$name"
        run $name tests/fuzz/corpus_$name "$seconds"
        ;;
    esac
done
