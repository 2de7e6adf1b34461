#!/usr/bin/env python3
"""Write docs/shown/claims.md, from every sentence of the paper's results to the code and the result that test it, and back.

reproduce/claims.py [--check FILE]

It takes the sentences from reproduce/claims.toml, the claims from reproduce/published.toml, and values and verdicts from the
committed docs/shown/exp1 and exp2. With --check it writes nothing, and ends with status 1 if FILE is not the page that it
would write. reproduce/docs.py runs it. Needs Python 3.11, and no packages.
"""

import csv
import json
import pathlib
import sys
import tomllib

ROOT = pathlib.Path(__file__).resolve().parent.parent
SHOWN = ROOT / "docs" / "shown"
PAGE = SHOWN / "claims.md"
EXPERIMENTS = ["exp1", "exp2"]
READINGS = {"authors-code": "authors' code interpretation", "equations": "equations interpretation"}

INTRODUCTION = """# From the paper to the tests, and back

Which claim tests which sentence of the paper, by which code, and what came out? This page leads from each sentence of the paper's
results to the claim, its verdict, the code that computes it and the test of that code. The values are those of {source}.

`reproduce/claims.py` makes the page of three sources: [claims.toml](../../reproduce/claims.toml) has the sentences,
[published.toml](../../reproduce/published.toml) the claims, and the committed results the values. A claim has a range of values
that counts as reproduced, which was fixed beforehand. All values with their intervals are in [exp1/claims.csv](exp1/claims.csv)
and [exp2/claims.csv](exp2/claims.csv); a run of your own writes the same table as `claims.csv`
([columns](../reference.md#claims)).

[results.md](../results.md) says how the runs were made. The equations interpretation is Algorithm 1 of the paper with `pairwise`
edge weights, which depart from the letter of equation 22 ([settings.md](../settings.md)).
[CONTRIBUTING.md](../../CONTRIBUTING.md#claims-of-another-paper) says how a claim of another paper becomes a row.
"""


def main():
    text = page()
    if sys.argv[1:2] == ["--check"]:
        if pathlib.Path(sys.argv[2]).read_text() != text:
            sys.exit("docs/shown/claims.md is not what claims.toml, published.toml and docs/shown give; run reproduce/claims.py")
    else:
        PAGE.write_text(text)


def page():
    claims = read("published.toml")["claim"]
    data = read("claims.toml")
    kinds = {measure["kind"]: measure for measure in data["measure"]}
    results = {name: judged(name) for name in EXPERIMENTS}
    return "\n".join([
        INTRODUCTION.format(source=source()),
        "## Sentences of the paper\n",
        "The sentences are in the paper's order and in at most 15 of its words. A verdict is that of both experiments, if both test the claim.\n",
        *table(["place", "the paper says", "tested by", "verdict"], [sentence(one, results) for one in data["sentence"]]),
        "",
        "## Claims\n",
        "*says* is in the words of this project. `measure` leads to the code. A value without a unit is the quantity in brackets in the statement.\n",
        *table(
            ["claim", "place", "says", "published", "accepted", "measure", *map(results_of, EXPERIMENTS), "figure"],
            [claim(one, results) for one in claims],
        ),
        "",
        "## Measures\n",
        "The code is in [src/analysis](../../src/analysis/measure.rs). A test judges a claim of each kind by samples that were made",
        "by hand ([tests.rs](../../src/analysis/claims/tests.rs)). [claims.rs](../../src/analysis/claims.rs) compares the value with",
        "the range.\n",
        *table(
            ["measure", "computed by", "test", "claims", "place in the paper"],
            [measure(one, claims) for one in kinds.values()],
        ),
        "",
    ])


def source():
    """The runs whose values the page has: seed, simulations and revision."""
    runs = {}
    for name in EXPERIMENTS:
        facts = json.loads((SHOWN / name / "manifest.json").read_text())
        simulations = facts["settings"]["experiment"]["simulations"]
        run = f"seed {facts['seed']}, {simulations} simulations, revision {facts['revision'][:7]}"
        runs.setdefault(run, []).append(f"`reproduce/{name}.sh`")
    return "; ".join(f"{' and '.join(commands)} ({run})" for run, commands in runs.items())


def read(name):
    return tomllib.loads((ROOT / "reproduce" / name).read_text())


def judged(name):
    """Rows of the claims of an experiment that have a verdict: for each claim the interpretation of the run first."""
    with open(SHOWN / name / "claims.csv", newline="") as file:
        rows = [row for row in csv.DictReader(file) if row["counting"] == "all-draws"]
    return {row["id"]: [other for other in rows if other["id"] == row["id"]] for row in rows}


def table(columns, rows):
    header, *lines = [f"| {' | '.join(cells)} |" for cells in [columns, *rows]]
    return [header, f"|{'---|' * len(columns)}", *lines]


def sentence(one, results):
    tested = [link(id) for id in one["claims"]]
    if "why" in one:
        tested.append(one["why"])
    return [one["place"], f"“{one['quote']}”", "; ".join(tested), verdicts(one["claims"], results)]


def link(id):
    return f"[{id}](#{id})"


def verdicts(ids, results):
    """The verdict of the run's own interpretation on each claim; one where all agree."""
    found = {}
    for id in ids:
        of_each = dict.fromkeys(rows[id][0]["verdict"] for rows in results.values() if id in rows)
        found[id] = f"**{' and '.join(of_each)}**" if of_each else "not run yet"
    if len(set(found.values())) <= 1:
        return next(iter(found.values()), "–")
    return "; ".join(f"{id}: {words}" for id, words in found.items())


def claim(one, results):
    id = one["id"]
    accepted = " to ".join(str(bound) for bound in sorted(set(one["accept"]))) if "accept" in one else ""
    cells = [f'<a id="{id}"></a>`{id}`', one["place"], one["statement"], one["wording"], accepted]
    cells.append(f"[{one['measure']['kind']}](#{anchor(one)})")
    cells += [verdict(results[name].get(id, [])) for name in EXPERIMENTS]
    return [*cells, ", ".join(figures(one)) or one["figure"]]


def anchor(one):
    return f"measure-{one['measure']['kind']}"


def results_of(name):
    return f"[experiment {name[-1]}]({name}/claims.csv)"


def verdict(rows):
    """Verdict and value, by each interpretation of the paper that was run."""
    words = []
    for row in rows:
        reading = f" ({READINGS[row['reading']]})" if len(rows) > 1 else ""
        words.append(f"**{row['verdict']}**{reading}{value(row)}")
    return "; ".join(words)


def value(row):
    if not row["value"]:
        return ""
    number = float(row["value"])
    if row["unit"] == "rate":
        return f", {100 * number:.1f} %"
    return f", {number:.3g}" if number >= 0.001 or number == 0 else ", below 0.001"


def figures(one):
    """The committed tables of the figure that shows a claim."""
    folders = [SHOWN / name for name in one["experiments"]]
    number = one["figure"].rjust(2 + one["figure"][-1:].isalpha(), "0")
    files = sorted(file for folder in folders for file in folder.glob(f"fig{number}-*.csv"))
    return [f"[{one['figure']}]({file.relative_to(SHOWN)})" for file in files]


def measure(one, claims):
    of_kind = [claim for claim in claims if claim["measure"]["kind"] == one["kind"]]
    places = dict.fromkeys(f"figure {claim['figure']}, {claim['place']}" for claim in of_kind)
    return [
        f'<a id="measure-{one["kind"]}"></a>`{one["kind"]}`',
        f"`{one['function']}` in [{one['file']}](../../src/analysis/{one['file']})",
        f"`{one['test']}`",
        ", ".join(link(claim["id"]) for claim in of_kind),
        "; ".join(places),
    ]


main()
