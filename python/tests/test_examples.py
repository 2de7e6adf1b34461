"""The examples run, and find what they say."""

import runpy
import shutil
import sys
from pathlib import Path

import pytest

EXAMPLES = Path(__file__).resolve().parents[1] / "examples"


@pytest.fixture(autouse=True)
def alone(monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("tempfile.mkdtemp", lambda: str(tmp_path))


def run(name, monkeypatch, *arguments, shorter=()):
    """Runs an example, with less of what takes time."""
    source = (EXAMPLES / name).read_text(encoding="utf-8")
    for long, short in shorter:
        assert long in source, long
        source = source.replace(long, short)
    copy = Path(name).resolve()
    copy.write_text(source, encoding="utf-8")
    monkeypatch.setattr(sys, "argv", [name, *map(str, arguments)])
    runpy.run_path(str(copy))


def test_the_paper(monkeypatch, capsys):
    pytest.importorskip("sklearn")
    run("paper_in_five_minutes.py", monkeypatch, shorter=[("duration=10_000", "duration=500"), ("n_chains=100", "n_chains=3")])
    out = capsys.readouterr().out
    assert "DPGMM-LJ: " in out and "DPGMM:    " in out and "KMeans(random_state=1): adjusted" in out


def test_one_s_own_robot(monkeypatch, capsys, tmp_path):
    pytest.importorskip("networkx")
    run("own_robot.py", monkeypatch, shorter=[('"star", duration=500', '"chain-3", duration=100')])
    out = capsys.readouterr().out
    assert "fit: good" in out and "adjusted Rand index 1.000, tree right" in out
    assert (tmp_path / "recording.html").read_text(encoding="utf-8").count("<svg") == 2
    shutil.move(tmp_path / "recording.csv", tmp_path / "mine.csv")
    run("own_robot.py", monkeypatch, tmp_path / "mine.csv")
    assert "adjusted Rand index" not in capsys.readouterr().out


def test_every_example_is_here():
    assert sorted(path.name for path in EXAMPLES.glob("*.py")) == ["own_robot.py", "paper_in_five_minutes.py"]
