#!/usr/bin/env python3
"""Estimate the parts of recorded movements of others: reproduce/recordings.py [--use USE] [--files FOLDER] [--out FOLDER]

Downloads the files that recordings.toml names into FOLDER of --files, where they are not there yet, and checks each. Imports each
as a body, feels its movement (`bodyschema simulate --movement`), and asks `bodyschema estimate` how what it finds compares with the truth.
Writes recordings.csv and README.md into the folder of --out, which is docs/shown/recordings. Those that are held out come first. Rows of
the same revision are kept, so a run that was stopped continues. With --use "held out" or calibration, only recordings of that use are
counted, and rows of the other use stay as they are. Needs Python 3.11, and no packages. Takes about an hour on two cores, of which those that
are held out take a fourth. Status: 0, or 2 on an error.
"""

import argparse
import pathlib
import sys
import tempfile

try:
    import tomllib
except ModuleNotFoundError:
    sys.exit("recordings: needs Python 3.11 or newer")

from estimated import ROOT, TRUTH, USES, downloaded, estimated, outcome, resumed, revision, revisions, run, trees_right

COLUMNS = ["recording", "use", "samples", "sensors", "fit", *TRUTH, "revision"]


def main():
    parser = argparse.ArgumentParser(description="Estimate the parts of recorded movements of others.")
    parser.add_argument("--use", choices=USES, help="count only the recordings of this use")
    parser.add_argument("--files", type=pathlib.Path, default=ROOT / "results" / "recordings", help="folder of the .bvh files")
    parser.add_argument("--out", type=pathlib.Path, default=ROOT / "docs" / "shown" / "recordings", help="folder to write to")
    arguments = parser.parse_args()
    design = tomllib.loads((ROOT / "reproduce" / "recordings.toml").read_text())
    of = lambda name: arguments.files / f"{name}.bvh"
    for one in design["recording"]:
        downloaded(of(one["name"]), one["url"], one["sha256"])
    arguments.out.mkdir(parents=True, exist_ok=True)
    table, current = arguments.out / "recordings.csv", revision()
    counts = lambda one: one["use"] == (arguments.use or one["use"])
    stays = lambda row: row["revision"] == current or not counts(row)
    names = [one["name"] for one in design["recording"]]
    recordings = sorted(filter(counts, design["recording"]), key=lambda one: USES.index(one["use"]))
    jobs = [{"recording": one["name"], "use": one["use"], "revision": current} for one in recordings]
    measured = lambda **job: [{**job, **found(of(job["recording"]), design)}]
    rows = resumed(table, COLUMNS, jobs, measured, stays, lambda row: names.index(row["recording"]))
    (arguments.out / "README.md").write_text(page(rows, design))
    return 0


def found(file, design):
    """What `estimate` finds in a recorded movement, compared with the truth."""
    with tempfile.TemporaryDirectory() as name:
        folder, seed = pathlib.Path(name), design["seed"]
        feel(file, design, folder / "body.toml", folder / "felt")
        summary, truth = estimated(folder / "felt", folder / "found", seed)
    sensors = summary["sensors"] - summary["dropped"]
    return {"samples": summary["samples"], "sensors": sensors, "fit": summary["fit"], **truth}


def feel(file, design, body, felt):
    """Import a recorded movement as a body, and feel it."""
    run("body", "import", file, "--min-length", design["min_length"], "--out", body)
    run("simulate", "--body", body, "--movement", file, "--seed", design["seed"], "--out", felt)


def page(rows, design):
    """The page: bad results first."""
    urls = {one["name"]: one["url"] for one in design["recording"]}
    lines = [
        "# Recorded movements",
        "",
        f"Made by `reproduce/recordings.py` with revision {revisions(rows)}.",
        "Each movement was recorded by others; the skin is virtual, without noise. Bones of at least",
        f"{design['min_length']} m carry 40 sensors each. A name leads to the file, and [recordings.toml](../../../reproduce/recordings.toml) says",
        "how recordings were chosen, and what each was used for. No number of the method was chosen on those that are held out, but",
        "earlier revisions were counted on them, too.",
        "A joint is right if it joins parts that turn about one place, and a tree if its parts",
        "and joints are. The lowest adjusted Rand index comes first. Of one file, the script does this:",
        "",
        f"    bodyschema body import FILE.bvh --min-length {design['min_length']} --out body.toml",
        f"    bodyschema simulate --body body.toml --movement FILE.bvh --seed {design['seed']} --out felt",
        f"    bodyschema estimate felt/tactile.npy --labels felt/labels.csv --tree felt/tree.csv --seed {design['seed']} --out found --force",
        "",
        "| recording | use | T × M | fit | true parts | parts found | adjusted Rand index | joints right | tree |",
        "|---|---|---|---|---|---|---|---|---|",
    ]
    for row in sorted(rows, key=lambda row: float(row["ari"])):
        size = f"{int(row['samples']):,} × {int(row['sensors']):,}"
        cells = [f"[{row['recording']}]({urls[row['recording']]})", row["use"], size, row["fit"], *outcome(row)]
        lines.append("| " + " | ".join(str(cell) for cell in cells) + " |")
    for what, own in [("all", rows), ("held out", [row for row in rows if row["use"] == "held out"])]:
        if not own:
            continue
        mean = sum(float(row["ari"]) for row in own) / len(own)
        lines += ["", f"Mean of the adjusted Rand index, {what}: {mean:.3f} (n = {len(own)}); trees right: {trees_right(own)}."]
    for one in design["recording"]:
        if until := one.get("held_out_until"):
            lines += ["", f"{one['name']} was held out until revision {until} failed on it, and it was looked into."]
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    sys.exit(main())
