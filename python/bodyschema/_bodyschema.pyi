from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

BODIES: list[str]
REVISION: str
SEED: int

_Tell = Callable[[int], Any] | None
_Said = tuple[bool | None, bool]
_Asked = tuple[int, dict[str, float]]

def read_touch(path: str, reading: dict[str, Any], jobs: int) -> tuple[NDArray[np.float32], float | None, list[str]]: ...
def estimate(
    touch: NDArray[np.float32] | NDArray[np.float64], said: _Said, asked: _Asked, again: tuple[int, bool], jobs: int, progress: _Tell
) -> dict[str, Any]: ...
def tree(
    touch: NDArray[np.float32] | NDArray[np.float64],
    labels: list[int],
    rank: int | None,
    said: _Said,
    seed: int,
    jobs: int,
) -> dict[str, Any]: ...
def place(
    touch: NDArray[np.float32] | NDArray[np.float64],
    parts: list[int],
    tree: list[tuple[int, int]],
    sites: list[tuple[list[float], list[float]]],
    frames: list[int],
    signed: bool | None,
    keep_saturated: bool,
    jobs: int,
) -> dict[str, Any]: ...
def simulate(name: str | None, changes: str, seed: int, jobs: int, progress: _Tell) -> dict[str, Any]: ...
def play(name: str | None, changes: str, recording: dict[str, Any], jobs: int) -> dict[str, Any]: ...
def import_body(source: str, out: str, options: dict[str, Any]) -> list[str]: ...
def quantise(touch: NDArray[np.float32] | NDArray[np.float64], changes: str, jobs: int) -> NDArray[np.uint8]: ...
def information_metric(symbols: NDArray[np.uint8], jobs: int) -> NDArray[np.float64]: ...
def body_map(distances: NDArray[np.float64], dims: int, changes: str, seed: int, jobs: int) -> NDArray[np.float64]: ...
def infer(
    points: NDArray[np.float64], latent_joints: bool, changes: str, seed: int, jobs: int, progress: _Tell
) -> dict[str, Any]: ...
def cluster(
    points: NDArray[np.float64], method: str, clusters: int, restarts: int, seed: int, jobs: int
) -> NDArray[np.int64]: ...
def score(
    labels: list[int],
    tree: list[tuple[int, int]],
    true_labels: list[int],
    true_tree: list[tuple[int, int]],
    eligible_ari: float,
) -> tuple[float, bool, bool]: ...
