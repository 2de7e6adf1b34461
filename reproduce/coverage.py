#!/usr/bin/env python3
"""Turn tarpaulin's JSON report into a table of line coverage that names the lines that no test runs.

Usage: coverage.py ROOT REPORT.json
"""

import json
import pathlib
import sys

root, report = pathlib.Path(sys.argv[1]).resolve(), json.load(open(sys.argv[2]))
rows = []
for file in report["files"]:
    path = pathlib.Path(*file["path"]).relative_to(root)
    if path.parts[0] != "src" or "tests" in path.parts or path.name in ("tests.rs", "testing.rs", "fixtures.rs"):
        continue
    source = (root / path).read_text().splitlines()
    tests_from = next((n for n, line in enumerate(source, 1) if line.startswith("#[cfg(test)]")), len(source) + 1)
    traces = [t for t in file["traces"] if t["line"] < tests_from]
    missed = [t["line"] for t in traces if not t["stats"].get("Line")]
    if traces:
        rows.append((str(path), len(traces) - len(missed), len(traces), missed))

covered, lines = sum(row[1] for row in rows), sum(row[2] for row in rows)
print(f"Line coverage of `src` by `cargo test` (tests themselves left out): {covered} of {lines} lines, "
      f"{100 * covered / lines:.1f} %. Made by `reproduce/evidence.sh`.\n")
print("| file | lines | covered | not run |")
print("|---|---|---|---|")
for path, hit, total, missed in sorted(rows):
    print(f"| {path} | {total} | {100 * hit / total:.0f} % | {', '.join(map(str, missed)) or 'none'} |")
