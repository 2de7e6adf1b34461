"""Every stage and what a user would write instead, in one run -> one table: ours, peer, ratio.

Run: pip install -r benches/peers/requirements.txt
     python benches/peers/run.py [--experiment]

Takes about ten minutes on two cores, and five more with --experiment, which times experiment 1 with one simulation.
Ours and its peer run one after the other, ROUNDS times; the table has the medians of both and of their ratios.
"""

import functools
import os
import pathlib
import re
import statistics
import subprocess
import sys
import tempfile

ROUNDS = 3
root = pathlib.Path(__file__).resolve().parent.parent.parent
peers = pathlib.Path(__file__).resolve().parent


def output(*command, **environment):
    result = subprocess.run(command, cwd=root, env=os.environ | environment, capture_output=True, text=True, check=True)
    return result.stdout


@functools.cache
def bench(name, round):
    """What a benchmark prints, once a round."""
    return output("cargo", "bench", "--quiet", "--bench", name)


def seconds(text, pattern, unit=1.0):
    return float(re.search(pattern, text)[1]) * unit


def peer(module, call, **environment):
    code = f"import sys; sys.path.insert(0, {str(peers)!r}); import {module}; print({call})"
    return float(output(sys.executable, "-c", code, **environment))


def simulate(*torque):
    def run(folder, round):
        text = bench("simulate", round)
        ours = seconds(text, r"simulate: ([\d.]+)") + seconds(text, r"sense: ([\d.]+)")
        return ours, float(output(str(folder / "bare_loop"), "1000000", *torque))

    return run


def distance(levels):
    def run(_, round):
        ours = seconds(bench("distance", round), rf"distance, N = {levels}: ([\d.]+)")
        return ours, peer("distance", f"distance.numpy_seconds({levels}, 1)")

    return run


def map_840(_, round):
    ours = seconds(bench("map", round), r"840 sensors.*: ([\d.]+) ms", 1e-3)
    return ours, peer("map", "map.statistics.median(map.eigh(m) for m in [map.distances(840)] * 11)")


def majorisation(_, round):
    ours = seconds(bench("map", round), r"300 steps.*: ([\d.]+) ms", 1e-3)
    return ours, peer("map", "map.smacof(map.distances(840))")


def schema(call):
    def run(_, round):
        ours = seconds(bench("schema", round), r"dpgmm-lj: ([\d.]+) ms", 1e-3)
        return ours, peer("schema", call, OMP_NUM_THREADS="1")

    return run


STAGES = [
    ("simulate + sense", "1,000,000 steps, 100,000 x 840 pressures", "bare loop of dWorldStep, in C", simulate()),
    ("simulate + sense", "the same", "the same, locks limited to 1000 N m", simulate("1000")),
    ("distance", "840 sensors, T = 100,000, N = 4", "NumPy one-hot product", distance(4)),
    ("distance", "the same, N = 8", "NumPy one-hot product", distance(8)),
    ("map", "840 sensors to 15 dimensions", "numpy.linalg.eigh", map_840),
    ("map", "840 sensors to 14 dimensions, 300 steps of majorisation", "scikit-learn's smacof", majorisation),
    ("schema", "a sweep of DPGMM-LJ, n = 840, d = 14, K = 10, one core", "NumPy and SciPy", schema("schema.numpy_seconds()")),
    ("schema", "the same", "an iteration of scikit-learn's BayesianGaussianMixture", schema("schema.sklearn_seconds()")),
]


def main():
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        flags = output("pkg-config", "--cflags", "--libs", "ode").split()
        output("cc", "-O2", str(peers / "bare_loop.c"), "-o", str(folder / "bare_loop"), *flags)
        print("| stage | work | ours, s | peer | peer, s | peer / ours |\n|---|---|---|---|---|---|")
        for stage, work, other, run in STAGES:
            pairs = [run(folder, round) for round in range(ROUNDS)]
            ours, theirs = (statistics.median(times) for times in zip(*pairs))
            ratio = statistics.median(theirs / ours for ours, theirs in pairs)
            print(f"| {stage} | {work} | {ours:.3g} | {other} | {theirs:.3g} | {ratio:.3g} |", flush=True)
        if "--experiment" in sys.argv:
            log = subprocess.run(
                ["/usr/bin/time", "-f", "%e s, %M kB", "cargo", "run", "--quiet", "--release", "--", "reproduce"]
                + ["exp1", "--simulations", "1", "--out", str(folder / "exp1")],
                cwd=root, capture_output=True, text=True,
            )
            print(f"\nExperiment 1 with one simulation: {log.stderr.strip().splitlines()[-1]}")


if __name__ == "__main__":
    main()
