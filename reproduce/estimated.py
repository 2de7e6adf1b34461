"""What scripts share: boxes.py, gaps.py, recordings.py, repeats.py and robots.py, which count how often parts and tree are right, and others that read tables."""

import csv
import hashlib
import json
import math
import pathlib
import subprocess
import sys
import tempfile
import urllib.request

ROOT = pathlib.Path(__file__).resolve().parent.parent
PROGRAM = ROOT / "target" / "release" / "bodyschema"
TRUTH = ["true_parts", "parts", "ari", "true_joints", "joints_right", "tree_right"]
USES = ["held out", "calibration"]  # what a recording or robot has served


def downloaded(file, url, sha256):
    """The file, downloaded if it is not there, with the content that was measured."""
    if not file.exists():
        file.parent.mkdir(parents=True, exist_ok=True)
        try:
            with urllib.request.urlopen(url, timeout=60) as answer:
                file.write_bytes(answer.read())
        except OSError as error:
            fail(f"{url}: {error}; save it yourself as {file}")
    if hashlib.sha256(file.read_bytes()).hexdigest() != sha256:
        fail(f"{file}: not the file that was measured; delete it to download it again")
    return file


def estimated(felt, found, seed, *options):
    """What `estimate` finds in what was felt, compared with the truth: its summary, and the columns of TRUTH."""
    truth = ["--labels", felt / "labels.csv", "--tree", felt / "tree.csv"]
    run("estimate", felt / "tactile.npy", *truth, "--seed", seed, "--out", found, "--force", *options)
    summary = json.loads((found / "summary.json").read_text())
    truth = summary["truth"]
    return summary, {
        "true_parts": truth["parts"],
        "parts": summary["parts"],
        "ari": f"{truth['adjusted_rand_index']:.3f}",
        "true_joints": truth["parts"] - 1,
        "joints_right": truth["joints_right"],
        "tree_right": str(truth["tree_right"]).lower(),
    }


def revision():
    """The program's revision, which an estimate has."""
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        run("simulate", "--body", ROOT / "bodies" / "chain-3.toml", "--duration", 100, "--out", folder / "felt")
        return estimated(folder / "felt", folder / "found", 1)[0]["revision"]


def revisions(rows):
    """The revision that rows were counted with; if it is not one, that of the rows of each use."""
    of = {use: sorted({row["revision"][:7] for row in rows if row.get("use") == use}) for use in [*USES, None]}
    counted = {use: " and ".join(own) for use, own in of.items() if own}
    if len(set(counted.values())) == 1:
        return next(iter(counted.values()))
    return ", ".join(f"{own} ({use})" for use, own in counted.items())


def noisy(pressures, noise, random):
    """With Gaussian noise, whose standard deviation is this share of the root mean square of each sensor."""
    return pressures + noise * (pressures**2).mean(0) ** 0.5 * random.standard_normal(pressures.shape)


def resumed(table, columns, jobs, measured, keeps=lambda row: False, order=lambda row: 0):
    """Write the rows of all jobs to a table, in an order, and return them. A run that was stopped continues after its last job.

    Rows of an earlier table that `keeps` approves of stay, and the jobs that they are of are not done again."""
    part = table.with_suffix(".csv.part")
    is_of = lambda row, job: all(row[key] == str(value) for key, value in job.items())
    rows = [row for row in read(table) if keeps(row)] if table.exists() else []
    if part.exists():
        rows = [row for row in read(part) if keeps(row) or any(is_of(row, job) for job in jobs)]
    for job in jobs:
        if not any(is_of(row, job) for row in rows):
            for row in measured(**job):
                rows.append({column: str(row.get(column, "")) for column in columns})
                print(" ".join(value for value in rows[-1].values() if value), flush=True)
            write(part, columns, rows)
    rows.sort(key=order)
    write(part, columns, rows)
    part.replace(table)
    return rows


def read(table):
    """The rows of a CSV file."""
    with open(table, newline="") as file:
        return list(csv.DictReader(file))


def write(table, columns, rows):
    """Write rows to a CSV file."""
    with open(table, "w", newline="") as file:
        writer = csv.DictWriter(file, columns, lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)


def flat(table, path=""):
    """The settings of a table by their dotted names."""
    for key, value in table.items():
        if isinstance(value, dict):
            yield from flat(value, f"{path}{key}.")
        else:
            yield f"{path}{key}", value


def wilson(count, of):
    """The 95 % interval of the share of a count (Wilson)."""
    z = 1.96
    middle, half = count + z * z / 2, z * math.sqrt(count * (of - count) / of + z * z / 4)
    return [(middle + sign * half) / (of + z * z) for sign in (-1, 1)]


def interval(count, of):
    """A count with the 95 % interval of its share."""
    low, high = wilson(count, of)
    return f"{count} of {of} ({100 * low:.0f} to {100 * high:.0f} %)"


def trees_right(rows, wrong=0):
    """How many trees are right, with the 95 % interval of their share; of so many more that are wrong, too."""
    return interval(sum(row["tree_right"] == "true" for row in rows), len(rows) + wrong) if rows else "–"


def is_alarm(row):
    """Whether `estimate` said that rigid parts do not fit."""
    return row["fit"] in ("does not fit", "refused")


def outcome(row):
    """Cells of a table: true parts, parts found, adjusted Rand index, joints right, and the tree."""
    tree = "right" if row["tree_right"] == "true" else "wrong"
    return [row["true_parts"], row["parts"], row["ari"], f"{row['joints_right']} of {row['true_joints']}", tree]


def run(*words):
    """Run the program; stop with its message if it fails."""
    done = tried(*words)
    if done.returncode:
        fail(f"bodyschema {' '.join(str(word) for word in words[:2])} failed: {done.stderr.strip()}")
    return done


def tried(*words):
    """Run the program, whether or not it fails."""
    return subprocess.run([str(word) for word in (PROGRAM, *words)], capture_output=True, text=True)


def fail(message):
    print(f"{pathlib.Path(sys.argv[0]).stem}: {message}", file=sys.stderr)
    sys.exit(2)
