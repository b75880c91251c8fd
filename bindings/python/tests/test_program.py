"""The program that the wheel brings: the same output as the program that is built alone."""

import os
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

SPECS = Path(__file__).resolve().parents[3] / "specs"
LESSON = SPECS / "lessons/02-bounce-and-swing.md"
MODULE = [sys.executable, "-m", "labspec"]


def run(command, *arguments):
    return subprocess.run([*command, *map(str, arguments)], capture_output=True)


@pytest.mark.parametrize(
    "arguments",
    [
        ["--version"],
        ["--help"],
        ["check", LESSON, "--no-cache"],
        ["check", LESSON, "--no-cache", "--no-run", "--format", "json"],
        ["run", f"{LESSON}#1", "--until", "0.1", "--format", "csv"],
        ["explain", "unknown-name"],
        ["check", "nothing-here.md"],
        ["frobnicate"],
        ["check", "--models", "\udcff", LESSON],
    ],
)
def test_output_and_exit_code_are_those_of_the_program(program, arguments):
    ours, theirs = run(MODULE, *arguments), run([program], *arguments)
    assert (ours.returncode, ours.stdout, ours.stderr) == (theirs.returncode, theirs.stdout, theirs.stderr)


def test_the_script_is_installed():
    script = Path(sys.executable).with_name("labspec")
    done = run([script], "--version")
    assert done.returncode == 0 and done.stdout.startswith(b"labspec ")


def test_a_reader_may_close_the_pipe():
    child = subprocess.Popen([*MODULE, "explain"], stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    child.stdout.read(1)
    child.stdout.close()
    assert child.wait(timeout=20) == 0 and child.stderr.read() == b""


@pytest.mark.skipif(sys.platform == "win32", reason="signals")
def test_ctrl_c_ends_the_program_as_it_does_alone():
    child = subprocess.Popen([*MODULE, "stability", f"{LESSON}#3", "--until", "10000", "--margins"], stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    time.sleep(2)
    assert child.poll() is None
    os.kill(child.pid, signal.SIGINT)
    assert child.wait(timeout=20) == 130
    assert b"Traceback" not in child.stderr.read()


def test_a_build_for_newer_processors_takes_the_place_of_the_other(tmp_path):
    import labspec
    from labspec import _labspec, _processor

    # This package was built once.
    assert _processor.faster(_labspec) is None
    package = Path(labspec.__file__).parent
    copy = tmp_path / "labspec"
    shutil.copytree(package, copy, ignore=shutil.ignore_patterns("__pycache__"))
    (copy / "x86-64-v3").mkdir()
    shutil.copy(_labspec.__file__, copy / "x86-64-v3")
    code = """if True:
        import labspec
        from labspec import _processor
        built = _processor.faster(labspec._labspec)
        assert built is not None and built is not labspec._labspec
        _processor.use(built)
        from labspec import _labspec
        import labspec._labspec as imported
        assert _labspec is built and imported is built and "x86-64-v3" in built.__file__
        print(built.__VERSION__)
    """
    done = subprocess.run([sys.executable, "-c", code], env={**os.environ, "PYTHONPATH": str(tmp_path)}, capture_output=True, text=True)
    assert (done.stdout.strip(), done.stderr) == (labspec.__version__, "")
