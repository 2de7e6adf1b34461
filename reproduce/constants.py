#!/usr/bin/env python3
"""List the parameters and constants that decide what `estimate` finds: reproduce/constants.py [--check]

Reads its parameters and the constants of its stages, with what is said of each there, and what influence.py found. Writes
docs/shown/parameters/README.md. With --check, it compares them with that page instead. Needs Python 3.11, and no packages. Status: 0; 1 if
the page is another one.
"""

import collections
import pathlib
import re
import sys

from estimated import read, revisions

ROOT = pathlib.Path(__file__).resolve().parent.parent
PAGE = ROOT / "docs" / "shown" / "parameters" / "README.md"
# What `estimate` does in order, by the folder or file of src.
STAGES = [
    ("stages/usable", "Which values and sensors are used"),
    ("stages/noise", "Noise"),
    ("stages/rigid_parts", "The parts"),
    ("stages/joints", "The tree"),
    ("estimate", "The fit, and repeats"),
]
# What is said of a number that is no decision.
UNSEEN = "changes no result"
INFLUENCE = PAGE.parent / "influence.csv"
SETTABLE = ROOT / "src" / "stages" / "parameters.rs"
PARAMETER = re.compile(r"((?:^ +///[^\n]*\n)+)^ +([a-z_]+): (?:f64|usize) = ([^,\n]+),", re.M)
CONSTANT = re.compile(r"((?:^ *///[^\n]*\n)*)^ *(?:pub(?:\([a-z]+\))? )?const ([A-Z_0-9]+): ([^=]+) = ([^;]+);", re.M)


def main():
    text = page()
    if "--check" not in sys.argv[1:]:
        PAGE.parent.mkdir(parents=True, exist_ok=True)
        PAGE.write_text(text)
    elif not PAGE.exists() or PAGE.read_text() != text:
        print("constants: docs/shown/parameters/README.md is not of these constants; run reproduce/constants.py", file=sys.stderr)
        return 1
    return 0


def page():
    tables = [(title, numbers(stage)) for stage, title in STAGES]
    can_be_set = settable()
    count = len(can_be_set) + sum(map(len, (rows for _, rows in tables)))
    lines = [
        "# The parameters of `estimate`",
        "",
        f"{count} names stand for numbers in the code of `bodyschema estimate`; some have two to four values. Most decide, or bound, what it",
        "finds; some only bound its time and memory. They were chosen on calibration data",
        "([seeds.toml](../../../reproduce/seeds.toml)). How each step uses them is in [estimate.md](../../estimate.md). Not counted are names",
        "that follow from others, and those that change no result.",
        "",
        f"{len(can_be_set)} of them are parameters, which can be changed from 1/100 to 100 times the default: `estimate --parameter NAME=VALUE`, and in",
        "Python `estimate(touch, parameters={...})`. All others are constants, which were not varied. Made by `reproduce/constants.py` from the",
        "code.",
        "",
        "## Parameters",
        "",
        *influence(can_be_set),
        "",
        "## Constants",
        "",
        "Names of one meaning for several steps, such as RIDGE, are one number each.",
    ]
    for title, rows in tables:
        lines += ["", f"### {title}", "", "| number | value | what it is | file |", "|---|---|---|---|"]
        lines += [f"| {name} | `{value}` | {meaning} | [{file.name}](../../../{file}) |" for file, name, value, meaning in rows]
    return "\n".join(lines) + "\n"


def settable():
    """The parameters: name, default, and what each is."""
    found = PARAMETER.findall(SETTABLE.read_text())
    return [(name, value, meaning_of(comment)) for comment, name, value in found]


def influence(can_be_set):
    """What comes out with each parameter halved and doubled, where influence.py has tried it."""
    if not INFLUENCE.exists():
        rows = [f"| {name} | `{value}` | {said} |" for name, value, said in can_be_set]
        return ["How results change with each has not been counted yet.", "", "| parameter | default | what it is |", "|---|---|---|", *rows]
    rows = collections.defaultdict(list)
    for row in read(INFLUENCE):
        rows[row["parameter"], row["value"]].append(row)
    default = rows["", ""]
    data = collections.Counter(row["data"] for row in default)
    right = lambda own: sum(row["tree_right"] == "true" for row in own)
    index = lambda own: sum(float(row["ari"]) for row in own) / len(own)
    decisive, counted, table = 0, 0, []
    for name, value, said in can_be_set:
        tried = sorted((float(other), other, rows[key, other]) for key, other in rows if key == name)
        # Of a study that goes on, a parameter may have one of its two values.
        tried = tried if len(tried) == 2 else []
        outcomes = [outcome(own, default) for _, _, own in tried]
        cells = [f"{other}: {said_of}, {index(own):.3f}" for (_, other, own), said_of in zip(tried, outcomes)]
        counted += bool(tried)
        decisive += any("(" in said_of for said_of in outcomes)
        table.append(f"| {name} | `{value}` | {' | '.join(cells or ['–', '–'])} | {said} |")
    changed = collections.Counter(row["recording"] for own in rows.values() for row in differing(own, default))
    most = changed.most_common(1)[0]
    return [
        f"`reproduce/influence.py` halved and doubled each, all others as they are (revision {revisions(default)}), on calibration data:",
        "",
        *(f"- {name} (n = {count})" for name, count in data.items()),
        "",
        f"With the defaults, {right(default)} of {len(default)} trees are right, and the adjusted Rand index is {index(default):.3f} on average. Each",
        "cell has the value, how many trees are right, in brackets how many became wrong (−) and right (+), and the mean index.",
        f"{decisive} of the {counted} parameters that were tried change whether any tree is right."
        + (" The others have not been tried yet." if counted < len(can_be_set) else ""),
        f"Of all {sum(changed.values())} changes, {most[1]} are of one recording, {most[0]}.",
        "",
        "| parameter | default | halved | doubled | what it is |",
        "|---|---|---|---|---|",
        *table,
    ]


def differing(own, default):
    """The recordings of which the tree is right in one and not in the other."""
    before = {(row["data"], row["recording"]): row["tree_right"] for row in default}
    return [row for row in own if before[row["data"], row["recording"]] != row["tree_right"]]


def outcome(own, default):
    """How many trees are right, and how many changed."""
    changed = collections.Counter(row["tree_right"] for row in differing(own, default))
    marks = [f"{sign}{changed[kind]}" for kind, sign in [("false", "−"), ("true", "+")] if changed[kind]]
    right = sum(row["tree_right"] == "true" for row in own)
    return f"{right} ({' '.join(marks)})" if marks else f"{right}"


def meaning_of(comment):
    """What a comment of the code says, as a cell of a table."""
    return " ".join(line.strip().removeprefix("///").strip() for line in comment.splitlines()).replace("|", "\\|")


def numbers(stage):
    """The constants of a stage: file, name, value, and what is said of it or, of the second of two together, of the first."""
    source = ROOT / "src" / stage
    files = [source.with_suffix(".rs"), *sorted(source.rglob("*.rs"))]
    rows = []
    for file in files:
        if not file.exists() or file.stem in ("tests", "fixtures", "testing") or "tests" in file.parts:
            continue
        last, end = "", 0
        for found in CONSTANT.finditer(file.read_text()):
            comment, name, kind, value = found.groups()
            said = meaning_of(comment)
            # Two together have one comment.
            last = said or (last if found.start() == end + 1 else "")
            end = found.end()
            is_derived = re.search("[A-Z]{2,}", value)
            if "&str" not in kind and not is_derived and UNSEEN not in said.lower():
                rows.append((file.relative_to(ROOT), name, value, last))
    return rows


if __name__ == "__main__":
    sys.exit(main())
