"""What the tests share."""

import os
import subprocess
from pathlib import Path

import numpy as np
import pytest

import bodyschema

ROOT = Path(__file__).resolve().parents[2]
BINARY = Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target")) / "release" / "bodyschema"


@pytest.fixture(scope="session")
def small_body(tmp_path_factory):
    """The file of a body of three parts with 16 sensors each."""
    path = tmp_path_factory.mktemp("body") / "small.toml"
    path.write_text((ROOT / "bodies/chain-3.toml").read_text().replace("sensors = 40", "sensors = 16"))
    return path


@pytest.fixture(scope="session")
def moved(small_body):
    """What it feels, while it moves enough for its parts to be found."""
    return bodyschema.simulate(small_body, duration=100, coordination=0.0, random_state=1)


@pytest.fixture(scope="session")
def found(moved):
    return bodyschema.estimate(moved.touch, interval=moved.interval, n_jobs=2, progress=False)


@pytest.fixture(scope="session")
def command():
    """Runs the command line; a test of it is skipped where it is not built, but not in CI."""
    if not BINARY.exists():
        if os.environ.get("CI"):
            raise FileNotFoundError(BINARY)
        pytest.skip(f"{BINARY} is not built: cargo build --release")

    def run(*arguments):
        done = subprocess.run([BINARY, *map(str, arguments)], capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stderr
        return done.stdout

    return run


def same(a, b):
    """Whether two arrays or results have the same bits."""
    if isinstance(a, np.ndarray):
        return a.dtype == b.dtype and a.shape == b.shape and a.tobytes() == b.tobytes()
    if hasattr(a, "__dataclass_fields__"):
        return all(same(getattr(a, name), getattr(b, name)) for name in a.__dataclass_fields__)
    if isinstance(a, list):
        return len(a) == len(b) and all(map(same, a, b))
    return a == b
