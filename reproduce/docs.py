#!/usr/bin/env python3
"""Put the results of finished runs into the repository: reproduce/docs.py [RESULTS]

RESULTS is the folder that holds confirm, exp1, exp2, sensitivity, ablation, step, momentum, mixing and bodies (default: results/).
It updates

- docs/shown/: for each run and study its tables (large ones packed by gzip), its pictures, and its page as README.md; for confirm and
  the two experiments also their manifests;
- README.md, docs/results.md, docs/own-data.md and docs/estimate.md: what lies between <!-- NAME --> and <!-- /NAME -->, from docs/shown.
  It needs no run;
- docs/settings.md: the table of open settings, from paper.toml, sensitivity.toml and docs/shown/searches.csv. It needs no run;
- docs/shown/claims.md: the paper's sentences, claims and verdicts, from claims.toml and docs/shown. It needs no run;
- docs/shown/parameters/: the parameters and constants of `estimate`, from the code. It needs no run;
- article/values.toml: the numbers of the article, from docs/shown. It needs no run.

What RESULTS does not hold is skipped, with a line on standard error. Needs Python 3.11, and no packages.
"""

import csv
import gzip
import json
import math
import pathlib
import re
import shutil
import subprocess
import sys
import tomllib

import accuracy
from estimated import flat

ROOT = pathlib.Path(__file__).resolve().parent.parent
SHOWN = ROOT / "docs" / "shown"
# Tables with more bytes are packed: nearly all of them is again and again the same.
LARGE = 200_000

# The claims that the README shows beside the headline: what the abstract of the paper rests on, and what a reader would ask next.
CLAIMS = [
    ("exp1", "baseline-tree", "The same mixture without joints, then Prim's tree (DPGMM + Prim), never recovers the tree"),
    ("exp1", "first-dimension", "The tree needs about nine dimensions"),
    ("exp1", "tree-high-dimensions", "The tree is recovered from d = 9 on (worst d)"),
    ("exp1", "number-of-parts", "Slightly more than five parts (worst d)"),
    ("exp2", "best-coordination", "p = 0.9 is best"),
    ("exp2", "tree-random-movement", "Up to p = 0.4 it is not recovered (worst p)"),
]
HEADLINE = "tree-accuracy"
FIGURES = {
    "exp1": ["fig07-parts", "fig08a-ari-baselines", "fig08b-ari", "fig10a-tree-baseline", "fig10b-tree"],
    "exp2": ["fig11a-ari", "fig11b-tree"],
}
VERDICTS = ["reproduced", "not reproduced", "not testable"]
UNITS = ["kg/m^3", "N m s/rad", "N m/rad", "N m", "1/s", "Pa", "m", "s"]
# Settings of which docs/fluid.md gives the reason.
FLUID = ["physics.fluid_density", "physics.angular_momentum", "sense.threshold"]


def main():
    results = pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else ROOT / "results"
    experiments = [experiment_1, experiment_2, confirmation_1, confirmation_2]
    studies = [sensitivity, ablation, shorter_step, momentum, mixing, bodies, rhythmic]
    for step in [*experiments, *studies]:
        try:
            step(results)
        except FileNotFoundError as missing:
            skip(step, f"{missing.filename} is missing")
        except Skip as reason:
            skip(step, str(reason))
    answers()
    for (page, name), lines in accuracy.tables().items():
        between_marks(ROOT / page, name, "\n".join(lines))
    multiverse()
    open_settings()
    for script in ["reproduce/claims.py", "reproduce/constants.py", "article/values.py"]:
        if status := subprocess.run([sys.executable, ROOT / script]).returncode:
            sys.exit(status)


class Skip(Exception):
    """Results that must not go into the repository."""


def skip(step, reason):
    print(f"docs.py: {step.__name__} skipped: {reason}", file=sys.stderr)


def between_marks(path, name, body):
    """Replace the text of a file between <!-- name --> and <!-- /name -->."""
    pattern = rf"(<!-- {name} -->\n).*?(<!-- /{name} -->)"
    text, found = re.subn(pattern, lambda mark: f"{mark[1]}{body}\n{mark[2]}", path.read_text(), flags=re.S)
    assert found == 1, f"{path} must have the marks of {name} once, not {found} times"
    path.write_text(text)


def copy(sources, folder):
    """Copy files. Those that exist are listed before the first is written, so that none is copied in part."""
    sources = list(sources)
    for source in sources:
        if not source.is_file():
            raise FileNotFoundError(2, "missing", str(source))
    folder.mkdir(parents=True, exist_ok=True)
    for source in sources:
        shutil.copy(source, folder / source.name)


def manifest(folder):
    facts = json.loads((folder / "manifest.json").read_text())
    if facts.get("quick"):
        raise Skip(f"{folder} is a quick run, whose numbers are no replication")
    return facts


# ---- The experiments


def experiment_1(results):
    experiment(results / "exp1", SHOWN / "exp1")


def experiment_2(results):
    experiment(results / "exp2", SHOWN / "exp2")


def confirmation_1(results):
    experiment(results / "confirm" / "exp1", SHOWN / "confirm" / "exp1")
    copy([results / "confirm" / "confirmation.md"], SHOWN / "confirm")


def confirmation_2(results):
    experiment(results / "confirm" / "exp2", SHOWN / "confirm" / "exp2")


def experiment(folder, shown):
    """The claims and figures of an experiment, and its page."""
    manifest(folder)
    pairs = [folder / "figures" / f"{name}.{kind}" for name in FIGURES[folder.name] for kind in ["csv", "svg"]]
    copy([folder / "claims.csv", folder / "manifest.json", *pairs], shown)
    title = {"exp1": "Experiment 1: over the dimensions d of the body map", "exp2": "Experiment 2: over the ratio p of motor coordination"}
    (shown / "README.md").write_text(f"# {title[folder.name]}\n\n{(folder / 'claims.md').read_text()}")


def answers():
    """README.md and docs/results.md: the headline in a sentence, and claims of the confirmation beside those of the run before it."""
    runs = {name: shown_claims(name) for name in ["exp1", "exp2"]}
    latest, of = runs["exp1"][0], {name: {run["name"]: run for run in found} for name, found in runs.items()}
    headline = latest["claims"][HEADLINE, "equations"]
    sentence = (
        f"In {words(headline)} of {int(headline['n']):,} eligible samples, DPGMM-LJ recovers the true tree at p = 0.9 and d = 14; the paper "
        f"reports {headline['wording']}. The 95 % interval over {headline['simulations']} simulations is {interval(headline)}, and the range "
        f"accepted beforehand is {span(headline, 'accepted_low', 'accepted_high')}: **{headline['verdict']}**."
    )
    between_marks(ROOT / "README.md", "headline", sentence)

    lines = [table_row(["claim of the paper", "published", "accepted", "found here", "95 % interval", "n", "verdict"]), f"|{'---|' * 7}"]
    others = [
        ("exp1", HEADLINE, "Tree accuracy at p = 0.9, d = 14", "equations"),
        ("exp1", HEADLINE, "The same, as the authors' code computes", "authors-code"),
        *((*claim, "equations") for claim in CLAIMS),
    ]
    for experiment, id, name, reading in others:
        run = runs[experiment][0]
        row = run["claims"][id, reading]
        if run["name"] != latest["name"]:
            name += f" ({run['name']})"
        lines.append(table_row([name, row["wording"], span(row, "accepted_low", "accepted_high"), words(row), interval(row), f"{int(row['n']):,}", row["verdict"]]))
    lines += ["", " ".join(sources(runs))]
    # A claim of both experiments counts once.
    verdicts = [row["verdict"] for (_, reading), row in (runs["exp2"][0]["claims"] | latest["claims"]).items() if reading == "equations"]
    counts = ", ".join(f"{verdicts.count(verdict)} {verdict}" for verdict in VERDICTS)
    lines[-1] = f"Of all {len(verdicts)} claims: {counts}. {' '.join(sources(runs, brief=True))}"
    between_marks(ROOT / "README.md", "claims", "\n".join(lines))

    names = list(dict.fromkeys(run["name"] for found in runs.values() for run in found))
    header = ["claim", "published", "accepted", *(f"{name}: {what}" for name in names for what in ["found", "verdict"])]
    lines = [table_row(header), f"|{'---|' * len(header)}"]
    listed = set()
    for experiment, found in runs.items():
        for (id, reading), row in found[0]["claims"].items():
            if row["verdict"] == "not testable" or (id, reading) in listed:
                continue
            listed.add((id, reading))
            statement = row["statement"] + (", as the authors' code computes" if reading == "authors-code" else "")
            cells = [statement, row["wording"], span(row, "accepted_low", "accepted_high")]
            for name in names:
                same = of[experiment].get(name, {}).get("claims", {}).get((id, reading))
                if not same:
                    cells += ["–", "not run"]
                    continue
                details = "; ".join(filter(None, [interval(same), f"n = {int(same['n']):,}"]))
                cells += [f"{words(same)} ({details})", same["verdict"]]
            lines.append(table_row(cells))
    lines += ["", " ".join(sources(runs))]
    between_marks(ROOT / "docs" / "results.md", "claims", "\n".join(lines))

    conclusion = SHOWN / "confirm" / "confirmation.md"
    text = conclusion.read_text().strip() if conclusion.exists() else "The confirmation has not run yet."
    between_marks(ROOT / "docs" / "results.md", "confirmation", text)
    curves, ranges = [], {}
    for experiment, figure, symbol, column in [("exp1", "fig10b-tree", "d", "dimension"), ("exp2", "fig11b-tree", "p", "coordination")]:
        run = runs[experiment][0]
        with open(run["folder"] / f"{figure}.csv", newline="") as file:
            rows = [row for row in csv.DictReader(file) if row["counting"] == "all-draws"]
        header = [symbol, f"tree accuracy of DPGMM-LJ ({run['name']})", "95 % interval", "n", "range over simulations"]
        curves += [table_row(header), f"|{'---|' * len(header)}"]
        for row in rows:
            rate = row | {"unit": "rate"}
            cells = [row[column], words(rate), interval(rate), f"{int(row['n']):,}", span(rate, "lowest", "highest")]
            curves.append(table_row(cells))
            ranges[symbol, row[column]] = span(rate, "lowest", "highest")
        curves.append("")
    between_marks(ROOT / "docs" / "results.md", "findings", "\n".join(curves).strip() + "\n")
    between_marks(ROOT / "README.md", "simulations", (
        f"- **Single simulations** have tree accuracies of [{ranges['d', '14']}](docs/results.md#what-stands-out); the paper seems to show one."
    ))


def shown_claims(experiment):
    """What docs/shown has of an experiment: the confirmation first, if it has run, then the run before it."""
    published = tomllib.loads((ROOT / "reproduce" / "published.toml").read_text())["claim"]
    statements = {claim["id"]: claim["statement"] for claim in published}
    runs = []
    for name, folder in [("confirmation", SHOWN / "confirm" / experiment), ("seed 1414", SHOWN / experiment)]:
        if not (folder / "claims.csv").exists():
            continue
        with open(folder / "claims.csv", newline="") as file:
            rows = [row for row in csv.DictReader(file) if row["counting"] == "all-draws"]
        claims = {(row["id"], row["reading"]): row | {"statement": statements[row["id"]]} for row in rows}
        runs.append({"name": name, "claims": claims, "facts": manifest(folder), "folder": folder})
    return runs


def sources(runs, brief=False):
    """Command, seed, size and revision of each run that is shown, a sentence each; if brief, of each experiment the first run alone."""
    made = {}
    for experiment, found in runs.items():
        for run in found[:1] if brief else found:
            facts = run["facts"]
            settings, schema = facts["settings"]["experiment"], facts["settings"]["schema"]
            chains = f"{schema['chains']} chains of {schema['sweeps']} sweeps for each condition, "
            size = (
                f"seed {facts['seed']}, {settings['simulations']} simulations, {'' if brief else chains}revision {facts['revision'][:7]}"
            )
            command = "confirm.sh" if run["name"] == "confirmation" else f"{experiment}.sh"
            made.setdefault((run["name"], size), []).append(command)
    return [
        f"{'' if name.startswith('seed') else 'Confirmation, '}{', '.join(f'`reproduce/{command}`' for command in dict.fromkeys(commands))}: {size}."
        for (name, size), commands in made.items()
    ]


def words(row):
    """The value of a claim for people, as the program writes it."""
    return number(row["value"], row["unit"], sign=True)


def interval(row):
    return span(row, "low", "high")


def span(row, low, high):
    """A range of a claim for people; one number if both ends are equal, and nothing where there is none."""
    if not row[low]:
        return ""
    unit = "" if row["unit"] == "p-value" else row["unit"]
    ends = [number(row[key], unit) for key in [low, high]]
    return (ends[0] if ends[0] == ends[1] else " to ".join(ends)) + (" %" if row["unit"] == "rate" else "")


def number(text, unit, sign=False):
    if not text:
        return "–"
    value = float(text)
    if unit == "p-value" and value < 0.001:
        return "< 0.001"
    if unit == "rate":
        return (f"{100 * value:.0f}" if value in (0, 1) else f"{100 * value:.1f}") + (" %" if sign else "")
    return f"{round(value, 3) + 0.0:g}"


def table_row(cells):
    return f"| {' | '.join(cells)} |"


# ---- The multiverse


def multiverse():
    """In how many replications the headline and the dependence on d and p hold, of those that can judge them."""
    with open(SHOWN / "multiverse" / "shares.csv", newline="") as file:
        rows = {row["claim"]: row for row in csv.DictReader(file) if (row["part"], row["group"]) == ("multiverse", "all")}
    design = tomllib.loads((ROOT / "reproduce" / "multiverse.toml").read_text())
    planned = math.prod(design["draws"].values())
    # A replication is judged by both meanings of what varies in the evaluation.
    settings = sum(factor["level"] != "evaluation" for factor in design["factor"])
    headline = rows[HEADLINE]
    ran, judged = f"{int(headline['n']):,}", headline["judged"]
    left = "" if int(headline["n"]) == planned else "; unfinished"
    percents = lambda row: f"{100 * float(row['low']):.0f} to {100 * float(row['high']):.0f} %"
    between_marks(ROOT / "README.md", "multiverse", "\n".join([
        f"- **Other choices mostly fail.** Of {ran} reasonable combinations of {settings} open settings, {judged} give a tree accuracy.",
        f"  The headline holds in [{headline['holds']} of these](docs/shown/multiverse/README.md) (95 % interval {percents(headline)}{left}).",
    ]))
    share = lambda claim: f"{rows[claim]['holds']} of {rows[claim]['judged']} ({percents(rows[claim])})"
    between_marks(ROOT / "docs" / "multiverse.md", "multiverse", "\n".join([
        f"So far, {ran} of {planned:,} replications have run. In {judged} of them a sample is eligible at p = 0.9 and d = 14, so that there is a tree",
        f"accuracy. It is in the accepted range in {share(HEADLINE)}. Of those that can show it, the dependence on d is reproduced in",
        f"{share('dependence on d')}, and the dependence on p in {share('dependence on p')}. In brackets: 95 % intervals over movements.",
    ]))


# ---- The studies


def sensitivity(results):
    study(results / "sensitivity", ["configurations.csv", "study.csv", "measures.csv"])


def ablation(results):
    study(results / "ablation", ["configurations.csv", "study.csv"])


def shorter_step(results):
    study(results / "step", ["configurations.csv", "study.csv"])


def momentum(results):
    study(results / "momentum", ["configurations.csv", "study.csv"])


def bodies(results):
    study(results / "bodies", ["recordings.csv", "edges.csv"], "bodies.md")
    say_run(results / "bodies")


def rhythmic(results):
    copy([results / "rhythmic" / "recordings.csv"], SHOWN / "rhythmic")
    say_run(results / "rhythmic")


def say_run(folder):
    """Keep the seed and the revision of a study."""
    facts = manifest(folder)
    kept = {"seed": facts["seed"], "revision": facts["revision"]}
    (SHOWN / folder.name / "run.json").write_text(json.dumps(kept, indent=2) + "\n")


def mixing(results):
    tables = ["bodies-chains.csv", "bodies-posterior.csv", "edges.csv", "traces.csv", "traces-seconds.csv"]
    study(results / "mixing", tables, "mixing.md")


def study(folder, tables, page="study.md"):
    """Put the tables, the pictures and the page of a study into its folder of docs/shown."""
    shown, text = SHOWN / folder.name, (folder / page).read_text()
    copy([*(folder / table for table in tables), *sorted((folder / "figures").glob("*.svg"))], shown)
    # The page moves, so that links to its own pictures and to files of the repository change.
    for old, new in [("](figures/", "]("), ("](docs/shown/", "](../"), ("](docs/", "](../../"), ("](reproduce/", "](../../../reproduce/")]:
        text = text.replace(old, new)
    for table in tables:
        plain = shown / table
        if plain.stat().st_size > LARGE:
            plain.with_name(f"{table}.gz").write_bytes(gzip.compress(plain.read_bytes(), mtime=0))
            plain.unlink()
            text = text.replace(f"]({table})", f"]({table}.gz)")
    (shown / "README.md").write_text(text)


# ---- The open settings


def open_settings():
    """docs/settings.md: what the paper leaves open, and what this replication does instead."""
    settings = read_settings()
    folder = ROOT / "reproduce"
    study = tomllib.loads((folder / "sensitivity.toml").read_text())
    # What the searches varied with one-way fluid coupling, and, over these, with two-way coupling.
    searched = {key: "search, one-way coupling" for key in varied("one-way")}
    searched |= {key: "search" for key in varied("two-way")}
    lines = ["| setting | the paper says | ours | reason | source |", "|---|---|---|---|---|"]
    named = set()
    for part in study["factor"]:
        if part["name"] == "pairs":
            continue
        named.update(part["settings"])
        if any(settings[key]["ours"] for key in part["settings"]):
            lines.append(
                line(
                    f"[{part['title']}](shown/sensitivity/README.md{anchor(part['name'])})",
                    part["settings"],
                    part["paper"],
                    part["why"],
                    settings,
                    searched,
                )
            )
    for key, setting in settings.items():
        if setting["ours"] and key not in named:
            clauses = [clause.strip() for clause in setting["comment"].split(";")]
            paper = [clause for clause in clauses if clause.startswith(("stated", "the paper"))]
            ours = [clause.removeprefix("ours: ") for clause in clauses if clause not in paper]
            # The unit stands beside the value.
            reason = re.sub(rf"^(?:{'|'.join(map(re.escape, UNITS))}), ", "", "; ".join(ours))
            paper = "; ".join(paper) or "nothing"
            lines.append(line("", [key], capital(paper), capital(reason), settings, searched))
    between_marks(ROOT / "docs" / "settings.md", "settings", "\n".join(lines))


def varied(coupling):
    """Settings of which the configurations of a round have several values, over all rounds with a fluid coupling."""
    with open(SHOWN / "searches.csv", newline="") as file:
        return {key for row in csv.DictReader(file) if row["coupling"] == coupling for key in row["varied"].split()}


def anchor(part):
    """The place of a part in the study's page, if the study that is shown has it."""
    page = (SHOWN / "sensitivity" / "README.md").read_text()
    return f"#{part}" if f'id="{part}"' in page else ""


def read_settings():
    """Values of paper.toml as they are written there, and whose they are."""
    text = (ROOT / "reproduce" / "paper.toml").read_text()
    settings, section, key = {}, None, None
    for row in text.splitlines():
        if header := re.fullmatch(r"\[([\w.]+)\]", row):
            section = header[1]
        elif entry := re.fullmatch(r"(\w+) = (.+?)\s+# (.+)", row):
            key = f"{section}.{entry[1]}"
            settings[key] = {"value": entry[2].strip('"'), "comment": entry[3]}
        elif (more := re.fullmatch(r"\s+# (.+)", row)) and key:
            settings[key]["comment"] += f" {more[1]}"
    parsed = tomllib.loads(text)
    keys = {key for key, _ in flat(parsed)}
    assert keys == set(settings), f"paper.toml: no comment beside {keys - set(settings)}"
    for setting in settings.values():
        comment = setting["comment"]
        setting["ours"] = "ours:" in comment
        unit = re.match(rf"(?:ours: |stated \([\d.]+\): )({'|'.join(map(re.escape, UNITS))})(?:[,;]|$)", comment)
        setting["unit"] = f" {unit[1].replace('^3', '³')}" if unit else ""
    return settings


def line(title, keys, paper, reason, settings, searched):
    names = ", ".join(f"`{key}`" for key in keys)
    ours = ", ".join(settings[key]["value"] + settings[key]["unit"] for key in keys)
    sources = {}
    for key in keys:
        sources.setdefault(source_of(key, settings[key], searched), []).append(key.split(".")[-1])
    if len(sources) == 1:
        origin = next(iter(sources))
    else:
        origin = "; ".join(f"{name}: {', '.join(keys)}" for name, keys in sources.items())
    return f"| {f'{title}: ' if title else ''}{names} | {paper} | {ours} | {reason} | {origin} |"


def source_of(key, setting, searched):
    if stated := re.match(r"stated (\([\d.]+\))(?!.*ours:)", setting["comment"]):
        return f"paper {stated[1]}"
    if key in FLUID:
        return "[our interpretation](fluid.md)"
    if key.startswith("schema.authors."):
        return "[authors' code](method.md)"
    if key in searched:
        return f"[{searched[key]}](search.md)"
    if cited := re.search(r"[A-Z]\w+ and [A-Z]\w+ \(\d{4}\)", setting["comment"]):
        return cited[0]
    return "our choice"


def capital(text):
    return text[:1].upper() + text[1:]


main()
