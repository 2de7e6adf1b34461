"""Every stage beside what a user would write instead, and beside the least that this machine needs, in one table.

Run: pip install -r benches/peers/requirements.txt
     python benches/peers/run.py [--rounds N] [--only WORD] [--experiments] [--clone] [--write]

Ours and its peer run one after the other, three times or as --rounds says; the table has the medians of both and of their ratios, with
the lowest and the highest ratio. Memory is the peak of a whole process; rows of a stage alone have none. The least time is what floors.c
measures here for the reading, writing, counting, multiplying and adding that the work cannot do without. Takes about eight minutes a round
on two cores. --only takes the rows of a stage or of work that has the word. --experiments also times both experiments with 20 simulations
each, some 20 minutes, and --clone a fresh clone up to its first table, which builds everything. --write puts the table into
benches/README.md.
"""

import argparse
import functools
import importlib.metadata
import os
import pathlib
import re
import statistics
import subprocess
import sys
import tempfile
import time
from typing import NamedTuple

root = pathlib.Path(__file__).resolve().parent.parent.parent
peers = pathlib.Path(__file__).resolve().parent
program = pathlib.Path(os.environ.get("CARGO_TARGET_DIR", root / "target")) / "release/bodyschema"


class Cost(NamedTuple):
    seconds: float
    mib: float | None = None


def output(*command, **environment):
    result = subprocess.run(
        [str(word) for word in command], cwd=root, env=os.environ | environment, capture_output=True, text=True, check=True
    )
    return result.stdout


def clocked(*command):
    """What a whole process costs, with the peak of its memory."""
    start = time.perf_counter()
    process = subprocess.Popen([str(word) for word in command], cwd=root, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
    said = process.stderr.read()
    _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode != 0:
        sys.exit(f"run: {command}: {said.decode()}")
    return Cost(time.perf_counter() - start, usage.ru_maxrss / 1024)


@functools.cache
def bench(name, round):
    """What a benchmark prints, once a round."""
    return output("cargo", "bench", "--quiet", "--bench", name)


def seconds(text, pattern, unit=1.0):
    return Cost(float(re.search(pattern, text)[1]) * unit)


def peer(module, call, **environment):
    code = f"import sys; sys.path.insert(0, {str(peers)!r}); import {module}; print({call})"
    return Cost(float(output(sys.executable, "-c", code, **environment)))


@functools.cache
def least(folder):
    """What floors.c measures: seconds by name, the least of three."""
    texts = [output(folder / "floors", folder / "body/tactile.npy") for _ in range(3)]
    lines = [line.split() for text in texts for line in text.splitlines()]
    return {name: min(float(value) for other, value in lines if other == name) for name, _ in lines}


def floor(*names):
    return lambda folder: sum(least(folder)[name] for name in names)


def multiply_adds(count, cores=2):
    """Seconds of so many multiplications and additions; floors.c does a billion on each core."""
    return lambda folder: least(folder)["multiply-add"] * count / 1e9 / cores


def simulate(controller, *torque):
    def run(folder, round):
        ours = seconds(bench("simulate", round), rf"simulate, {controller}: ([\d.]+)")
        return ours, Cost(float(output(folder / "bare_loop", 1_000_000, *torque)))

    return run


def sense(folder, round):
    return seconds(bench("distance", round), r"sense: ([\d.]+)"), peer("sense", "sense.seconds()")


def distance(levels):
    def run(_, round):
        ours = seconds(bench("distance", round), rf"distance, N = {levels}: ([\d.]+)")
        return ours, peer("distance", f"distance.numpy_seconds({levels}, 1)")

    return run


def quantise(folder, round):
    ours = seconds(bench("distance", round), r"quantise, N = 8: ([\d.]+)")
    return ours, peer("distance", f"distance.quantise_seconds({str(folder / 'body/tactile.npy')!r}, 8, {POOLED!r})")


def read(folder, round):
    ours = seconds(bench("distance", round), r"read: ([\d.]+)")
    return ours, peer("distance", f"distance.load_seconds({str(folder / 'body/tactile.npy')!r})")


@functools.cache
def whole(folder, levels, scheme, round):
    """`bodyschema distance` from file to file."""
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


@functools.cache
def estimate(folder, body, round):
    """`bodyschema estimate` from file to files."""
    felt = folder / body
    truth = ["--labels", felt / "labels.csv", "--tree", felt / "tree.csv"]
    return clocked(program, "estimate", felt / "tactile.npy", *truth, "--seed", 1, "--force", "--out", folder / f"found-{body}-{round}")


def parts(folder, round):
    felt = folder / "body"
    theirs = clocked(sys.executable, peers / "estimate.py", felt / "tactile.npy", felt / "labels.csv")
    return estimate(folder, "body", round), theirs


def ten_times(folder, round):
    return estimate(folder, "large", round), estimate(folder, "body", round)


def arm(folder, round):
    """1,000 s of an arm of eight links that have 46 shapes, and of one whose links have one each."""
    move = lambda name: clocked(program, "simulate", "--body", folder / f"{name}.toml", "--duration", 1000, "--out", folder / name)
    return move("arm-46"), move("arm-8")


def mjcf(shapes):
    """A chain of links 0.3 m long, each of so many capsules in a row, 2 cm apart."""
    text, ends = "", ""
    for link, count in enumerate(shapes):
        length = 0.24 / count
        geoms = "".join(
            f'<geom type="capsule" size="0.03" fromto="0 0 {0.03 + at * length} 0 0 {0.03 + at * length + 0.5 * length}" mass="{1 / count}"/>'
            for at in range(count)
        )
        joint = '<joint type="hinge" axis="1 0 0"/><joint type="hinge" axis="0 1 0"/>' if link else "<freejoint/>"
        text += f'<body pos="0 0 {0.3 if link else 0}">{joint}{geoms}'
        ends += "</body>"
    return f"<mujoco><worldbody>{text}{ends}</worldbody></mujoco>"


# Limits of levels for all sensors together, the default, and for each sensor.
POOLED, OWN = "pooled", "per-sensor"
NUMPY = "NumPy, from file to file"

# Stage, work, what a user would do instead, how to measure both, and the least seconds where something tells them.
ROWS = [
    ("simulate", "1,000,000 steps, torque", "bare loop of dWorldStep, in C", simulate("torque"), None),
    ("simulate", "the same, servo", "the same", simulate("servo"), None),
    ("simulate", "the same, servo", "the same, locks limited to 1000 N m", simulate("servo", "1000"), None),
    ("simulate", "the same, servo, in a fluid that pushes", "the same, at rest", simulate("servo in a fluid that pushes"), None),
    ("simulate", "an arm of 46 shapes on 8 links, 1,000 s, file to files", "one of 8 shapes", arm, None),
    ("sense", "100,000 x 840 pressures", "NumPy", sense, floor("pages")),
    (
        "`bodyschema distance`",
        "a file of 336 MB of a body, N = 4, to a file",
        NUMPY,
        command(4, POOLED),
        floor("read", "pages", "compare", "count-4"),
    ),
    ("`bodyschema distance`", "the same, N = 8", NUMPY, command(8, POOLED), floor("read", "pages", "compare", "count-8")),
    (
        "`bodyschema distance`",
        "the same, N = 8, limits of levels for each sensor",
        NUMPY,
        command(8, OWN),
        floor("read", "pages", "compare", "count-8"),
    ),
    *(
        ("`bodyschema distance`", "the same, N = 4", f"itself at N = {count}", levels(count), None)
        for count in (2, 8, 10, 16, 32, 64, 128, 256)
    ),
    ("read", "the file", "numpy.load", read, floor("read", "pages")),
    ("quantise", "what was read, N = 8, limits for all sensors together", "NumPy", quantise, floor("compare")),
    ("distance", "840 sensors, T = 100,000, N = 4", "NumPy one-hot product", distance(4), floor("count-4")),
    ("distance", "the same, N = 8", "NumPy one-hot product", distance(8), floor("count-8")),
    ("map", "840 sensors to 15 dimensions", "numpy.linalg.eigh", map_840("eigh"), multiply_adds(0.25e9)),
    ("map", "the same", "scipy.linalg.eigh, 15 pairs by LAPACK's dsyevr", map_840("dsyevr"), multiply_adds(0.25e9)),
    ("map", "the same", "scipy.sparse.linalg.eigsh, 15 pairs by ARPACK", map_840("eigsh"), multiply_adds(0.25e9)),
    ("map", "840 sensors to 14 dimensions, 300 steps of majorisation", "scikit-learn's smacof", majorisation, None),
    ("map", "the same, 30 nonmetric steps", "scikit-learn's smacof", nonmetric, None),
    (
        "schema",
        "a sweep of DPGMM-LJ, n = 840, d = 14, K = 10, one core",
        "NumPy and SciPy",
        schema("schema.numpy_seconds()"),
        multiply_adds(0.9e6, 1),
    ),
    (
        "schema",
        "the same",
        "an iteration of scikit-learn's BayesianGaussianMixture",
        schema("schema.sklearn_seconds()"),
        multiply_adds(0.9e6, 1),
    ),
    (
        "schema",
        "a sweep as the authors' code has it, the same",
        "NumPy and SciPy",
        schema("schema.numpy_seconds()", ", authors-code"),
        None,
    ),
    (
        "`bodyschema estimate`",
        "a file of 840 x 100,000, parts and tree",
        "NumPy and scikit-learn, the parts alone, their number known",
        parts,
        None,
    ),
    ("`bodyschema estimate`", "the same, 8,400 sensors", "itself with 840", ten_times, None),
]


def main():
    parser = argparse.ArgumentParser(description="Time every stage beside what a user would write instead.")
    parser.add_argument("--rounds", type=int, default=3, help="how often each row is measured")
    parser.add_argument("--only", default="", metavar="WORD", help="only rows of a stage or work that has this word")
    parser.add_argument("--experiments", action="store_true", help="also both experiments, 20 simulations each")
    parser.add_argument("--clone", action="store_true", help="also a fresh clone up to its first table")
    parser.add_argument("--write", action="store_true", help="put the table into benches/README.md")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        lines = []
        for line in table(pathlib.Path(name), arguments):
            print(line, flush=True)
            lines.append(line)
    if arguments.write:
        page = peers.parent / "README.md"
        start, end = "<!-- peers -->\n", "<!-- /peers -->"
        before, rest = page.read_text().split(start)
        page.write_text(before + start + "\n".join(lines) + "\n" + end + rest.split(end)[1])


def table(folder, arguments):
    """The lines of the table, and under what they were measured."""
    prepare(folder)
    yield "| stage | work | ours, s | MiB | beside | s | MiB | beside / ours | least, s | ours / least |"
    yield "|" + "---|" * 10
    for stage, work, other, run, floor in ROWS:
        if arguments.only in stage + " " + work:
            yield row(stage, work, other, [run(folder, round) for round in range(arguments.rounds)], floor and floor(folder))
    for stage, work, *command in whole_commands(folder, arguments):
        cost = clocked(*command)
        yield f"| {stage} | {work} | {cost.seconds:.0f} | {cost.mib:.0f} | – | | | | | |"
    revision = output("git", "describe", "--always", "--dirty").strip()
    ode = output("pkg-config", "--modversion", "ode").strip()
    numpy, scipy, sklearn = (importlib.metadata.version(name) for name in ("numpy", "scipy", "scikit-learn"))
    yield ""
    yield f"Revision {revision}; medians of {arguments.rounds} rounds, but one of the rows with nothing beside; {os.cpu_count()} cores of"
    yield f"{processor()}; ODE {ode}, NumPy {numpy}, SciPy {scipy}, scikit-learn {sklearn}."


def processor():
    """Its name, and the widest vectors that it has."""
    text = pathlib.Path("/proc/cpuinfo").read_text()
    return f"{re.search(r'model name.*: (.*)', text)[1]}{' with AVX-512' if 'avx512f' in text else ''}"


def prepare(folder):
    """Builds the program and the floors, and makes what the rows read."""
    flags = output("pkg-config", "--cflags", "--libs", "ode").split()
    output("cc", "-O2", peers / "bare_loop.c", "-o", folder / "bare_loop", *flags)
    fast = ["-O3", "-march=native", "-ffast-math", "-fopenmp"]
    output("cc", *fast, *WIDE, peers / "floors.c", "-o", folder / "floors")
    output("cargo", "build", "--quiet", "--release", "--locked")
    output(program, "simulate", "--seed", 1, "--out", folder / "body")
    (folder / "large.toml").write_text("skin = { along = 42, around = 40 }\n")
    output(program, "simulate", "--seed", 1, "--settings", folder / "large.toml", "--out", folder / "large")
    for name, shapes in (("arm-46", [5, 6] * 2 + [6] * 4), ("arm-8", [1] * 8)):
        (folder / f"{name}.xml").write_text(mjcf(shapes))
        output(program, "body", "import", folder / f"{name}.xml", "--out", folder / f"{name}.toml")


def row(stage, work, other, pairs, least):
    ours, theirs = ([cost[at] for cost in pairs] for at in (0, 1))
    ratios = [b.seconds / a.seconds for a, b in pairs]
    median = lambda costs: statistics.median(cost.seconds for cost in costs)
    peak = lambda costs: f"{max(cost.mib for cost in costs):.0f}" if costs[0].mib else ""
    spread = f"{statistics.median(ratios):.3g} ({min(ratios):.3g} to {max(ratios):.3g})"
    floor = f"{least:.3g} | {median(ours) / least:.3g}" if least else " | "
    cells = [stage, work, f"{median(ours):.3g}", peak(ours), other, f"{median(theirs):.3g}", peak(theirs), spread, floor]
    return f"| {' | '.join(cells)} |"


def whole_commands(folder, arguments):
    """A stage, work and a command each, which nothing is beside."""
    if arguments.experiments:
        for experiment in ("exp1", "exp2"):
            yield "`bodyschema reproduce`", f"{experiment}, 20 simulations", program, "reproduce", experiment, "--out", folder / experiment
    if arguments.clone:
        first = f"git clone --quiet {root} {folder}/clone && unset CARGO_TARGET_DIR && {folder}/clone/reproduce/exp1.sh --quick"
        yield "from a clone", "build and `reproduce/exp1.sh --quick`", "bash", "-c", first


# Vectors as wide as the processor has them, of which compilers make no use unasked.
WIDE = ["-mprefer-vector-width=512"] if os.uname().machine == "x86_64" else []


if __name__ == "__main__":
    main()
