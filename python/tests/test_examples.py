"""The examples do with a user's own files what they say, and a page that is not theirs is found.

Without a file of one's own, reproduce/examples.py executes them: .ci/run compares what they print and draw with their pages.
"""

import importlib.util
import runpy
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from conftest import ROOT

EXAMPLES = ROOT / "python/examples"


@pytest.fixture(autouse=True)
def alone(monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("MPLBACKEND", "agg")


def run(name, monkeypatch, *arguments, changed=()):
    """The variables of an example after it has run, with other text in some places."""
    source = (EXAMPLES / name).read_text(encoding="utf-8")
    for old, new in changed:
        assert old in source, old
        source = source.replace(old, new)
    copy = Path(name).resolve()
    copy.write_text(source, encoding="utf-8")
    monkeypatch.setattr(sys, "argv", [name, *map(str, arguments)])
    monkeypatch.setattr("tempfile.mkdtemp", lambda: str(copy.parent))
    return runpy.run_path(str(copy))


@pytest.mark.filterwarnings("ignore::UserWarning")
def test_one_s_own_robot(monkeypatch, capsys, tmp_path):
    pytest.importorskip("matplotlib")
    pytest.importorskip("rosbags")
    short = [('"star", duration=500', '"chain-3", duration=120')]
    mcap = [("import Writer", "import StoragePlugin, Writer"), ("version=9", "version=9, storage_plugin=StoragePlugin.MCAP")]
    simulated = run("own_robot.py", monkeypatch, changed=short + mcap)
    assert "fit: good" in capsys.readouterr().out and simulated["score"].tree_correct
    # The same again as a user's own: the folder, its file in MCAP alone, one topic of it, and a table.
    for recording in [tmp_path / "recording", tmp_path / "recording/recording.mcap"]:
        own = run("own_robot.py", monkeypatch, recording)
        assert own["truth"] is None and np.array_equal(own["touch"], simulated["touch"], equal_nan=True)
    own = run("own_robot.py", monkeypatch, tmp_path / "recording", "/skin/board_1")
    assert own["touch"].shape[1] == 96 and not np.isnan(own["touch"]).any()
    np.savetxt(tmp_path / "mine.csv", simulated["touch"], delimiter=",")
    assert np.array_equal(run("own_robot.py", monkeypatch, tmp_path / "mine.csv")["found"].parts, simulated["found"].parts)
    with pytest.raises(SystemExit, match="none of these topics can be read: /barometer_0, "):
        run("own_robot.py", monkeypatch, tmp_path / "recording", "/skin")

    # By hand: a lost message, times that are uneven and out of order, a topic of twice as many messages, and one that begins late.
    clock, lost = np.array([0.0, 1.02, 2.0, 3.01]), np.array([0.01, 3.0, 2.03])
    double, late = np.arange(0.1, 4.0, 0.5), np.array([2.0, 3.0, 4.0, 5.0])
    touch, seconds = own["in_rows"]({name: (at, 10 * at[:, None]) for name, at in zip("abcd", (clock, double, late, clock))})
    assert np.allclose(seconds, clock) and np.allclose(touch[:, 0], 10 * clock) and touch.shape == (4, 4)
    assert np.allclose(touch[:, 1], [1.0, 11.0, 21.0, 31.0]) and np.allclose(touch[:, 2], [np.nan, np.nan, 20, 30], equal_nan=True)
    touch, seconds = own["in_rows"]({"a": (clock, clock[:, None]), "b": (lost, lost[:, None])})
    assert np.allclose(touch, [[0.0, 0.01], [2.0, 2.03], [3.01, 3.0]]) and np.allclose(seconds, [0.0, 2.02, 2.99])


@pytest.mark.filterwarnings("ignore::UserWarning")
def test_another_walk(monkeypatch, capsys):
    pytest.importorskip("matplotlib")
    moved = run("felt_walk.py", monkeypatch, ROOT / "tests/data/movement/arms.bvh")["moved"]
    out = capsys.readouterr().out
    assert f"100 samples of {len(moved.parts)} sensors, 2.0 s" in out and "adjusted Rand index" in out


def test_the_walk_is_the_one_that_is_made(tmp_path):
    subprocess.run([sys.executable, ROOT / "reproduce/walk.py", tmp_path / "walk.bvh"], check=True)
    assert (tmp_path / "walk.bvh").read_bytes() == (EXAMPLES / "walk.bvh").read_bytes()


def test_every_example_has_a_page():
    names = sorted(path.stem for path in EXAMPLES.glob("*.py"))
    assert names == ["felt_walk", "own_robot", "paper_in_five_minutes"]
    assert sorted(path.stem for path in (ROOT / "docs/shown/examples").glob("*.md")) == names


EXAMPLE = '''\
# %% [markdown]
"""
# Title

Text.
"""

# %%
import warnings

import matplotlib.pyplot as plt

print("printed")
warnings.warn("take care")
plt.plot([0, 1])
plt.gca().set(title="A line")
plt.show()
'''


def test_a_page_that_is_not_the_example_s_is_found(monkeypatch, capsys, tmp_path):
    for needed in ["jupytext", "nbclient", "ipykernel", "matplotlib"]:
        pytest.importorskip(needed)
    spec = importlib.util.spec_from_file_location("examples", ROOT / "reproduce/examples.py")
    examples = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(examples)
    pages = tmp_path / "docs/shown/examples"
    places = {"ROOT": tmp_path, "EXAMPLES": tmp_path / "python", "PAGES": pages, "KIND": pages / "kind.txt"}
    for name, value in {**places, "NOTEBOOKS": ["line"]}.items():
        monkeypatch.setattr(examples, name, value)
    (tmp_path / "python").mkdir()
    (tmp_path / "python/line.py").write_text(EXAMPLE)

    def status(*arguments):
        monkeypatch.setattr(sys, "argv", ["examples.py", *arguments])
        return examples.main()

    assert status() == 1 and "line.md is not what the example makes" in capsys.readouterr().err
    assert status("--write") == 0 and status("--check") == 0
    page = (pages / "line.md").read_text()
    assert page.startswith("# Title\n\nThis page is made by ") and (pages / "line-1.png").read_bytes()[1:4] == b"PNG"
    assert page.endswith("```text\nUserWarning: take care\n```\n\n```text\nprinted\n```\n\n![A line](line-1.png)\n")
    # Another output, another text, and a page without an example; the first is not compared on another kind of machine.
    (pages / "line.md").write_text(page.replace("\nprinted\n", "\nwritten\n"))
    assert status() == 1 and "-written" in capsys.readouterr().err
    monkeypatch.setattr(examples, "kind_of_machine", lambda: "another\n")
    assert status() == 0
    (pages / "line.md").write_text(page.replace("Text.", "Words."))
    assert status() == 1
    (pages / "line.md").write_text(page)
    (pages / "gone.md").write_text("")
    assert status() == 1 and "gone.md" in capsys.readouterr().err
    (tmp_path / "python/line.py").write_text(EXAMPLE + "\nraise ValueError\n")
    assert status() == 1 and "line.py fails" in capsys.readouterr().err
