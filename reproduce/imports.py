#!/usr/bin/env python3
"""Count how many public robots `bodyschema body import` reads: reproduce/imports.py FOLDER [--out FOLDER]

FOLDER has a copy of each collection of imports.toml, at the commit that it names, as FOLDER/OWNER+NAME. Imports every description with at
least two movable joints. Compares the mass of each body with that of the description: of URDF with the sum of its masses, of MJCF with
what MuJoCo reads. Writes imports.csv and README.md into the folder of --out, which is docs/shown/imports. Needs Python 3.11, and, for the
masses of MJCF, `pip install mujoco`. Takes some minutes. Status: 0, or 2 on an error.
"""

import argparse
import collections
import contextlib
import hashlib
import math
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import textwrap
import xml.etree.ElementTree as xml

try:
    import tomllib
except ModuleNotFoundError:
    sys.exit("imports: needs Python 3.11 or newer")

from estimated import PROGRAM, ROOT, fail, interval, write

COLUMNS = ["population", "from", "file", "joints", "usable", "seconds", "memory_mib", "mass_kg", "mass_described_kg", "joints_read",
           "refused"]
# Joints of URDF that move.
MOVABLE = {"revolute", "continuous", "prismatic", "planar", "floating", "spherical", "universal", "ball"}
# Sections of MJCF whose elements `joint` are none of a body.
NO_JOINTS = "default|actuator|sensor|equality|tendon|contact|deformable|keyframe|custom"
# kg/m³, of a part that names none.
WATER = 1000.0
# Masses that differ by less agree.
AGREES = 0.01
SECONDS, MEMORY = 1.0, 500


def main():
    parser = argparse.ArgumentParser(description="Count how many public robots are imported.")
    parser.add_argument("folder", type=pathlib.Path, help="folder of the collections")
    parser.add_argument("--out", type=pathlib.Path, default=ROOT / "docs" / "shown" / "imports", help="folder to write to")
    arguments = parser.parse_args()
    arguments.folder = arguments.folder.resolve()
    design = tomllib.loads((ROOT / "reproduce" / "imports.toml").read_text())
    missing = [name for name in design["commits"] if not (arguments.folder / name.replace("/", "+")).is_dir()]
    if missing:
        fail(f"{arguments.folder / missing[0].replace('/', '+')}: is not there; clone {missing[0]} at commit {design['commits'][missing[0]]}")
    rows, known = [], set()
    for population in design["population"]:
        for name in population["from"]:
            place = arguments.folder / name.replace("/", "+")
            for file, joints in robots(place, population["kind"]):
                content = hashlib.sha256(file.read_bytes()).hexdigest()
                if (population["name"], content) in known:
                    continue
                known.add((population["name"], content))
                row = {"population": population["name"], "from": name, "file": str(file.relative_to(place)), "joints": joints}
                rows.append(row | imported(file))
    if not rows:
        fail(f"{arguments.folder}: has no descriptions")
    # Afterwards: what MuJoCo needs of memory would count as that of the imports, which begin as copies of this process.
    kinds = {population["name"]: population["kind"] for population in design["population"]}
    for row in rows:
        file = arguments.folder / row["from"].replace("/", "+") / row["file"]
        row["mass_described_kg"] = described(file, kinds[row["population"]], row.pop("root", None))
    arguments.out.mkdir(parents=True, exist_ok=True)
    write(arguments.out / "imports.csv", COLUMNS, [{column: row.get(column, "") for column in COLUMNS} for row in rows])
    (arguments.out / "README.md").write_text(page(rows, design))
    return 0


# ---- What is counted


def robots(folder, kind):
    """Descriptions with at least two movable joints, each with their number. What includes another of them is a scene, and not counted."""
    for file in sorted(folder.rglob("*")):
        if not file.is_file() or file.suffix.lower() not in (".urdf", ".xml"):
            continue
        text = uncommented(file)
        if kind == "urdf":
            joints = len(re.findall(rf"<joint\b[^>]*\btype\s*=\s*[\"'](?:{'|'.join(MOVABLE)})[\"']", text)) if "<robot" in text else 0
        elif re.search(r"<mujoco[\s>]", text) and "<worldbody" in text:
            joints = 0 if any(own(included) >= 2 for included in includes(file, text)) else own(file)
        else:
            continue
        if joints >= 2:
            yield file, joints


def own(file, depth=0):
    """Joints of a description of MJCF, with those of the files that it includes."""
    text = uncommented(file)
    if depth == 0 and not re.search(r"<mujoco[\s>]", text):
        return 0
    # The innermost first: defaults are nested.
    inner = rf"<({NO_JOINTS})\b(?:(?!<\1\b).)*?</\1>"
    bodies, found = text, 1
    while found:
        bodies, found = re.subn(inner, "", bodies, flags=re.S)
    count = len(re.findall(r"<joint\b(?![^>]*\btype\s*=\s*[\"']free)", bodies))
    return count + (sum(own(included, depth + 1) for included in includes(file, text)) if depth < 8 else 0)


def includes(file, text):
    found = [file.parent / name for name in re.findall(r"<include\b[^>]*\bfile\s*=\s*[\"']([^\"']+)", text)]
    return [one for one in found if one.is_file()]


def uncommented(file):
    return re.sub(r"<!--.*?-->", "", file.read_text(errors="replace"), flags=re.S)


# ---- What import makes of it


def imported(file):
    with tempfile.TemporaryDirectory() as name:
        out = pathlib.Path(name) / "body.toml"
        with open(out.with_suffix(".out"), "w+") as said, open(out.with_suffix(".err"), "w+") as wrong:
            process = subprocess.Popen([PROGRAM, "body", "import", file, "--out", out], stdout=said, stderr=wrong)
            _, status, used = os.wait4(process.pid, 0)
            said.seek(0), wrong.seek(0)
            said, wrong = said.read(), wrong.read().strip()
        row = {"usable": str(status == 0).lower(), "seconds": f"{used.ru_utime + used.ru_stime:.2f}", "memory_mib": used.ru_maxrss // 1024}
        if status:
            # Without the program and the file, which are in front.
            message = wrong.split("\n")[0].removeprefix(f"bodyschema: {file}: ")
            return row | {"refused": message}
        body = tomllib.loads(out.read_text())
    mass = sum(part.get("density", body.get("density", WATER)) * volume(part) for part in body["part"])
    notes = [line.removeprefix("note: ") for line in said.split("\n") if line.startswith("note: ")]
    read = sum(part.get("joint", "fixed") != "fixed" for part in body["part"])
    return row | {"mass_kg": f"{mass:.6g}", "joints_read": read, "notes": notes, "root": body["part"][0]["name"]}


def described(file, kind, root):
    """The mass of the description, kg, as text; nothing if it says none, or cannot be read."""
    if root is None:
        return ""
    try:
        mass = mass_of_urdf(file) if kind == "urdf" else mass_of_mjcf(file, root)
    except (xml.ParseError, ValueError, KeyError):
        return ""
    return f"{mass:.6g}" if mass else ""


def volume(part):
    """Of a part of a body, m³."""
    if part["shape"] == "box":
        return math.prod(part["size"])
    ball = 4 / 3 * math.pi * part["radius"] ** 3
    if part["shape"] == "sphere":
        return ball
    tube = math.pi * part["radius"] ** 2 * math.dist(part["from"], part["to"])
    return tube + (ball if part["shape"] == "capsule" else 0)


def mass_of_urdf(file):
    """The sum of the masses of all links, kg; none where nothing that is fixed together names a mass, but has a shape."""
    robot = xml.parse(file).getroot()
    together = {}  # what the link of a name is fixed to

    def first(name):
        while name in together:
            name = together[name]
        return name

    for joint in robot.findall("joint"):
        if joint.get("type") == "fixed":
            child, parent = (first(joint.find(end).get("link")) for end in ("child", "parent"))
            if child != parent:
                together[child] = parent
    masses, shaped = {}, set()
    for link in robot.findall("link"):
        mass, name = link.find("inertial/mass"), first(link.get("name"))
        masses[name] = masses.get(name, 0.0) + (float(mass.get("value")) if mass is not None else 0.0)
        if link.find("collision") is not None or link.find("visual") is not None:
            shaped.add(name)
    return None if any(masses[name] <= 0 for name in shaped) else sum(masses.values())


def mass_of_mjcf(file, root):
    """The mass of the tree that has a body of this name, kg; none where MuJoCo cannot read the file."""
    try:
        import mujoco
    except ModuleNotFoundError:
        return None
    # It writes a log of its warnings where it is.
    with tempfile.TemporaryDirectory() as folder, contextlib.chdir(folder):
        model = mujoco.MjModel.from_xml_path(str(file))
    at = model.body(root.split("/")[0]).id
    while model.body_parentid[at]:
        at = model.body_parentid[at]
    return float(model.body_subtreemass[at])


# ---- The page


def page(rows, design):
    usable = [row for row in rows if row["usable"] == "true"]
    still = sum(row["joints_read"] == 0 for row in usable)
    weighed = [row for row in usable if row["mass_described_kg"]]
    off = [row for row in weighed if deviation(row) >= AGREES]
    slow = [row for row in rows if float(row["seconds"]) >= SECONDS]
    large = [row for row in rows if int(row["memory_mib"]) > MEMORY]
    lines = [
        "# Which robots are imported",
        "",
        "How many public descriptions of robots does `bodyschema body import` read? Made by `reproduce/imports.py`.",
        "[imports.toml](../../../reproduce/imports.toml) has the sources. Counted is every description with at least two movable joints; those",
        "with the same content count once, and a scene that includes a counted robot does not count. All: [imports.csv](imports.csv).",
        "",
        "| collection | imported | with joints | goal |",
        "|---|---|---|---|",
    ]
    for population in design["population"]:
        own = [row for row in rows if row["population"] == population["name"]]
        goal = f"{100 * population['goal']:.0f} %" if "goal" in population else "–"
        groups = {population["name"]: [[row] for row in own]}
        if population.get("folders"):
            of = {}
            for row in own:
                of.setdefault(row["file"].split("/")[0], []).append(row)
            groups[f"{population['name']}, by robot"] = list(of.values())
        for name, robots_of in groups.items():
            read = sum(any(row["usable"] == "true" for row in robot) for robot in robots_of)
            joined = sum(any(row.get("joints_read", 0) > 0 for row in robot) for robot in robots_of)
            lines.append(f"| {name} | {interval(read, len(robots_of))} | {interval(joined, len(robots_of))} | {goal} |")
    lines += [
        "",
        paragraph("In brackets: 95 % intervals (Wilson). *Imported*: a body is written, and notes say what was changed for it. *With joints*: it has at "
                  f"least one. {still} have none: all of theirs slide and are held, turn about the world, or lead to links without a shape. "
                  "*By robot*: a robot counts if one of its descriptions does."),
        "",
        "## Masses",
        "",
        paragraph(f"The mass of the body is that of the description to within {100 * AGREES:.0f} % in {len(weighed) - len(off):,} of "
                  f"{len(weighed):,} robots. The mass of a URDF is the sum over its links; it is compared where each link with a shape names one. "
                  "The mass of an MJCF is what MuJoCo reads, of the tree that is imported."),
    ]
    if off:
        why = {(one["from"], one["file"]): one["why"] for one in design["off"]}
        lines += ["", "| robot | mass, kg | described, kg | why |", "|---|---|---|---|",
                  *(f"| {row['from']}: {row['file']} | {row['mass_kg']} | {row['mass_described_kg']} | {why.get((row['from'], row['file']), '–')} |" for row in off)]
    most = max(rows, key=lambda row: float(row["seconds"]))
    widest = max(rows, key=lambda row: int(row["memory_mib"]))
    lines += [
        "",
        "## Cost",
        "",
        paragraph(f"{len(rows) - len(slow):,} of {len(rows):,} imports take less than {SECONDS:.0f} s of the processor; the longest takes "
                  f"{most['seconds']} s (`{most['file']}`). {len(rows) - len(large):,} need less than {MEMORY} MiB; the most is "
                  f"{widest['memory_mib']} MiB (`{widest['file']}`)."),
        "",
        "## What is refused",
        "",
        "| collection | robot | why |",
        "|---|---|---|",
        *(f"| {row['population']} | {row['from']}: {row['file']} | {row['refused'].replace('|', '/')} |" for row in rows if row["usable"] == "false"),
        "",
        "## What is changed",
        "",
        "A robot that is imported in another way than it is described says so in notes. Most frequent are these, with the number of robots:",
        "",
        "| note | robots |",
        "|---|---|",
        *(f"| {note} | {count:,} |" for note, count in kinds_of_notes(usable).most_common(15)),
    ]
    return "\n".join(lines) + "\n"


def paragraph(text):
    return textwrap.fill(text, 140, break_long_words=False, break_on_hyphens=False)


def deviation(row):
    return abs(float(row["mass_kg"]) / float(row["mass_described_kg"]) - 1)


def kinds_of_notes(rows):
    """How many robots have each kind of note: its text without names and numbers."""
    counts = collections.Counter()
    for row in rows:
        kinds = {re.sub(r"\s*\(\d+\):.*$|`[^`]*`|\b\d[\d.,]*\b", "…", note) for note in row.get("notes", [])}
        counts.update(re.sub(r"(link|body) …: ", "", kind) for kind in kinds)
    return counts


if __name__ == "__main__":
    sys.exit(main())
