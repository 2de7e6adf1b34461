#!/usr/bin/env python3
"""Put the results of finished runs into the repository: reproduce/docs.py [RESULTS]

RESULTS is the folder that holds exp1, exp2, search, sensitivity, ablation, step, momentum, multiverse, multiverse-held-out, mixing and
bodies (default: results/). It updates

- README.md: the table between <!-- claims --> and <!-- /claims -->, from claims.csv of both experiments;
- docs/results.md: the tables of both experiments, from their claims.md;
- docs/shown/: claims, tables and pictures of both experiments, and those of the studies;
- docs/sensitivity.md, ablation.md, step.md, momentum.md, multiverse.md, mixing.md and bodies.md: the pages of the studies;
- DEVIATIONS.md: the table of open settings, from paper.toml, sensitivity.toml and the search that is
  shown. It needs no run;
- docs/claims.md: the paper's sentences, claims and verdicts, from claims.toml and docs/shown. It needs no run;
- article/values.toml: the numbers of the article, from docs/shown. It needs no run.

What RESULTS does not hold is skipped, with a line on standard error. Needs Python 3.11, and no packages.
"""

import csv
import gzip
import json
import pathlib
import re
import shutil
import subprocess
import sys
import tomllib

ROOT = pathlib.Path(__file__).resolve().parent.parent
SHOWN = ROOT / "docs" / "shown"

# The claims that the README shows: what the abstract of the paper rests on.
CLAIMS = [
    ("exp1", "tree-accuracy"),
    ("exp1", "baseline-tree"),
    ("exp2", "best-coordination"),
    ("exp2", "tree-random-movement"),
]
# Stands for the headline of the other reading.
OTHER = "other-reading"
VERDICTS = ["reproduced", "not reproduced", "not testable"]
UNITS = ["kg/m^3", "N m s/rad", "N m/rad", "m", "s"]


def main():
    results = pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else ROOT / "results"
    studies = [search, sensitivity, ablation, shorter_step, momentum, multiverse, held_out, mixing, bodies]
    for step in [claims, experiment_1, experiment_2, *studies]:
        try:
            step(results)
        except FileNotFoundError as missing:
            skip(step, f"{missing.filename} is missing")
        except Skip as reason:
            skip(step, str(reason))
    deviations()
    for script in ["reproduce/claims.py", "article/values.py"]:
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


def claims(results):
    """README.md: five claims, the headline by both readings, and how many of all are reproduced."""
    experiments = {name: read_claims(results / name) for name in ["exp1", "exp2"]}
    other = {name: claims.pop(OTHER, None) for name, claims in experiments.items()}
    del other["exp2"]  # the same bodies at the same p and d as in experiment 1
    columns = ["verdict", "claim", "published", "reproduced", "95 % interval", "n", "accepted"]
    lines = [row(columns), f"|{'---|' * len(columns)}"]
    for name, id in CLAIMS:
        for claim in [experiments[name][id], other.pop(name, None)]:
            if claim:
                lines.append(row([f"**{claim['verdict']}**"] + [claim[column] for column in columns[1:]]))
    # A claim of both experiments counts once.
    verdicts = [claim["verdict"] for claim in (experiments["exp1"] | experiments["exp2"]).values()]
    counts = ", ".join(f"{verdicts.count(verdict)} {verdict}" for verdict in VERDICTS)
    lines += ["", f"All {len(verdicts)} claims: {counts}. {source(results)}"]
    between_marks(ROOT / "README.md", "claims", "\n".join(lines))


def row(cells):
    return f"| {' | '.join(cells)} |"


def read_claims(folder):
    """The cells of claims.md by the claim's id, without the rows of the extension; the other reading's headline is OTHER."""
    table = [line.strip("| ").split(" | ") for line in (folder / "claims.md").read_text().splitlines() if "|" in line[:1]]
    header, rows = table[0], table[2:]
    with open(folder / "claims.csv", newline="") as file:
        claims = list(csv.DictReader(file))
    assert len(claims) == len(rows), f"{folder}: claims.csv and claims.md do not agree"
    reading = claims[0].get("reading")
    return {
        claim["id"] if claim.get("reading") == reading else OTHER: dict(zip(header, row))
        for claim, row in zip(claims, rows)
        if claim["counting"] == "all-draws"
    }


def source(results):
    """Commands, seed and size of the runs, in a sentence or two."""
    runs = {}
    for name in ["exp1", "exp2"]:
        facts = manifest(results / name)
        experiment, schema = facts["settings"]["experiment"], facts["settings"]["schema"]
        size = (
            f"seed {facts['seed']}, {experiment['simulations']} simulations, {schema['chains']} chains of "
            f"{schema['sweeps']} sweeps for each condition, revision {facts['revision'][:7]}"
        )
        runs.setdefault(size, []).append(f"`reproduce/{name}.sh`")
    return " ".join(f"Made by {' and '.join(commands)}: {size}." for size, commands in runs.items())


def experiment_1(results):
    experiment(results / "exp1", ["fig07-parts", "fig08a-ari-baselines", "fig08b-ari", "fig10a-tree-baseline", "fig10b-tree"])


def experiment_2(results):
    experiment(results / "exp2", ["fig11a-ari", "fig11b-tree"])


def experiment(folder, figures):
    """docs/results.md: all claims of an experiment; and its figures, each a table and a picture."""
    manifest(folder)
    table = (folder / "claims.md").read_text().strip()
    pairs = [folder / "figures" / f"{name}.{kind}" for name in figures for kind in ["csv", "svg"]]
    copy([folder / "claims.csv", folder / "manifest.json", *pairs], SHOWN / folder.name)
    between_marks(ROOT / "docs" / "results.md", folder.name, table)


# ---- The studies


def search(results):
    shown = SHOWN / "fluid-pairwise"  # the part whose winner is the default
    # The last round leaves no candidates, and one without a resolved candidate no winner.
    optional = ["next.toml", "best.toml"]
    there = [name for name in optional if (results / "search" / name).exists()]
    copy([results / "search" / name for name in ["search.md", "scores.csv", "credits.csv", *there]], shown)
    for name in set(optional) - set(there):
        (shown / name).unlink(missing_ok=True)


def sensitivity(results):
    study(results / "sensitivity", "sensitivity.md", ["sensitivity.csv"])


def ablation(results):
    study(results / "ablation", "comparison.md", ["comparison.csv"])


def shorter_step(results):
    study(results / "step", "comparison.md", ["comparison.csv"])


def momentum(results):
    study(results / "momentum", "comparison.md", ["comparison.csv"])


def multiverse(results):
    tables = ["multiverse.csv", "specifications.csv", "shares.csv", "variance.csv", "joint.csv"]
    study(results / "multiverse", "multiverse.md", tables)
    # Over a megabyte, and nearly all of it again and again the same.
    page = ROOT / "docs" / "multiverse.md"
    for table in tables[:2]:
        plain = SHOWN / "multiverse" / table
        plain.with_name(f"{table}.gz").write_bytes(gzip.compress(plain.read_bytes(), mtime=0))
        plain.unlink()
        page.write_text(page.read_text().replace(f"/{table})", f"/{table}.gz)"))


def held_out(results):
    """The section of docs/multiverse.md on the multiverse of another seed."""
    manifest(results / "multiverse-held-out")
    own, other = (read_shares(results / name) for name in ["multiverse", "multiverse-held-out"])
    rows = [
        "## Another seed\n",
        "The same design with other bodies, movements and specifications (`reproduce/multiverse-held-out.sh`): all "
        f"{other['all', 'tree-accuracy']['n']} of them. Within: whether that share lies in the interval of the large "
        "multiverse. [Its shares](shown/multiverse-held-out/shares.csv).\n",
        "| claim | share | of the other seed | within |",
        "|---|---|---|---|",
    ]
    within = 0
    for (group, claim), share in own.items():
        if group == "all":
            inside = float(share["low"]) <= float(other[group, claim]["share"]) <= float(share["high"])
            within += inside
            cells = [claim, percent(share), percent(other[group, claim]), "yes" if inside else "no"]
            rows.append(f"| {' | '.join(cells)} |")
    count = len(rows) - 4
    rows.append(f"\n{within} of {count} shares lie within.\n")
    copy([results / "multiverse-held-out" / "shares.csv"], SHOWN / "multiverse-held-out")
    page = ROOT / "docs" / "multiverse.md"
    text = re.sub(r"## Another seed\n.*?(?=## The choices\n)", "", page.read_text(), flags=re.S)
    before, choices = text.split("## The choices\n")
    section = "\n".join(rows)
    page.write_text(f"{before}{section}\n## The choices\n{choices}")


def read_shares(folder):
    with open(folder / "shares.csv", newline="") as file:
        return {(row["group"], row["claim"]): row for row in csv.DictReader(file)}


def percent(share):
    value, low, high = (f"{100 * float(share[key]):.1f}" for key in ["share", "low", "high"])
    return f"{value} % ({low} to {high})"


def bodies(results):
    study(results / "bodies", "bodies.md", ["recordings.csv", "edges.csv"])


def mixing(results):
    tables = ["bodies-chains.csv", "bodies-posterior.csv", "edges.csv", "traces.csv", "traces-seconds.csv"]
    study(results / "mixing", "mixing.md", tables)


def study(folder, page, tables):
    """Put the page of a study into docs/, and its tables and pictures into docs/shown/."""
    name, text = folder.name, (folder / page).read_text()
    copy([*(folder / table for table in tables), *sorted((folder / "figures").glob("*.svg"))], SHOWN / name)
    # The page moves, so that links to its own files and to those of the repository change.
    for old, new in [
        ("](figures/", f"](shown/{name}/"),
        *((f"]({table})", f"](shown/{name}/{table})") for table in tables),
        ("](reproduce/shown/", "](shown/"),
        ("](docs/", "]("),
        ("](reproduce/", "](../reproduce/"),
    ]:
        text = text.replace(old, new)
    (ROOT / "docs" / f"{name}.md").write_text(text)


# ---- The open settings


def deviations():
    """DEVIATIONS.md: what the paper leaves open, and what this replication does instead."""
    settings = read_settings()
    folder = ROOT / "reproduce"
    study = tomllib.loads((folder / "sensitivity.toml").read_text())
    # What the search has varied.
    searched = set()
    for screen in ["screen", "fluid-screen"]:
        with open(SHOWN / screen / "scores.csv", newline="") as file:
            searched.update(key for row in csv.DictReader(file) for key in re.findall(r"([\w.]+) = ", row["settings"]))
    lines = ["| setting | the paper says | ours | reason | source |", "|---|---|---|---|---|"]
    named = set()
    for part in study["part"]:
        if part["name"] == "pairs":
            continue
        named.update(part["settings"])
        if any(settings[key]["ours"] for key in part["settings"]):
            lines.append(
                line(
                    f"[{part['title']}](docs/sensitivity.md{anchor(part['name'])})",
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
            reason = "; ".join(ours)
            paper = "; ".join(paper) or "nothing"
            lines.append(line("", [key], capital(paper), capital(reason), settings, searched))
    between_marks(ROOT / "DEVIATIONS.md", "settings", "\n".join(lines))


def anchor(part):
    """The place of a part in the study's page, if the study that is shown has it."""
    page = (ROOT / "docs" / "sensitivity.md").read_text()
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
    keys = set(flat(parsed))
    assert keys == set(settings), f"paper.toml: no comment beside {keys - set(settings)}"
    for setting in settings.values():
        comment = setting["comment"]
        setting["ours"] = "ours:" in comment
        unit = re.match(rf"(?:ours: |stated \([\d.]+\): )({'|'.join(map(re.escape, UNITS))})(?:[,;]|$)", comment)
        setting["unit"] = f" {unit[1].replace('^3', '³')}" if unit else ""
    return settings


def flat(table):
    """Dotted names of all settings of a table."""
    for name, value in table.items():
        if isinstance(value, dict):
            yield from (f"{name}.{key}" for key in flat(value))
        else:
            yield name


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
    if key.startswith("schema.authors."):
        return "[authors' code](docs/authors-code.md)"
    if key in searched:
        return "[search](docs/search.md)"
    if cited := re.search(r"[A-Z]\w+ and [A-Z]\w+ \(\d{4}\)", setting["comment"]):
        return cited[0]
    return "our choice"


def capital(text):
    return text[:1].upper() + text[1:]


main()
