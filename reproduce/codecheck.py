#!/usr/bin/env python3
"""Rerun experiments, multiverse and article, and compare with the committed results: codecheck.py [--only NAMES] [--compare-only]

The parts, their commands, files and tolerances are in codecheck.toml. A part that is `on_request` runs only if --only names it.
codecheck.sh calls this in a fresh clone. Status: 0 every file is the same or within its tolerance, 1 one is not, 2 on an
error. Needs Python 3.11, and no packages.
"""

import argparse
import csv
import gzip
import hashlib
import io
import json
import math
import pathlib
import subprocess
import sys
import tomllib

ROOT = pathlib.Path(__file__).resolve().parent.parent
SAME, WITHIN, AGREES, DRAWN, DIFFERS = "same bytes", "within tolerance", "agrees", "drawn from its table", "differs"


def main():
    rules = tomllib.loads((ROOT / "reproduce" / "codecheck.toml").read_text())
    parts = {part["name"]: part for part in rules["part"]}
    usual = [name for name, part in parts.items() if not part.get("on_request")]
    parser = argparse.ArgumentParser(description="Rerun experiments, multiverse and article, and compare with the committed results.")
    choice = f"parts to check, with commas between them: {', '.join(parts)} (without --only: {', '.join(usual)})"
    parser.add_argument("--only", metavar="NAMES", help=choice)
    parser.add_argument("--compare-only", action="store_true", help="compare what earlier runs have left in results/")
    options = parser.parse_args()
    chosen = options.only.split(",") if options.only else usual
    for name in chosen:
        if name not in parts:
            fail(f"there is no part {name!r}; the parts are {', '.join(parts)}")
    if not options.compare_only:
        minutes = rules["build_minutes"] + sum(parts[name]["minutes"] for name in chosen)
        print(f"all of it: about {minutes} min on two cores, with the build", flush=True)
    found = []
    for name, part in parts.items():
        if name in chosen:
            found += check(part, parts, rules, options.compare_only)
    counts = {outcome: sum(outcome == one for one in found) for outcome in [SAME, WITHIN, AGREES, DRAWN, DIFFERS]}
    print(", ".join(f"{count} {outcome}" for outcome, count in counts.items()))
    sys.exit(1 if counts[DIFFERS] else 0)


def fail(message):
    print(f"codecheck: {message}", file=sys.stderr)
    sys.exit(2)


def check(part, parts, rules, compare_only):
    """Outcomes of all files of a part, each with a line."""
    compared = [alike(part, parts[name]) for name in part["like"]] if "like" in part else [part]
    for folder in [ROOT / one.get("committed", ".") for one in compared]:
        if not folder.is_dir():
            fail(f"{folder} is missing: there is nothing to compare {part['name']} with")
    if not compare_only:
        print(f"{part['name']}: {' '.join(part['command'])}, about {part['minutes']} min on two cores: {part['says']}", flush=True)
        status = subprocess.run(part["command"], cwd=ROOT).returncode
        if status not in part["statuses"] + [1]:
            fail(f"{part['command'][0]} ended with status {status}")
        own = AGREES if status in part["statuses"] else DIFFERS
    else:
        own = None
    found = []
    for file in part.get("compares_itself", []):
        if own:
            found.append(tell(file, own, "as its command says"))
    for one in compared:
        found += compare_files(one, rules)
    return found


def alike(part, other):
    """The files of another part, where this one has them: in a folder of that part's name."""
    places = {place: f"{part[place]}/{other['name']}" for place in ["made", "committed"]}
    return other | places | {"name": f"{part['name']}/{other['name']}"}


def compare_files(part, rules):
    """Outcomes of the tables and pictures of a part, each with a line."""
    found = []
    made, committed = (ROOT / part.get(folder, ".") for folder in ["made", "committed"])
    same_kind = witnessed(made, committed, part)
    for table in part.get("table", []) + part.get("picture", []):
        new, old = made / table["made"], committed / table.get("committed", pathlib.Path(table["made"]).name)
        if not new.exists():
            outcome, detail = DIFFERS, "missing"
        elif read(new) == read(old):
            outcome, detail = SAME, ""
        elif "key" not in table:
            outcome, detail = DRAWN, ""
        else:
            outcome, detail = compare(read(new), read(old), table, rules)
        if same_kind and outcome not in [SAME, DIFFERS]:
            outcome, detail = DIFFERS, f"on a machine of the same kind the bytes must be the same; {detail}"
        found.append(tell(table["made"], outcome, detail, part["name"]))
    return found


def witnessed(made, committed, part):
    """Whether the movements and their maps are those of the committed results, as on machines of the same kind."""
    if "witness" not in part or not (made / part["witness"]).exists():
        return False
    new, packed = read(made / part["witness"]), committed / f"{part['witness']}.gz"
    if packed.exists():
        return new == read(packed)
    outputs = json.loads((committed / "manifest.json").read_text())["outputs"]
    return {"file": part["witness"], "sha256": hashlib.sha256(new).hexdigest()} in outputs


def tell(file, outcome, detail="", part=""):
    print(f"  {outcome:<20}  {f'{part}/' if part else ''}{file}{f': {detail}' if detail else ''}", flush=True)
    return outcome


def read(path):
    data = path.read_bytes()
    return gzip.decompress(data) if path.suffix == ".gz" else data


def rows(data, key):
    """Rows of a table by the cells of its key."""
    found = {}
    for row in csv.DictReader(io.StringIO(data.decode())):
        name = tuple(row[column] for column in key)
        if name in found:
            fail(f"two rows are {name}; codecheck.toml must name more columns of the key")
        found[name] = row
    return found


def compare(new, old, table, rules):
    """How a table of a rerun compares with the committed one, and where."""
    ours, theirs = rows(old, table["key"]), rows(new, table["key"])
    if set(ours) != set(theirs) and not table.get("optional_rows"):
        name = next(iter(set(ours) ^ set(theirs)))
        return DIFFERS, f"the row {'/'.join(name)} is in one table alone"
    worst = 0.0, ""
    for name in ours.keys() & theirs.keys():
        where = "/".join(cell for cell in name if cell)
        for column in table.get("exact", []):
            if ours[name][column] != theirs[name][column]:
                return DIFFERS, f"{where}: {column} is {theirs[name][column]!r}, committed {ours[name][column]!r}"
        for column in table["values"]:
            share = distance(ours[name], theirs[name], column, tolerance(table, name), rules)
            worst = max(worst, (share, f"{where}: {theirs[name][column] or 'none'}, committed {ours[name][column] or 'none'}"))
    detail = f"{worst[1]} ({worst[0]:.2f} of its tolerance)" if worst[1] else ""
    return (DIFFERS if worst[0] > 1 else WITHIN), detail


def tolerance(table, name):
    """The stated tolerance of a value without an interval."""
    stated = table.get("tolerance", {})
    return stated.get(name[0] if name else "*", stated.get("*"))


def distance(ours, theirs, column, stated, rules):
    """How far two values are from each other, as a share of the tolerance; above 1 they disagree."""
    errors = [standard_error(row) for row in [ours, theirs]]
    if errors == [None, None] and stated is None:
        return 0.0
    if not ours[column] or not theirs[column]:
        one = ours if ours[column] else theirs
        few = not one[column] or float(one.get("n") or 0) <= rules["few"]
        return 0.0 if few else math.inf
    difference = abs(float(ours[column]) - float(theirs[column]))
    if None not in errors:
        return difference / (rules["standard_errors"] * math.hypot(*errors) + rules["floor"])
    return difference / stated if stated is not None else 0.0


def standard_error(row):
    """That of a row's value, from its 95 % interval."""
    low, high = row.get("low"), row.get("high")
    return (float(high) - float(low)) / (2 * 1.96) if low and high else None


main()
