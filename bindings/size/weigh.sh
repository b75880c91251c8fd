#!/bin/sh
# What the engine weighs as WebAssembly, in bytes, as it is and compressed by gzip, and by brotli where that is there: whole, without
# reading pictures, without reading MJCF, and without convex shapes as well. With `cargo install wasm-opt` also after that has had its
# turn.
set -eu
cd "$(dirname "$0")"
file=../../target/size/wasm32-unknown-unknown/release/labspec_size.wasm
weigh() {
    printf '%s: %s bytes, %s compressed by gzip' "$1" "$(wc -c <"$2")" "$(gzip -9 -c "$2" | wc -c)"
    if command -v brotli >/dev/null; then
        printf ', %s by brotli' "$(brotli -q 11 -c "$2" | wc -c)"
    fi
    printf '\n'
}
for features in pictures mjcf convex ""; do
    name=$(case $features in pictures) echo whole ;; mjcf) echo "without pictures" ;; convex) echo "without MJCF" ;; *) echo "without MJCF and convex shapes" ;; esac)
    cargo build -q --release --target wasm32-unknown-unknown --target-dir ../../target/size --no-default-features \
        --features "$features"
    weigh "$name" "$file"
    if command -v wasm-opt >/dev/null; then
        # What rustc lets the compiler use, and no more.
        wasm-opt -Oz --converge --strip-producers --enable-bulk-memory --enable-mutable-globals --enable-multivalue \
            --enable-nontrapping-float-to-int --enable-reference-types --enable-sign-ext "$file" -o "$file.opt"
        weigh "$name, after wasm-opt" "$file.opt"
    fi
done
