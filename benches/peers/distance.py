"""Pressures and symbols of full size -> the time that NumPy takes to load, quantise and compare them, and scikit-learn to compare them, in
seconds, as src/files, src/stages/quantise.rs and src/stages/distance do.

Run: pip install -r benches/peers/requirements.txt
     python benches/peers/distance.py
"""

import time

import numpy as np

SENSORS, SAMPLES = 840, 100_000
CHUNK = 20_000  # samples whose one-hot code is in memory at a time: 0.5 GB at N = 8
PAIRS = 50  # of which scikit-learn's time is extrapolated


def symbols(levels, seed=1):
    """T x M: half of the samples are 0, the others equally often any other, like symbols of pressures."""
    rng = np.random.default_rng(seed)
    felt = rng.random((SAMPLES, SENSORS), dtype=np.float32) < 0.5
    return felt * rng.integers(1, levels, (SAMPLES, SENSORS), dtype=np.uint8)


def one_hot_metric(series, levels):
    """H(X|Y) + H(Y|X) = 2 H(X, Y) - H(X) - H(Y) of all pairs, in bits, from one matrix product."""
    samples, sensors = series.shape
    joint = np.zeros((sensors * levels, sensors * levels), dtype=np.float32)  # exact below 2^24
    for start in range(0, samples, CHUNK):
        chunk = series[start : start + CHUNK, :, None]
        code = (chunk == np.arange(levels, dtype=np.uint8)).astype(np.float32).reshape(len(chunk), -1)
        joint += code.T @ code
    p = joint.reshape(sensors, levels, sensors, levels) / np.float32(samples)
    both = -(p * np.log2(p, out=np.zeros_like(p), where=p > 0)).sum(axis=(1, 3), dtype=np.float64)
    one = np.diag(both)  # H(X, X) = H(X)
    return 2 * both - one[:, None] - one


def numpy_seconds(levels, measurements=2):
    """Least time of the metric by a one-hot matrix product."""
    series = symbols(levels)
    return least(lambda: one_hot_metric(series, levels), measurements)


def quantised(pressures, levels, scheme):
    """Level 0 is no pressure; the others share the positive pressures equally, as `bodyschema distance` has it: those of all sensors
    together (pooled), or of each sensor (per-sensor)."""
    symbols = np.zeros(pressures.shape, dtype=np.uint8)
    limits_of = lambda felt: np.quantile(felt, np.arange(1, levels - 1) / (levels - 1))
    pooled = limits_of(pressures[pressures > 0]) if scheme == "pooled" else None
    for sensor, series in enumerate(pressures.T):
        felt = series[series > 0]
        if len(felt):
            limits = limits_of(felt) if pooled is None else pooled
            symbols[:, sensor] = (series > 0) * (1 + np.searchsorted(limits, series, side="right"))
    return symbols


def command(tactile, levels, scheme, out):
    """What a user would write in place of `bodyschema distance`: a file of pressures -> a file of distances."""
    np.save(out, one_hot_metric(quantised(np.load(tactile), levels, scheme), levels))


def load_seconds(tactile):
    """Least time of reading a file of pressures."""
    return least(lambda: np.load(tactile))


def quantise_seconds(tactile, levels, scheme):
    """Least time of quantising pressures that are read."""
    pressures = np.load(tactile)
    return least(lambda: quantised(pressures, levels, scheme))


def least(work, measurements=3):
    def measure():
        start = time.perf_counter()
        work()
        return time.perf_counter() - start

    return min(measure() for _ in range(measurements))


def sklearn_seconds(levels):
    """Time of mutual_info_score on PAIRS pairs of sensors, extrapolated to all pairs, on one core."""
    import sklearn.metrics

    series = np.ascontiguousarray(symbols(levels).T)
    start = time.perf_counter()
    for pair in range(PAIRS):
        sklearn.metrics.mutual_info_score(series[pair], series[pair + 1])
    return (time.perf_counter() - start) / PAIRS * (SENSORS * (SENSORS - 1) / 2)


if __name__ == "__main__":
    for levels in (4, 8):
        print(f"NumPy one-hot product, N = {levels}: {numpy_seconds(levels):.2f} s", flush=True)
        print(
            f"scikit-learn mutual_info_score, N = {levels}: {sklearn_seconds(levels):.0f} s (extrapolated from {PAIRS} pairs)",
            flush=True,
        )
