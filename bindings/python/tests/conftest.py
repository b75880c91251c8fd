"""What tests need that is not always there: with LABSPEC_REQUIRE=all a test that would be skipped fails."""

import importlib
import os
import shutil
import subprocess

import pytest


def needs(name):
    """The module, or a skipped test with the reason."""
    try:
        return importlib.import_module(name)
    except ImportError as e:
        if os.environ.get("LABSPEC_REQUIRE") == "all":
            raise
        pytest.skip(f"{name} is not installed: {e}")


def listing_settings(*lines):
    """Settings of listings. Where the network cannot be switched off, listings run with it."""
    namespaces = ["unshare", "--user", "--map-root-user", "--net", "--pid", "--kill-child=KILL", "true"]
    isolated = shutil.which("unshare") and subprocess.run(namespaces, capture_output=True, check=False).returncode == 0
    return "\n".join(["[listings]", *lines, *["network = true"] * (not isolated), ""])


@pytest.fixture
def program():
    """The labspec program whose numbers the package must have."""
    if "LABSPEC" not in os.environ:
        if os.environ.get("LABSPEC_REQUIRE") == "all":
            pytest.fail("LABSPEC names no program")
        pytest.skip("LABSPEC names no program")
    return os.environ["LABSPEC"]
