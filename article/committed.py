"""The committed results, as the article reads them, and the words for their numbers. Used by values.py."""

import csv
import functools
import gzip
import io
import json
import pathlib
import sys
import tomllib

ROOT = pathlib.Path(__file__).resolve().parent.parent
VERDICTS = ["reproduced", "not reproduced", "not testable"]
# The main result, and the run before it.
CONFIRMATION, BEFORE = "docs/shown/confirm", "docs/shown"
# Values of columns of claims.csv and of the tables of figures.
ALL, BEST, EQUATIONS, CODE = "all-draws", "best-draw", "equations", "authors-code"
ABLATION, MOMENTUM, STEP = (f"docs/shown/{name}/study.csv" for name in ["ablation", "momentum", "step"])
SENSITIVITY = "docs/shown/sensitivity/measures.csv.gz"
FORMER = "docs/shown/former-defaults.csv"

# What values.toml will hold: each value in words, with its file; what holds; and what the text says that is not so.
values = {}
holds = {}
broken = []


def read(name):
    try:
        return (ROOT / name).read_text()
    except FileNotFoundError:
        sys.exit(missing(name))


def missing(name):
    if name.startswith(CONFIRMATION):
        return f"article: {name} is missing; run reproduce/confirm.sh, and then reproduce/docs.py, which puts it there"
    return f"article: {name} is missing"


@functools.cache
def table(name):
    """Rows of a committed table, packed or not."""
    if not name.endswith(".gz"):
        return list(csv.DictReader(io.StringIO(read(name))))
    return list(csv.DictReader(io.StringIO(gzip.decompress((ROOT / name).read_bytes()).decode())))


def value(name, text, source):
    """A number for the text, in the words in which it is printed."""
    assert name not in values, name
    values[name] = (str(text), source)


def flag(name, true):
    """What decides between two wordings of content.typ."""
    assert name not in holds, name
    holds[name] = bool(true)


def says(words, true):
    """What the text says of its numbers in words."""
    if not true:
        broken.append(words)


# ---- Words for numbers


def percent(number, digits=1):
    """A rate as a percentage, without decimals if it is 0 or 1."""
    number = 100 * float(number)
    return f"{number:.0f} %" if number in (0, 100) else f"{number:.{digits}f} %"


def percents(low, high, digits=1):
    """A range of rates."""
    return f"{percent(low, digits).removesuffix(' %')} to {percent(high, digits)}"


def thousands(number):
    return f"{int(number):,}"


def points(number, digits=0):
    """A difference of rates, in percentage points."""
    return f"{100 * float(number):.{digits}f}".replace("-", "−")


def shown(text, unit):
    if not text:
        return ""
    number = float(text)
    if unit == "rate":
        return percent(number)
    if unit == "p-value":
        return "< 0.001" if number < 0.001 else f"{number:.2g}"
    return f"{number:.2f}" if unit == "ari" else f"{number:.3g}"


def span(ends, unit):
    if not all(ends):
        return ""
    low, high = (shown(end, unit) for end in ends)
    return low if low == high else f"{low.removesuffix(' %')} to {high}"


def side(number, low, high):
    return "below the accepted range" if number < low else "above the accepted range" if number > high else "within the accepted range"


# ---- Tables of claims and of comparisons


def former_default(number, reading):
    """The row of the headline of a former default, by one interpretation."""
    return next(row for row in table(FORMER) if (row["default"], row["reading"]) == (number, reading))


def compared(source):
    """Rows of a study, by name of the configuration and claim."""
    return {(row["name"], row["claim"]): row for row in table(source)}


def claims_of(folder):
    """Rows by claim, interpretation and way of counting, each with its file (of a claim of both experiments, the first's), and
    those of each experiment; and what the run was."""
    folders = {experiment: f"{folder}/{experiment}" for experiment in ["exp1", "exp2"]}
    facts = [json.loads(read(f"{of}/manifest.json")) for of in folders.values()]
    rows, apart = {}, {}
    for experiment, of in folders.items():
        source = f"{of}/claims.csv"
        apart[experiment] = {(row["id"], row["reading"], row["counting"]): (row, source) for row in table(source)}
        rows |= {key: pair for key, pair in apart[experiment].items() if key not in rows}
    first = facts[0]
    same = all(one[key] == first[key] for one in facts for key in ["seed", "revision"])
    simulations = {len({body["simulation"] for body in one["bodies"]}) for one in facts}
    if not same or len(simulations) > 1 or first["quick"]:
        sys.exit(f"article: {folder}/exp1 and exp2 must be full runs of one seed, revision and number of simulations")
    run = {"seed": first["seed"], "revision": first["revision"][:7], "simulations": simulations.pop()}
    return run | {"rows": rows, "apart": apart, "folders": folders}


def own(run, id):
    """The row of a claim by the equations over all samples."""
    return run["rows"][id, EQUATIONS, ALL]
