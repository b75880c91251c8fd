#!/usr/bin/env bash
# Builds the wheel, installs it into an environment of its own, and tests it there: the tests, the examples of README.md and of the
# package, and its types. LABSPEC names the labspec program, whose numbers the labs must have. Packages that the extras need are
# installed, too; one that there is not for this Python is reported, and its tests are skipped, unless LABSPEC_REQUIRE=all.
# With the argument `packages`, it only installs them.
set -euo pipefail
cd "$(dirname "$0")"
target="${CARGO_TARGET_DIR:-$PWD/../../target}"
env="$target/python"
[ -x "$env/bin/python" ] || python3 -m venv "$env"
install() { "$env/bin/pip" install --quiet --disable-pip-version-check "$@"; }
install "maturin==1.16.0" "numpy>=1.26" "pytest==9.2.0" "pytest-xdist==3.8.0" "uv==0.13.9" "mypy==1.19.0" "gymnasium==1.4.0" "anywidget==0.11.0"
for package in "mujoco==3.14.0" "pyarrow==26.0.1" "scipy==1.17.1" "joblib==1.6.0" "distributed==2026.8.0" "ray==2.60.0"; do
  install "$package" || { echo "not there for this Python: $package"; [ "${LABSPEC_REQUIRE:-}" != all ]; }
done
if [ "${1:-}" = packages ]; then exit 0; fi

rm -rf "$target/wheels"
"$env/bin/maturin" build --quiet --locked --interpreter "$env/bin/python" --out "$target/wheels"
install --force-reinstall --no-deps "$target"/wheels/labspec-*.whl

# Not from the sources: the package that is installed.
"$env/bin/python" -m pytest --quiet -rs tests README.md
"$env/bin/python" -m pytest --quiet --doctest-modules --pyargs labspec
"$env/bin/mypy" --strict --no-error-summary --package labspec
MYPYPATH= "$env/bin/stubtest" labspec._labspec --ignore-missing-stub
