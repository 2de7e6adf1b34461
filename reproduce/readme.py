#!/usr/bin/env python3
"""Puts what finished runs found into the repository: reproduce/readme.py [RESULTS]

RESULTS holds exp1 and exp2, and is results/ if not given. The README's text between <!-- NAME --> and
<!-- /NAME --> becomes NAME's claims.md, and two figures go beside it. Where RESULTS also holds search or sensitivity,
their tables and pictures go to reproduce/shown/, and the study's page becomes DEVIATIONS.md.
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

search = results / "search"
if search.exists():
    (shown / "search").mkdir(exist_ok=True)
    for name in ["search.md", "scores.csv", "credits.csv", "best.toml"]:
        shutil.copy(search / name, shown / "search" / name)

study = results / "sensitivity"
if study.exists():
    (shown / "sensitivity").mkdir(exist_ok=True)
    for path in [study / "sensitivity.csv", *(study / "figures").glob("*.svg")]:
        shutil.copy(path, shown / "sensitivity" / path.name)
    page = (study / "DEVIATIONS.md").read_text()
    page = page.replace("](figures/", "](reproduce/shown/sensitivity/")
    page = page.replace("](sensitivity.csv)", "](reproduce/shown/sensitivity/sensitivity.csv)")
    (root / "DEVIATIONS.md").write_text(page)
