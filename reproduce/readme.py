#!/usr/bin/env python3
"""Puts the claims and two figures of finished runs into the README: reproduce/readme.py [RESULTS]

RESULTS holds exp1 and exp2, and is results/ if not given. The README's text between <!-- NAME --> and
<!-- /NAME --> becomes NAME's claims.md.
"""

import pathlib
import re
import shutil
import sys

root = pathlib.Path(__file__).resolve().parent.parent
results = pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else root / "results"
readme = root / "README.md"
shown = root / "reproduce" / "shown"
shown.mkdir(exist_ok=True)
text = readme.read_text()
for name, figure in [("exp1", "fig10b-tree"), ("exp2", "fig11b-tree")]:
    claims = (results / name / "claims.md").read_text().strip()
    text, found = re.subn(
        rf"(<!-- {name} -->\n).*?(<!-- /{name} -->)", lambda marks: f"{marks[1]}{claims}\n{marks[2]}", text, flags=re.S
    )
    assert found == 1, f"README.md has no marks of {name}"
    shutil.copy(results / name / "figures" / f"{figure}.svg", shown / f"{figure}.svg")
readme.write_text(text)
