"""Environments of listings that are declared for uv or venv, with packages from PyPI: they need a network."""

import importlib.metadata
import json
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest
from conftest import listing_settings, needs

#: A package of Python alone, of which pytest needs a version.
PACKAGE = f"iniconfig=={importlib.metadata.version('iniconfig')}"
LESSON = f"""# A package

```python
from importlib.metadata import distributions
print(*(f"{{d.name}}=={{d.version}}" for d in distributions() if d.name not in ("pip", "setuptools")))
```
Output:
```text
{PACKAGE}
```
"""


def has_index(uv):
    """Whether the index of packages can be reached. Tests that need it are skipped otherwise."""
    found = subprocess.run([uv, "pip", "install", "--dry-run", "--no-config", "--target", "/nowhere", PACKAGE], capture_output=True, check=False)
    if found.returncode != 0:
        if os.environ.get("LABSPEC_REQUIRE") == "all":
            pytest.fail(found.stderr.decode())
        pytest.skip("the index of packages cannot be reached")


@pytest.fixture
def programs(tmp_path):
    """Two folders of programs: one with `uv`, and one with `python3`."""
    uv = needs("uv").find_uv_bin()
    has_index(uv)
    for name, program in (("uv", uv), ("python3", sys.executable)):
        (tmp_path / f"with-{name}").mkdir()
        (tmp_path / f"with-{name}" / name).symlink_to(program)
    return tmp_path / "with-uv", tmp_path / "with-python3", Path("/usr/bin"), Path("/bin")


def check(folder, settings, path):
    """The state of the listing, and why it is not true."""
    (folder / "labspec.toml").write_text(listing_settings(settings), encoding="utf-8")
    (folder / "a.md").write_text(LESSON, encoding="utf-8")
    environment = {**os.environ, "PATH": os.pathsep.join(map(str, path)), "LABSPEC_CACHE": str(folder / "cache")}
    command = [sys.executable, "-m", "labspec", "check", "a.md", "--listings", "--format", "json"]
    result = subprocess.run(command, cwd=folder, capture_output=True, text=True, env=environment, check=False)
    report = json.loads(result.stdout)
    [listing] = [row for row in report["ledger"] if row["subject"] == "listing"]
    return listing["state"], " ".join([listing["remark"] or "", *(f["message"] for f in report["findings"])]).strip()


def test_a_project_with_a_lock_file(tmp_path, programs):
    course = tmp_path / "course"
    course.mkdir()
    project = f'[project]\nname = "course"\nversion = "1"\nrequires-python = ">=3.11"\ndependencies = ["{PACKAGE}"]\n'
    (course / "pyproject.toml").write_text(project, encoding="utf-8")
    subprocess.run([programs[0] / "uv", "lock", "--no-config", "--project", course], check=True, capture_output=True)
    lock = (course / "uv.lock").read_text(encoding="utf-8")
    state, why = check(tmp_path, 'project = "course"', programs)
    assert state == "true", why
    assert (course / "uv.lock").read_text(encoding="utf-8") == lock
    assert sorted(path.name for path in course.iterdir()) == ["pyproject.toml", "uv.lock"]
    assert check(tmp_path, 'project = "course"', programs[1:])[0] == "true", "it is made once"
    (course / "uv.lock").write_text(re.sub(r"sha256:[0-9a-f]{64}", f"sha256:{'0' * 64}", lock), encoding="utf-8")
    state, why = check(tmp_path, 'project = "course"', programs)
    assert state == "unchecked" and "the packages of `project` cannot be installed" in why, "a package with other bytes is refused"


def test_packages_with_uv_and_with_venv(tmp_path, programs):
    for name, path in (("uv", programs), ("venv", programs[1:])):
        folder = tmp_path / name
        folder.mkdir()
        state, why = check(folder, f'requirements = ["{PACKAGE}"]', path)
        assert state == "true", f"{name}: {why}"
        [made] = (folder / "cache/environments").iterdir()
        assert ("uv = " in (made / "pyvenv.cfg").read_text(encoding="utf-8")) == (name == "uv")
