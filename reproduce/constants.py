#!/usr/bin/env python3
"""List the numbers in the code that decide what `estimate` finds: reproduce/constants.py [--check]

Reads the constants of its stages, with what is said of each there, and writes docs/shown/numbers/README.md. With --check, it compares
them with that page instead. Needs Python 3.11, and no packages. Status: 0; 1 if the page is another one.
"""

import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
PAGE = ROOT / "docs" / "shown" / "numbers" / "README.md"
# What `estimate` does in order, by the folder or file of src.
STAGES = [
    ("stages/usable", "Which values and sensors are used"),
    ("stages/noise", "Noise"),
    ("stages/rigid_parts", "The parts"),
    ("stages/joints", "The tree"),
    ("estimate", "The fit, and repeats"),
]
CONSTANT = re.compile(r"((?:^ *///[^\n]*\n)*)^ *(?:pub(?:\([a-z]+\))? )?const ([A-Z_0-9]+): ([^=]+) = ([^;]+);", re.M)


def main():
    text = page()
    if "--check" not in sys.argv[1:]:
        PAGE.parent.mkdir(parents=True, exist_ok=True)
        PAGE.write_text(text)
    elif not PAGE.exists() or PAGE.read_text() != text:
        print("constants: docs/shown/numbers/README.md is not of these constants; run reproduce/constants.py", file=sys.stderr)
        return 1
    return 0


def page():
    tables = [(title, numbers(stage)) for stage, title in STAGES]
    count = sum(map(len, (rows for _, rows in tables)))
    lines = [
        "# The numbers of `estimate`",
        "",
        f"The code of `bodyschema estimate` has {count} numbers. Most decide, or bound, what it finds; a few only bound its time and memory. None is a",
        "setting. Made by",
        "`reproduce/constants.py` from the code, where the reason for each stands; how each step uses them is in [estimate.md](../../estimate.md).",
        "They were chosen on calibration data ([seeds.toml](../../../reproduce/seeds.toml)). How results change with each was not studied.",
        "Names of one meaning for several steps, such as RIDGE, are one number each.",
    ]
    for title, rows in tables:
        lines += ["", f"## {title}", "", "| number | value | what it is | file |", "|---|---|---|---|"]
        lines += [f"| {name} | `{value}` | {meaning} | [{file.name}](../../../{file}) |" for file, name, value, meaning in rows]
    return "\n".join(lines) + "\n"


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
            said = " ".join(line.strip().removeprefix("///").strip() for line in comment.splitlines())
            # Two together have one comment.
            last = said or (last if found.start() == end + 1 else "")
            end = found.end()
            if "&str" not in kind:
                rows.append((file.relative_to(ROOT), name, value, last.replace("|", "\\|")))
    return rows


if __name__ == "__main__":
    sys.exit(main())
