#!/usr/bin/env python3
"""Run the confirmation that reproduce/confirm.toml registers, and say what came of it: reproduce/confirm.py [--out FOLDER]

Refuses if a frozen file differs from the registered one. Writes FOLDER/exp1, FOLDER/exp2 (as exp1.sh and exp2.sh do) and
FOLDER/confirmation.md. Needs Python 3.11, and no packages. See confirm.sh for the exit status.
"""

import argparse
import csv
import hashlib
import json
import pathlib
import subprocess
import sys

try:
    import tomllib
except ModuleNotFoundError:
    sys.exit("confirm: needs Python 3.11 or newer")

ROOT = pathlib.Path(__file__).resolve().parent.parent
EXPERIMENTS = ["exp1", "exp2"]
# Keys of published.toml that are words for people; the rest decides.
WORDS = ["statement", "wording", "place", "title", "says"]
# Settings of the motion that came after the registration, and count for nothing in a random movement.
LATER = ["movement", "rhythm"]


def main():
    parser = argparse.ArgumentParser(description="Run the registered confirmation.")
    parser.add_argument("--out", type=pathlib.Path, default=ROOT / "results" / "confirm", help="folder to write to")
    parser.add_argument("--check", action="store_true", help="only check that the registered values are unchanged")
    arguments = parser.parse_args()
    out = arguments.out
    registered = tomllib.loads((ROOT / "reproduce" / "confirm.toml").read_text())
    check_frozen(registered["registered"]["files"])
    if arguments.check:
        return 0
    claims = {}
    for experiment in EXPERIMENTS:
        run(experiment, registered["registered"], out / experiment)
        claims[experiment] = read_claims(out / experiment)
        confirmed, text = conclusion(registered, claims)
        (out / "confirmation.md").write_text(text)
    print(text, end="")
    return 0 if confirmed else 1


def check_frozen(files):
    """Stop if the values in a file are not the registered ones; comments and words may change."""
    for file in files:
        if digest(ROOT / file["path"]) != file["sha256"]:
            error(f"{file['path']} has other values than the registered ones; check out a revision that has them (git log reproduce/confirm.toml)")


def digest(path):
    """A hash of what is decided in a TOML file: of its values but for words, with keys in order."""

    def decided(value):
        if isinstance(value, dict):
            return {key: decided(inner) for key, inner in value.items() if key not in WORDS}
        return [decided(inner) for inner in value] if isinstance(value, list) else value

    values = decided(tomllib.loads(path.read_text()))
    motion = values.get("motion", {})
    if motion.get("movement") == "random":
        values["motion"] = {key: value for key, value in motion.items() if key not in LATER}
    return hashlib.sha256(json.dumps(values, sort_keys=True).encode()).hexdigest()


def run(experiment, registered, out):
    """Run an experiment, or go on with it; one that is finished stays."""
    if (out / "manifest.json").exists():
        return
    numbers = ["--seed", str(registered["seed"]), "--simulations", str(registered["simulations"])]
    command = [ROOT / "reproduce" / f"{experiment}.sh", *numbers, "--out", out]
    if subprocess.run(command).returncode not in (0, 1):
        error(f"{experiment}.sh failed; run this again to go on")


def read_claims(folder):
    """The claims of an experiment: those of all samples by the equations, by identifier."""
    with open(folder / "claims.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    return {row["id"]: row for row in rows if (row["counting"], row["reading"]) == ("all-draws", "equations")}


def conclusion(registered, claims):
    """Whether the primary outcome is confirmed, and the text that says so; `claims` has the experiments that are finished."""
    primary = registered["primary"]
    row = claims[primary["experiment"]][primary["claim"]]
    low, high, least, most = (float(row[key] or "nan") for key in ["low", "high", "accepted_low", "accepted_high"])
    confirmed = least <= low and high <= most
    sentence = primary["said_if_confirmed" if confirmed else "said_if_not"].format(
        value=percent(row["value"]),
        n=f"{int(row['n']):,}",
        low=percent(row["low"]),
        high=percent(row["high"]),
        simulations=row["simulations"],
        published=row["wording"],
        accepted=f"{percent(row['accepted_low'])} to {percent(row['accepted_high'])}",
    )
    expected = {
        name: verdict
        for verdict in ["reproduced", "not reproduced"]
        for name in registered["secondary"][verdict.replace(" ", "_")]
    }
    found = {name: claim["verdict"] for experiment in claims for name, claim in claims[experiment].items()}
    found[primary["claim"]] = row["verdict"]
    judged = [name for name in expected if name in found]
    other = [name for name in judged if found[name] != expected[name]]
    counts = f"{len(judged) - len(other)} of {len(judged)} testable claims have the verdict that was expected."
    differ = "".join(f"\n- `{name}`: expected {expected[name]}, found {found[name]}" for name in other)
    running = "" if len(claims) == len(EXPERIMENTS) else "\n\nExperiment 2 is not finished; its claims are not among these."
    return confirmed, f"{sentence}\n\n{counts}{differ}{running}\n"


def percent(text):
    """A share as text, in percent."""
    return f"{100 * float(text):.1f} %" if text else "none"


def error(message):
    print(f"confirm: {message}", file=sys.stderr)
    sys.exit(2)


if __name__ == "__main__":
    sys.exit(main())
