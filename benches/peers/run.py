"""Every stage and what a user would write instead, in one run -> one table: ours, peer, ratio.

Run: pip install -r benches/peers/requirements.txt
     python benches/peers/run.py [--experiment] [--rounds N]

Takes about six minutes a round on two cores, and five more with --experiment, which times experiment 1 with one simulation.
Ours and its peer run one after the other, three times or as --rounds says; the table has the medians of both and of their ratios, with
the lowest and the highest ratio.
"""

import functools
import os
import pathlib
import re
import statistics
import subprocess
import sys
import tempfile
import time

ROUNDS = int(sys.argv[1 + sys.argv.index("--rounds")]) if "--rounds" in sys.argv else 3
root = pathlib.Path(__file__).resolve().parent.parent.parent
peers = pathlib.Path(__file__).resolve().parent
program = pathlib.Path(os.environ.get("CARGO_TARGET_DIR", root / "target")) / "release/bodyschema"


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


def simulate(controller, *torque):
    def run(folder, round):
        text = bench("simulate", round)
        ours = sum(seconds(text, rf"{stage}, {controller}: ([\d.]+)") for stage in ("simulate", "sense"))
        return ours, float(output(str(folder / "bare_loop"), "1000000", *torque))

    return run


def distance(levels):
    def run(_, round):
        ours = seconds(bench("distance", round), rf"distance, N = {levels}: ([\d.]+)")
        return ours, peer("distance", f"distance.numpy_seconds({levels}, 1)")

    return run


def clocked(*command):
    start = time.perf_counter()
    output(*map(str, command))
    return time.perf_counter() - start


@functools.cache
def whole(folder, levels, scheme, round):
    """Seconds of `bodyschema distance` from file to file."""
    options = ["--levels", levels, "--scheme", scheme, "--out", folder / "distance.npy"]
    return clocked(program, "distance", folder / "body/tactile.npy", *options)


def command(levels, scheme):
    def run(folder, round):
        call = f"distance.command({str(folder / 'body/tactile.npy')!r}, {levels}, {scheme!r}, {str(folder / 'peer.npy')!r})"
        code = f"import sys; sys.path.insert(0, {str(peers)!r}); import distance; {call}"
        return whole(folder, levels, scheme, round), clocked(sys.executable, "-c", code)

    return run


def levels(count):
    """The same with other numbers of levels, beside 4."""
    return lambda folder, round: (whole(folder, 4, POOLED, round), whole(folder, count, POOLED, round))


def map_840(function):
    def run(_, round):
        ours = seconds(bench("map", round), r"840 sensors.*: ([\d.]+) ms", 1e-3)
        return ours, peer("map", f"map.statistics.median(map.{function}(m) for m in [map.distances(840)] * 11)")

    return run


def majorisation(_, round):
    ours = seconds(bench("map", round), r"300 steps.*: ([\d.]+) ms", 1e-3)
    return ours, peer("map", "map.smacof(map.distances(840))")


def nonmetric(_, round):
    ours = seconds(bench("map", round), r"nonmetric.*: ([\d.]+) ms", 1e-3)
    return ours, peer("map", "map.nonmetric(map.distances(840))")


def schema(call, sampler=""):
    def run(_, round):
        ours = seconds(bench("schema", round), rf"dpgmm-lj{sampler}: ([\d.]+) ms", 1e-3)
        return ours, peer("schema", call, OMP_NUM_THREADS="1")

    return run


# Limits of levels for all sensors together, the default, and for each sensor.
POOLED, OWN = "pooled", "per-sensor"

STAGES = [
    ("simulate + sense", "1,000,000 steps, 100,000 x 840 pressures, torque", "bare loop of dWorldStep, in C", simulate("torque")),
    ("simulate + sense", "the same, servo", "the same", simulate("servo")),
    ("simulate + sense", "the same, servo", "the same, locks limited to 1000 N m", simulate("servo", "1000")),
    ("`bodyschema distance`", "a file of 336 MB of a body, N = 4, to a file", "NumPy, from file to file", command(4, POOLED)),
    ("`bodyschema distance`", "the same, N = 8", "NumPy, from file to file", command(8, POOLED)),
    ("`bodyschema distance`", "the same, N = 8, limits of levels for each sensor", "NumPy, from file to file", command(8, OWN)),
    *(("`bodyschema distance`", "the same, N = 4", f"itself at N = {count}", levels(count)) for count in (2, 8, 10, 16, 32, 64, 128, 256)),
    ("distance", "840 sensors, T = 100,000, N = 4", "NumPy one-hot product", distance(4)),
    ("distance", "the same, N = 8", "NumPy one-hot product", distance(8)),
    ("map", "840 sensors to 15 dimensions", "numpy.linalg.eigh", map_840("eigh")),
    ("map", "the same", "scipy.linalg.eigh, 15 pairs by LAPACK's dsyevr", map_840("dsyevr")),
    ("map", "the same", "scipy.sparse.linalg.eigsh, 15 pairs by ARPACK", map_840("eigsh")),
    ("map", "840 sensors to 14 dimensions, 300 steps of majorisation", "scikit-learn's smacof", majorisation),
    ("map", "the same, 30 nonmetric steps", "scikit-learn's smacof", nonmetric),
    ("schema", "a sweep of DPGMM-LJ, n = 840, d = 14, K = 10, one core", "NumPy and SciPy", schema("schema.numpy_seconds()")),
    ("schema", "the same", "an iteration of scikit-learn's BayesianGaussianMixture", schema("schema.sklearn_seconds()")),
    ("schema", "a sweep as the authors' code has it, the same", "NumPy and SciPy", schema("schema.numpy_seconds()", ", authors-code")),
]


def main():
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        flags = output("pkg-config", "--cflags", "--libs", "ode").split()
        output("cc", "-O2", str(peers / "bare_loop.c"), "-o", str(folder / "bare_loop"), *flags)
        output("cargo", "build", "--quiet", "--release", "--locked")
        output(str(program), "simulate", "--out", str(folder / "body"))
        print("| stage | work | ours, s | peer | peer, s | peer / ours |\n|---|---|---|---|---|---|")
        for stage, work, other, run in STAGES:
            pairs = [run(folder, round) for round in range(ROUNDS)]
            ours, theirs = (statistics.median(times) for times in zip(*pairs))
            ratios = [theirs / ours for ours, theirs in pairs]
            ratio = f"{statistics.median(ratios):.3g} ({min(ratios):.3g} to {max(ratios):.3g})"
            print(f"| {stage} | {work} | {ours:.3g} | {other} | {theirs:.3g} | {ratio} |", flush=True)
        if "--experiment" in sys.argv:
            log = subprocess.run(
                ["/usr/bin/time", "-f", "%e s, %M kB", "cargo", "run", "--quiet", "--release", "--", "reproduce"]
                + ["exp1", "--simulations", "1", "--out", str(folder / "exp1")],
                cwd=root, capture_output=True, text=True,
            )
            print(f"\nExperiment 1 with one simulation: {log.stderr.strip().splitlines()[-1]}")


if __name__ == "__main__":
    main()
