"""Every stage beside what a user would write instead, and beside the least time of what it does, in one table.

Run: pip install -r benches/peers/requirements.txt
     python benches/peers/run.py [--rounds N] [--only WORD ...] [--experiments] [--clone] [--write]

Each row is measured three times, or as --rounds says, and ours in a round is compared with the alternative in that round. Some rows share
what was measured for ours, so the two may be minutes apart. A stage alone is the least of several times within a process, on both sides; a
command is one whole process, with the peak of its memory (of `--clone` that of its largest process). The table has the medians of seconds
and of ratios, with the lowest and the highest ratio. *Least* is the lowest of three times that floors.c takes for the reading, writing, comparing,
counting, multiplying or adding that our algorithm does. Takes about seven minutes a round on two cores, and up to 5 GB of the disk.
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
    # What it printed, if it is a peer's result.
    said: str = ""


def output(*command, **environment):
    words = [str(word) for word in command]
    result = subprocess.run(words, cwd=root, env=os.environ | environment, capture_output=True, text=True)
    if result.returncode != 0:
        sys.exit(f"run: {' '.join(words)}: {result.stderr}")
    return result.stdout


def clocked(*command):
    """What a whole process costs, with the peak of its memory. A child starts with the peak of this process, which imports no NumPy."""
    words = [str(word) for word in command]
    with tempfile.TemporaryFile() as printed, tempfile.TemporaryFile() as complaints:
        start = time.perf_counter()
        process = subprocess.Popen(words, cwd=root, stdout=printed, stderr=complaints)
        _, status, usage = os.wait4(process.pid, 0)
        took = time.perf_counter() - start
        process.returncode = os.waitstatus_to_exitcode(status)
        texts = []
        for file in (printed, complaints):
            file.seek(0)
            texts.append(file.read().decode())
    # A replication that is not reproduced has status 1.
    if process.returncode not in ([0, 1] if "reproduce" in words else [0]):
        sys.exit(f"run: {' '.join(words)}: {texts[1]}")
    return Cost(took, usage.ru_maxrss / 1024, texts[0].strip())


@functools.cache
def bench(name, round, *arguments):
    """What a benchmark prints, once a round."""
    return output("cargo", "bench", "--quiet", "--bench", name, "--", *arguments)


def seconds(text, pattern, unit=1.0):
    return Cost(float(re.search(pattern, text)[1]) * unit)


def python(module, call):
    """A command that calls a function of one of the modules here."""
    return sys.executable, "-c", f"import sys; sys.path.insert(0, {str(peers)!r}); import {module}; {call}"


def peer(module, call, **environment):
    return Cost(float(output(*python(module, f"print({call})"), **environment)))


@functools.cache
def least(folder):
    """What floors.c measures: seconds by name, the least of three."""
    texts = [output(folder / "floors", moved(folder, "body") / "tactile.npy") for _ in range(3)]
    lines = [line.split() for text in texts for line in text.splitlines()]
    return {name: min(float(value) for other, value in lines if other == name) for name, _ in lines}


def floor(name):
    return lambda folder: least(folder)[name]


def multiply_adds(count, cores):
    """Seconds of so many multiplications and additions; floors.c does a billion on each core."""
    return lambda folder: least(folder)["multiply-add"] * count / 1e9 / cores


# Products of the map: 840² for each of some 350 vectors of its block Lanczos. Of a sweep: d (d + 1) / 2 for the distance of each of 840
# points to each of 10 components.
MAP = multiply_adds(840 * 840 * 350, os.cpu_count())
SWEEP = multiply_adds(840 * 10 * 14 * 15 / 2, 1)


def simulate(controller, *torque):
    def run(folder, round):
        ours = seconds(bench("simulate", round), rf"simulate, {controller}: ([\d.]+)")
        return ours, Cost(float(output(folder / "bare_loop", 1_000_000, *torque)))

    return run


def from_touch(folder, round, stage):
    """Seconds of a stage from pressures to distances."""
    return seconds(bench("distance", round, touch(folder)), rf"{stage}: ([\d.]+)")


def sense(folder, round):
    return from_touch(folder, round, "sense"), peer("sense", "sense.seconds()")


def distance(levels):
    def run(folder, round):
        return from_touch(folder, round, f"distance, N = {levels}"), peer("distance", f"distance.numpy_seconds({levels})")

    return run


def quantise(folder, round):
    ours = from_touch(folder, round, "quantise what was read, N = 8")
    return ours, peer("distance", f"distance.quantise_seconds({touch(folder)!r}, 8, {POOLED!r})")


def read(folder, round):
    return from_touch(folder, round, "read"), peer("distance", f"distance.load_seconds({touch(folder)!r})")


@functools.cache
def whole(folder, levels, scheme, round):
    """`bodyschema distance` from file to file."""
    options = ["--levels", levels, "--scheme", scheme, "--out", folder / "distance.npy"]
    return clocked(program, "distance", touch(folder), *options)


def command(levels, scheme):
    def run(folder, round):
        call = f"distance.command({touch(folder)!r}, {levels}, {scheme!r}, {str(folder / 'peer.npy')!r})"
        return whole(folder, levels, scheme, round), clocked(*python("distance", call))

    return run


def levels(count):
    """4 levels beside another number of them."""
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
    felt = moved(folder, body)
    truth = ["--labels", felt / "labels.csv", "--tree", felt / "tree.csv"]
    return clocked(program, "estimate", felt / "tactile.npy", *truth, "--seed", 1, "--force", "--out", folder / f"found-{body}-{round}")


def parts(folder, round):
    felt = moved(folder, "body")
    theirs = clocked(sys.executable, peers / "estimate.py", felt / "tactile.npy", felt / "labels.csv")
    return estimate(folder, "body", round), theirs


def ten_times(folder, round):
    return estimate(folder, "large", round), estimate(folder, "body", round)


def arm(folder, round):
    """1,000 s of an arm of eight links that have 46 shapes, and of one whose links have one each. Both have 1,840 sensors."""

    def move(shapes):
        body = folder / f"arm-{sum(shapes)}.toml"
        if not body.exists():
            body.with_suffix(".xml").write_text(mjcf(shapes))
            output(program, "body", "import", body.with_suffix(".xml"), "--sensors-per-part", 1840 // sum(shapes), "--out", body)
        return clocked(program, "simulate", "--body", body, "--duration", 1000, "--out", body.with_suffix(""))

    return move([5, 6] * 2 + [6] * 4), move([1] * 8)


def mjcf(shapes):
    """A chain of links 0.3 m long; each is a row of so many capsules, 0.24 m long together, the end of one at the start of the next."""
    text, ends = "", ""
    for link, count in enumerate(shapes):
        places = [0.03 + at * 0.24 / count for at in range(count + 1)]
        geoms = "".join(
            f'<geom type="capsule" size="0.03" fromto="0 0 {start} 0 0 {end}" mass="{1 / count}"/>'
            for start, end in zip(places, places[1:])
        )
        joint = '<joint type="hinge" axis="1 0 0"/><joint type="hinge" axis="0 1 0"/>' if link else "<freejoint/>"
        text += f'<body pos="0 0 {0.3 if link else 0}">{joint}{geoms}'
        ends += "</body>"
    return f"<mujoco><worldbody>{text}{ends}</worldbody></mujoco>"


@functools.cache
def moved(folder, name):
    """The paper's body with 840 sensors, or with 8,400: the folder of what it felt."""
    settings = folder / f"{name}.toml"
    settings.write_text("skin = { along = 42, around = 40 }\n" if name == "large" else "")
    output(program, "simulate", "--seed", 1, "--settings", settings, "--out", folder / name)
    return folder / name


def touch(folder):
    return str(moved(folder, "body") / "tactile.npy")


# Limits of levels for all sensors together, the default, and for each sensor.
POOLED, OWN = "pooled", "per-sensor"
NUMPY = "NumPy, from file to file"

# Stage, work, what a user would do instead, how to measure both, and the least seconds where something tells them.
ROWS = [
    ("simulate", "1,000,000 steps, torque", "bare loop of dWorldStep, in C", simulate("torque"), None),
    ("simulate", "the same, servo", "the same", simulate("servo"), None),
    ("simulate", "the same, servo", "the same, locks limited to 1000 N m", simulate("servo", "1000"), None),
    (
        "simulate",
        "the same, servo, with two-way fluid coupling",
        "the bare loop, without a fluid",
        simulate("servo in a fluid that pushes"),
        None,
    ),
    ("simulate", "an arm of 46 shapes on 8 links, 1,840 sensors, 1,000 s, file to files", "one of 8 shapes", arm, None),
    ("sense", "100,000 x 840 pressures", "NumPy", sense, floor("pages")),
    (
        "`bodyschema distance`",
        "a file of 336 MB of a body, N = 4, to a file",
        NUMPY,
        command(4, POOLED),
        None,
    ),
    ("`bodyschema distance`", "the same, N = 8", NUMPY, command(8, POOLED), None),
    (
        "`bodyschema distance`",
        "the same, N = 8, limits of levels for each sensor",
        NUMPY,
        command(8, OWN),
        None,
    ),
    *(
        ("`bodyschema distance`", "the same, N = 4", f"itself at N = {count}", levels(count), None)
        for count in (2, 8, 10, 16, 32, 64, 128, 256)
    ),
    ("read", "the file", "numpy.load", read, floor("read")),
    ("quantise", "what was read, N = 8", "NumPy", quantise, floor("compare")),
    ("distance", "840 sensors, T = 100,000, N = 4", "NumPy one-hot product", distance(4), floor("count-4")),
    ("distance", "the same, N = 8", "NumPy one-hot product", distance(8), floor("count-8")),
    ("map", "840 sensors to 15 dimensions", "numpy.linalg.eigh", map_840("eigh"), MAP),
    ("map", "the same", "scipy.linalg.eigh, 15 pairs by LAPACK's dsyevr", map_840("dsyevr"), MAP),
    ("map", "the same", "scipy.sparse.linalg.eigsh, 15 pairs by ARPACK", map_840("eigsh"), MAP),
    ("map", "840 sensors to 14 dimensions, 300 steps of majorisation", "scikit-learn's smacof", majorisation, None),
    ("map", "the same, 30 nonmetric steps", "scikit-learn's smacof", nonmetric, None),
    (
        "schema",
        "a sweep of DPGMM-LJ, n = 840, d = 14, K = 10, one core",
        "NumPy and SciPy",
        schema("schema.numpy_seconds()"),
        SWEEP,
    ),
    (
        "schema",
        "the same",
        "an iteration of scikit-learn's BayesianGaussianMixture",
        schema("schema.sklearn_seconds()"),
        SWEEP,
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
        "NumPy and scikit-learn, the parts alone, their number known; adjusted Rand index",
        parts,
        None,
    ),
    ("`bodyschema estimate`", "the same, 8,400 sensors", "itself with 840", ten_times, None),
]


def main():
    parser = argparse.ArgumentParser(description="Time every stage beside what a user would write instead.")
    parser.add_argument("--rounds", type=int, default=3, help="how often each row is measured")
    parser.add_argument("--only", nargs="+", metavar="WORD", help="only rows whose stage or work contains one of these words")
    parser.add_argument("--experiments", action="store_true", help="also both experiments, 20 simulations each")
    parser.add_argument("--clone", action="store_true", help="also a fresh clone up to its first table")
    parser.add_argument("--write", action="store_true", help="put the table into benches/README.md")
    arguments = parser.parse_args()
    if arguments.rounds < 1:
        parser.error("--rounds must be at least 1")
    if arguments.write and arguments.only:
        parser.error("--write takes all rows")
    page = peers.parent / "README.md"
    before, start, rest = page.read_text().partition("<!-- peers -->\n")
    _, end, after = rest.partition("<!-- /peers -->")
    with tempfile.TemporaryDirectory() as name:
        lines = []
        for line in table(pathlib.Path(name), arguments):
            print(line, flush=True)
            lines.append(line)
    if arguments.write:
        page.write_text("".join([before, start, *(f"{line}\n" for line in lines), end, after]))


def table(folder, arguments):
    """The lines of the table, and under what they were measured."""
    prepare(folder)
    revision = output("git", "--no-optional-locks", "describe", "--always", "--dirty").strip()
    machine = processor()
    yield "| stage | work | ours, s | MiB | beside | s | MiB | beside / ours | least, s | ours / least |"
    yield "|" + "---|" * 10
    for stage, work, other, run, of in ROWS:
        if not arguments.only or any(word in f"{stage} {work}" for word in arguments.only):
            yield row(stage, work, other, [run(folder, round) for round in range(arguments.rounds)], of and of(folder))
    for stage, work, *command in whole_commands(folder, arguments):
        cost = clocked(*command)
        yield f"| {stage} | {work} | {cost.seconds:.0f} | {cost.mib:.0f} | – | | | | | |"
    ode = output("pkg-config", "--modversion", "ode").strip()
    numpy, scipy, sklearn = (importlib.metadata.version(name) for name in ("numpy", "scipy", "scikit-learn"))
    yield ""
    yield f"Revision {revision}. Medians of {arguments.rounds} rounds; rows without an alternative were measured once. {os.cpu_count()} cores of"
    yield f"{machine}; ODE {ode}, NumPy {numpy}, SciPy {scipy}, scikit-learn {sklearn}."


def processor():
    """Its name, and whether it has vectors of 512 bits."""
    text = pathlib.Path("/proc/cpuinfo").read_text()
    name = re.search(r"model name.*: (.*)", text)
    return f"{name[1] if name else os.uname().machine}{' with AVX-512' if 'avx512f' in text else ''}"


def prepare(folder):
    """Builds the program, the bare loop and the floors."""
    flags = output("pkg-config", "--cflags", "--libs", "ode").split()
    output("cc", "-O2", peers / "bare_loop.c", "-o", folder / "bare_loop", *flags)
    fast = ["-O3", "-march=native", "-ffp-contract=fast", "-fopenmp"]
    output("cc", *fast, *WIDE, peers / "floors.c", "-o", folder / "floors")
    output("cargo", "build", "--quiet", "--release", "--locked")


def row(stage, work, other, pairs, bound):
    ours, theirs = ([cost[at] for cost in pairs] for at in (0, 1))
    ratios = [b.seconds / a.seconds for a, b in pairs]
    median = lambda costs: statistics.median(cost.seconds for cost in costs)
    peak = lambda costs: f"{max(cost.mib for cost in costs):.0f}" if costs[0].mib else ""
    spread = f"{statistics.median(ratios):.3g} ({min(ratios):.3g} to {max(ratios):.3g})"
    above = f"{bound:.3g} | {median(ours) / bound:.3g}" if bound else " | "
    said = theirs[0].said if "adjusted" in other else ""
    other += f" {said}" if said else ""
    cells = [stage, work, f"{median(ours):.3g}", peak(ours), other, f"{median(theirs):.3g}", peak(theirs), spread, above]
    return f"| {' | '.join(cells)} |"


def whole_commands(folder, arguments):
    """A stage, work and a command each, which nothing is beside."""
    if arguments.experiments:
        for experiment in ("exp1", "exp2"):
            yield "`bodyschema reproduce`", f"{experiment}, 20 simulations", program, "reproduce", experiment, "--out", folder / experiment
    if arguments.clone:
        first = f"git clone --quiet {root} {folder}/clone && unset CARGO_TARGET_DIR && {folder}/clone/reproduce/exp1.sh --quick"
        yield "from a clone", "build and `reproduce/exp1.sh --quick`", "bash", "-c", first


# Compilers use vectors of 512 bits only if asked to.
WIDE = ["-mprefer-vector-width=512"] if os.uname().machine == "x86_64" else []


if __name__ == "__main__":
    main()
