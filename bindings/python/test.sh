#!/usr/bin/env bash
# Builds the wheel, installs it into an environment of its own, and tests it there: the tests, the examples of README.md and of the
# package, and its types. LABSPEC names the labspec program, whose numbers the labs must have.
set -euo pipefail
cd "$(dirname "$0")"
target="${CARGO_TARGET_DIR:-$PWD/target}"
cargo fmt --check
cargo clippy --locked --quiet -- -D warnings

env="$target/python"
[ -x "$env/bin/python" ] || python3 -m venv "$env"
"$env/bin/pip" install --quiet --disable-pip-version-check "maturin==1.16.0" "numpy>=1.26" "pytest==9.2.0" "mypy==1.19.0"
rm -rf "$target/wheels"
CARGO_TARGET_DIR="$target" "$env/bin/maturin" build --quiet --locked --interpreter "$env/bin/python" --out "$target/wheels"
"$env/bin/pip" install --quiet --disable-pip-version-check --force-reinstall --no-deps "$target"/wheels/labspec-*.whl

# Not from the sources: the package that is installed.
"$env/bin/python" -m pytest --quiet tests README.md
"$env/bin/python" -m pytest --quiet --doctest-modules --pyargs labspec
"$env/bin/mypy" --strict --no-error-summary --package labspec
MYPYPATH= "$env/bin/stubtest" labspec._labspec --ignore-missing-stub
