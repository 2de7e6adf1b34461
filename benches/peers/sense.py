"""Velocities of parts -> the time that NumPy takes to the pressures on their sensors, in seconds. src/stages/sense.rs begins earlier, with
poses, so that this favours NumPy.

Run: pip install -r benches/peers/requirements.txt
     python benches/peers/sense.py
"""

import numpy as np
from distance import least

PARTS, SENSORS, SAMPLES, DENSITY = 5, 168, 100_000, 1010.0


def felt(velocities, spins, places, normals):
    """Equation 27: the pressure of the fluid on each sensor, from what its part does in its own frame, T x M."""
    tactile = np.empty((len(velocities), len(velocities[0]) * len(places)), dtype=np.float32)
    for part in range(PARTS):
        # n . (v + w x r) = n . v + (r x n) . w
        speeds = velocities[:, part] @ normals.T + spins[:, part] @ np.cross(places, normals).T
        tactile[:, part * SENSORS : (part + 1) * SENSORS] = DENSITY * np.maximum(speeds, 0) ** 2
    return tactile


def seconds():
    rng = np.random.default_rng(1)
    velocities, spins = rng.normal(size=(2, SAMPLES, PARTS, 3))
    places, normals = rng.normal(size=(2, SENSORS, 3))
    return least(lambda: felt(velocities, spins, places, normals))


if __name__ == "__main__":
    print(f"{seconds():.3f} s")
