"""The source keeps its promises to tools: complete types, and the oldest Python that pyproject.toml names."""

import os
import re
import shutil
import subprocess
import sys

import pytest
from conftest import ROOT

OLDEST = re.search(r'requires-python = ">=(3\.\d+)"', (ROOT / "pyproject.toml").read_text()).group(1)


def run(tool, *arguments):
    """The exit status and output of a tool; a test of it is skipped where it is not installed, but not in CI."""
    program = shutil.which(tool, path=os.path.dirname(sys.executable)) or shutil.which(tool)
    if program is None:
        if os.environ.get("CI"):
            raise FileNotFoundError(tool)
        pytest.skip(f"{tool} is not installed: pip install -r python/requirements.txt")
    done = subprocess.run([program, *map(str, arguments)], cwd=ROOT, capture_output=True, text=True, check=False)
    return done.returncode, done.stdout + done.stderr


def test_types_are_complete_and_right(tmp_path):
    checked = ["--config-file", "pyproject.toml", "--cache-dir", ROOT / "target/mypy"]
    status, said = run("mypy", *checked, "python/bodyschema")
    assert status == 0, said
    (tmp_path / "untyped.py").write_text("def half(number):\n    return number / 2\n")
    status, said = run("mypy", *checked, tmp_path / "untyped.py")
    assert status == 1 and "Function is missing a type annotation" in said


def test_the_oldest_python_can_run_it(tmp_path):
    # Annotations are not evaluated, and a stub is not run.
    check = [f"-t={OLDEST}-", "--violations", "--no-tips", "--no-eval-annotations"]
    status, said = run("vermin", *check, "python/bodyschema", "python/examples")
    assert status == 0, said
    (tmp_path / "young.py").write_text("match 1:\n    case 1:\n        pass\n")
    status, said = run("vermin", *check, tmp_path)
    assert status == 1 and "3.10" in said
