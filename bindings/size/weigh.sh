#!/bin/sh
# What the engine weighs as WebAssembly, in bytes, as it is and compressed: whole, and without reading MJCF.
set -eu
cd "$(dirname "$0")"
for features in "" "--no-default-features"; do
    cargo build -q --release --target wasm32-unknown-unknown --target-dir ../../target/size $features
    file=../../target/size/wasm32-unknown-unknown/release/labspec_size.wasm
    printf '%s: %s bytes, %s compressed\n' "${features:-whole}" "$(wc -c <"$file")" "$(gzip -9 -c "$file" | wc -c)"
done
