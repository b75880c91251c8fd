#!/usr/bin/env bash
# Builds the C library and tests it: the header is current, the examples print the same as in docs/embedding.md, every function
# survives wrong arguments (also under valgrind and the sanitizers of gcc), and the labs of the example lessons give the bits of
# `labspec run` (LABSPEC names the program). Needs gcc, g++ and valgrind.
set -euo pipefail
cd "$(dirname "$0")"
target="${CARGO_TARGET_DIR:-$PWD/target}"
out="$target/c-tests"
lessons=../../specs/lessons models=../../specs/models
mkdir -p "$out"

cargo fmt --all --check
cargo test --locked --quiet -p labspec-c-header
cargo clippy --locked --quiet --workspace --all-targets -- -D warnings
cargo test --locked --quiet -p labspec-c
cargo build --locked --quiet

strict=(-Wall -Wextra -Werror -pedantic -g -Iinclude)
c=(gcc -std=c11 "${strict[@]}")
shared=(-L"$target/debug" -llabspec -Wl,-rpath,"$target/debug")
static=("$target/debug/liblabspec.a" -lpthread -ldl -lm)
for source in examples/pendulum test/hostile test/run test/round_trips test/threads test/deep; do
  "${c[@]}" "$source.c" -o "$out/$(basename "$source")" "${shared[@]}" -lpthread -lm
done
g++ -std=c++17 "${strict[@]}" examples/pendulum.cpp -o "$out/pendulum++" "${shared[@]}"
for source in examples/pendulum test/hostile test/round_trips test/threads; do
  "${c[@]}" -fsanitize=address,undefined -fno-sanitize-recover=all "$source.c" -o "$out/$(basename "$source")-sanitized" "${static[@]}"
done

echo "the examples: C, C++, with sanitizers"
pendulum=("$lessons/02-bounce-and-swing.md" "$models")
for name in pendulum pendulum++ pendulum-sanitized; do "$out/$name" "${pendulum[@]}" >"$out/$name.txt"; done
cmp "$out/pendulum.txt" "$out/pendulum-sanitized.txt"
# The C++ example goes on to a misspelt label.
diff <(cat "$out/pendulum.txt"; echo 'the lab has no control "strat"; did you mean "start"?') "$out/pendulum++.txt"

echo "wrong arguments, right ones, threads, deep texts"
for name in {hostile,round_trips,threads}{,-sanitized} deep; do "$out/$name"; done

echo "valgrind"
# Leaks that are definite or possible are errors; what the library keeps until the end of the program is reachable.
for command in "$out/hostile" "$out/round_trips" "$out/pendulum ${pendulum[*]}"; do
  valgrind --quiet --error-exitcode=1 --leak-check=full $command >"$out/valgrind.txt"
done

echo "the guide shows the example and its output"
perl -0777 -e '
  my ($guide, @parts) = map { open(my $f, "<", $_) or die "$_: $!"; <$f> } @ARGV;
  for (@parts) { index($guide, $_) >= 0 or die "docs/embedding.md shows something else than:\n$_" }
' ../../docs/embedding.md examples/pendulum.c "$out/pendulum.txt"

if [ -z "${LABSPEC:-}" ]; then
  echo "skipped: the labs of the example lessons (LABSPEC names no program)"
  exit 0
fi
echo "the labs of the example lessons have the bits of labspec run"
labs=0 numbers=0 compared=
for lesson in "$lessons"/*.md; do
  for ((i = 1; ; i++)); do
    # Lessons have labs 1 to n: the first address without a lab ends the loop.
    "$LABSPEC" run "$lesson#$i" --models "$models" --steps 400 --format csv >"$out/native.csv" 2>"$out/native.err" || break
    # Numbers with 17 digits, what is not a number as it is.
    tail -n +2 "$out/native.csv" | awk -F, -v OFS=, '{ for (i = 1; i <= NF; i++) if ($i + 0 == $i) $i = sprintf("%.17g", $i); print }' >"$out/native.txt"
    steps=$(($(wc -l <"$out/native.txt") - 1))
    "$out/run" "$lesson" "#$i" "$models" "$steps" >"$out/c.txt"
    # A lab that compares integrators or timesteps has a column for each of its runs; a lab that is open plays one.
    columns() { head -1 "$1" | tr ',' '\n' | wc -l; }
    if [ "$(columns "$out/native.txt")" != "$(columns "$out/c.txt")" ]; then
      compared="$compared $(basename "$lesson" .md)#$i"
      continue
    fi
    cmp "$out/native.txt" "$out/c.txt" || { echo "$lesson#$i differs"; exit 1; }
    labs=$((labs + 1)) numbers=$((numbers + $(tr ',' '\n' <"$out/c.txt" | wc -l)))
  done
  grep -q 'has no lab' "$out/native.err" || { cat "$out/native.err"; exit 1; }
done
echo "$labs labs, $numbers numbers: all with the same bits (skipped, comparisons of runs:$compared)"
[ "$labs" -gt 10 ]
