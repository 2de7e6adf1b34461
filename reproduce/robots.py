#!/usr/bin/env python3
"""Estimate the parts of public robots: reproduce/robots.py [--use USE] [--movement NAME] [--files FOLDER] [--out FOLDER] [--keep FOLDER]

Downloads the files that robots-files.csv names into FOLDER of --files, where they are not there yet, and checks each. Imports each
robot of robots.toml as a body, moves it, and asks `bodyschema estimate` how what it finds compares with the truth. Writes robots.csv and
README.md into the folder of --out, which is docs/shown/robots. Rows of the same revision are kept, so a run that was stopped continues.
With --use "held out" or calibration, only robots of that use are counted, and with --movement only one movement; other rows stay as they are.
With --keep, bodies and results stay in a folder for each row, without what was felt over time. Needs Python 3.11, and no packages. Takes
about 45 minutes for each movement on two busy cores. Status: 0, or 2 on an error.
"""

import argparse
import array
import collections
import json
import math
import pathlib
import shutil
import sys
import tempfile

try:
    import tomllib
except ModuleNotFoundError:
    sys.exit("robots: needs Python 3.11 or newer")

from estimated import ROOT, TRUTH, USES, downloaded, estimated, fail, read, resumed, revision, revisions, run, trees_right, tried

COLUMNS = ["robot", "kind", "use", "movement", "seed", "sensors", "fit", *TRUTH, "resolved", "unfelt",
           "either", "astray", "astray_either", "refused", "revision"]
RAW = "https://raw.githubusercontent.com"


def main():
    parser = argparse.ArgumentParser(description="Estimate the parts of public robots.")
    design = tomllib.loads((ROOT / "reproduce" / "robots.toml").read_text())
    parser.add_argument("--use", choices=USES, help="count only the robots of this use")
    robots, movements = ({one["name"]: one for one in design[key]} for key in ("robot", "movement"))
    parser.add_argument("--movement", choices=list(movements), help="count only this movement")
    parser.add_argument("--files", type=pathlib.Path, default=ROOT / "results" / "robots", help="folder of the descriptions")
    parser.add_argument("--out", type=pathlib.Path, default=ROOT / "docs" / "shown" / "robots", help="folder to write to")
    parser.add_argument("--keep", type=pathlib.Path, help="folder to keep bodies and results in")
    arguments = parser.parse_args()
    design["files"] = read(ROOT / "reproduce" / "robots-files.csv")
    for robot in design["robot"]:
        for one in design["files"]:
            if one["robot"] == robot["name"]:
                commit = design["commits"][robot["from"]]
                url = f"{RAW}/{robot['from']}/{commit}/{one['path']}"
                downloaded(folder_of(robot, arguments.files) / one["path"], url, one["sha256"])
    arguments.out.mkdir(parents=True, exist_ok=True)
    table, current = arguments.out / "robots.csv", revision()
    is_asked = lambda value, asked: value == (asked or value)
    counts = lambda row: is_asked(row["use"], arguments.use) and is_asked(row["movement"], arguments.movement)
    stays = lambda row: row["revision"] == current or not counts(row)
    place = lambda row: (list(movements).index(row["movement"]), list(robots).index(row["robot"]))
    jobs = [{"robot": robot, "kind": one["kind"], "use": one["use"], "movement": movement, "seed": design["seed"], "revision": current}
            for movement in movements for robot, one in robots.items()]

    def measured(**job):
        robot, name = robots[job["robot"]], f"{job['robot']}, {job['movement']}"
        file = folder_of(robot, arguments.files) / robot["file"]
        return [{**job, **found(file, movements[job["movement"]], design, arguments.keep and arguments.keep / name)}]

    rows = resumed(table, COLUMNS, list(filter(counts, jobs)), measured, stays, place)
    (arguments.out / "README.md").write_text(page(rows, design))
    return 0


def folder_of(robot, files):
    return files / robot["from"].replace("/", "+")


def found(file, movement, design, kept):
    """What `estimate` finds in how a robot feels a movement, compared with the truth; or why it is refused. What is small is kept in a
    folder, if there is one."""
    with tempfile.TemporaryDirectory() as name:
        row = found_in(pathlib.Path(name), file, movement, design)
        if kept:
            large = shutil.ignore_patterns("tactile.npy", "poses.npy", "report.html")
            shutil.copytree(name, kept, ignore=large, dirs_exist_ok=True)
    return row


def found_in(folder, file, movement, design):
    """The same, in a folder."""
    body, settings, felt = folder / "body.toml", folder / "settings.toml", folder / "felt"
    imported = tried("body", "import", file, "--sensors-per-part", design["sensors_per_part"], "--out", body)
    if imported.returncode == 2:
        return {"refused": imported.stderr.strip().splitlines()[-1].split(f"{file}: ")[-1]}
    if imported.returncode:
        fail(f"the import of {file} failed with status {imported.returncode}: {imported.stderr.strip()}")
    lines = [f"{table}.{key} = {json.dumps(value)}" for table, keys in movement["settings"].items() for key, value in keys.items()]
    settings.write_text("\n".join(lines) + "\n")
    words = ["--settings", settings, "--duration", design["duration"], "--seed", design["seed"], "--out", felt]
    said = run("simulate", "--body", body, *words)
    summary, truth = estimated(felt, folder / "found", design["seed"])
    return {
        "sensors": summary["sensors"] - summary["dropped"],
        "fit": summary["fit"],
        **truth,
        "resolved": str("the time step resolves" in said.stdout + said.stderr).lower(),
        **reasons(body, felt, folder / "found", design["least_felt"]),
    }


def reasons(body, felt, found, least):
    """What touch cannot tell, and which sensors are astray."""
    skin, wrong = Skin(body, felt), astray(felt, found)
    either = skin.either(least)
    return {
        "unfelt": "; ".join(skin.unfelt(least)),
        "either": len(either),
        "astray": len(wrong),
        "astray_either": len(either.intersection(wrong)),
    }


class Skin:
    """Where the sensors of a robot lie in the rest pose, and about which axes its parts turn."""

    def __init__(self, body, felt):
        self.links = tomllib.loads(body.read_text())["part"]
        at = {link["name"]: index for index, link in enumerate(self.links)}
        self.parent = [at.get(link.get("parent")) for link in self.links]
        self.rigid = []  # the first link of those that are fixed to each other
        for index, link in enumerate(self.links):
            self.rigid.append(self.rigid[self.parent[index]] if link.get("joint") == "fixed" else index)
        poses, self.sensors, self.on = rest(felt / "poses.npy", len(self.links)), {}, {}
        for row in read(felt / "sensors.csv"):
            solid = int(row["solid"])
            there, turn = poses[solid][:3], poses[solid][3:]
            point = [a + b for a, b in zip(there, turned(turn, [float(row[f"{axis}_m"]) for axis in "xyz"]))]
            normal = turned(turn, [float(row[f"normal_{axis}"]) for axis in "xyz"])
            self.sensors[row["sensor"]] = point, normal
            self.on.setdefault(self.rigid[solid], []).append(row["sensor"])

    def joints(self):
        """Every joint between two parts with sensors: both, and its axes. A part without sensors belongs to the joint."""
        for link in self.on:
            axes, up = [], link
            while up:
                own = [[1, 0, 0], [0, 1, 0], [0, 0, 1]] if self.links[up]["joint"] == "ball" else self.links[up].get("axes", [])
                axes += [(self.links[up]["anchor"], axis) for axis in own]
                up = self.rigid[self.parent[up]]
                if up in self.on:
                    yield link, up, axes
                    break

    def speeds(self, part, anchor, axis):
        """How fast each sensor of a part moves as the part turns about an axis: along its normal, and in all."""
        for sensor in self.on[part]:
            point, normal = self.sensors[sensor]
            speed = cross(axis, [a - b for a, b in zip(point, anchor)])
            yield sum(a * b for a, b in zip(speed, normal)), math.hypot(*speed)

    def share(self, part, anchor, axis):
        """The share along the normals, as root mean squares."""
        along, whole = (math.hypot(*speeds) for speeds in zip(*self.speeds(part, anchor, axis)))
        return along / whole if whole else 0

    def unfelt(self, least):
        """The joints that touch cannot tell, by the part that they carry: of no axis feel both parts enough. If one feels nothing of it,
        both move alike for touch."""
        return [self.links[part]["name"] for part, up, axes in self.joints()
                if all(min(self.share(part, *axis), self.share(up, *axis)) < least for axis in axes)]

    def either(self, least):
        """The sensors that would feel the same on a neighbour of their part, since they feel too little of the joint between them."""
        found = set()
        for *parts, axes in self.joints():
            for part in parts:
                felt = [False] * len(self.on[part])
                for axis in axes:
                    speeds = list(self.speeds(part, *axis))
                    middle = math.sqrt(sum(whole**2 for _, whole in speeds) / len(speeds))
                    felt = [one or abs(along) >= least * middle > 0 for one, (along, _) in zip(felt, speeds)]
                found.update(sensor for sensor, one in zip(self.on[part], felt) if not one)
        return found


def astray(felt, found):
    """The sensors that are not on the found part that stands for their true part: the one with most of its sensors, if most of that
    part's sensors are of it."""
    true = {row["sensor"]: row["part"] for row in read(felt / "labels.csv")}
    own = {row["sensor"]: row["part"] for row in read(found / "parts.csv")}
    both = collections.Counter((true[sensor], part) for sensor, part in own.items())
    most = {}
    for (part, other), count in both.most_common():
        most.setdefault(other, (part, count))
    stands = {}
    for other, (part, count) in most.items():
        stands[part] = max(stands.get(part, (0, "")), (count, other))
    return [sensor for sensor, part in own.items() if stands.get(true[sensor], (0, None))[1] != part]


def rest(poses, solids):
    """Row 0 of poses.npy: seven numbers for each solid."""
    with open(poses, "rb") as file:
        file.seek(8)
        file.seek(int.from_bytes(file.read(2), "little"), 1)
        numbers = array.array("f")
        numbers.fromfile(file, 7 * solids)
    return [numbers[7 * solid:7 * solid + 7] for solid in range(solids)]


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def turned(quaternion, vector):
    w, turn = quaternion[0], quaternion[1:]
    half = [2 * a for a in cross(turn, vector)]
    return [a + w * b + c for a, b, c in zip(vector, half, cross(turn, half))]


def page(rows, design):
    """The page: bad results first."""
    first, *others = [movement["name"] for movement in design["movement"]]
    others = [movement for movement in others if any(row["movement"] == movement for row in rows)]
    by_name = {robot["name"]: robot for robot in design["robot"]}
    of = lambda name, movement: next((row for row in rows if (row["robot"], row["movement"]) == (name, movement)), None)
    lines = [
        "# Public robots",
        "",
        "How often does `bodyschema estimate` find the parts and the tree of a robot as others describe it? Made by",
        f"`reproduce/robots.py` with revision {revisions(rows)} and seed {rows[0]['seed']}. [robots.toml](../../../reproduce/robots.toml)",
        "has the sources, the rule that chose them before anything was run, and what each was used for.",
        "",
        f"The skin is virtual, without noise: {design['sensors_per_part']} sensors on each body or link. A robot floats in the fluid, with",
        f"its joints as `body import` makes them. It moves for {design['duration']:,} s, which are {10 * design['duration']:,} samples. Its",
        "motors and their limits are not those of the description. A tree is right if its parts and joints are.",
        "",
        f"    bodyschema body import robot.urdf --sensors-per-part {design['sensors_per_part']} --out robot.toml",
        f"    bodyschema simulate --body robot.toml --settings movement.toml --duration {design['duration']} --seed {design['seed']} --out felt",
        f"    bodyschema estimate felt/tactile.npy --labels felt/labels.csv --tree felt/tree.csv --seed {design['seed']} --out found --force",
        "",
        "`movement.toml` has the settings of a movement in robots.toml.",
        "",
        "## How often is it right?",
        "",
        "Robots whose import is refused are not counted, except where they count *as wrong*. *Can be told* are robots without a joint that touch",
        "cannot tell ([below](#what-touch-cannot-tell)). The method was developed on those of *calibration*, and on none that is *held out*.",
        "In brackets: 95 % intervals (Wilson). Kinds and collections were chosen, so these are no random robots.",
        "",
        "| movement | trees right, held out | held out, can be told | held out, refused ones as wrong | calibration |",
        "|---|---|---|---|---|",
    ]
    for movement in (first, *others):
        own = [row for row in rows if row["movement"] == movement]
        if len(own) == len(design["robot"]):
            held, seen = ([row for row in own if row["use"] == use] for use in USES)
            ran = [row for row in held if not row["refused"]]
            groups = [ran, [row for row in ran if not row["unfelt"]], held, [row for row in seen if not row["refused"]]]
            lines.append("| " + " | ".join([movement, *map(trees_right, groups)]) + " |")
    lines += [
        "",
        f"With {first}, by kind:",
        "",
        "| kind | trees right, held out | calibration |",
        "|---|---|---|",
    ]
    for kind in dict.fromkeys(robot["kind"] for robot in design["robot"]):
        own = [row for row in rows if (row["kind"], row["movement"]) == (kind, first) and not row["refused"]]
        lines.append("| " + " | ".join([kind, *(trees_right([row for row in own if row["use"] == use]) for use in USES)]) + " |")
    lines += [
        "",
        "## Robot by robot",
        "",
        f"Wrong trees with {first} come first, by the adjusted Rand index. M is the number of sensors. A good fit does not mean a right tree."
        + (" A dash was not run." if others else ""),
        "",
        f"| {' | '.join(['robot', 'kind', 'use', 'M', 'fit', 'true parts', 'found', 'adjusted Rand index', 'joints right', f'tree, {first}', *others])} |",
        "|" + "---|" * (10 + len(others)),
    ]
    done = [row for row in rows if row["movement"] == first and not row["refused"]]
    for row in sorted(done, key=lambda row: (row["tree_right"], float(row["ari"]))):
        cells = [row["robot"], row["kind"], row["use"], f"{int(row['sensors']):,}", row["fit"], row["true_parts"], row["parts"], row["ari"],
                 f"{row['joints_right']} of {row['true_joints']}", right_or_wrong(row), *(tree(of(row["robot"], movement)) for movement in others)]
        lines.append("| " + " | ".join(cells) + " |")
    unresolved = [f"{row['robot']} ({row['movement']})" for row in rows if row["resolved"] == "false"]
    if unresolved:
        lines += ["", "The time step does not resolve these movements: " + ", ".join(unresolved) + "."]
    wrong = [row for row in sorted(done, key=lambda row: float(row["ari"])) if row["tree_right"] == "false"]
    only = sum(row["joints_right"] == row["true_joints"] and int(row["parts"]) > int(row["true_parts"]) for row in wrong)
    faults = collections.Counter(by_name[row["robot"]].get("fault", "?") for row in wrong)
    lines += [
        "",
        "## What went wrong",
        "",
        f"**The reasons below describe revision {design['looked_into']}.** The tables above are newer, and their counts can differ. Those who changed the",
        "method after that revision may have read these reasons; no number of the method was chosen on robots that are held out.",
        "",
        f"This is of {first}. Of {len(wrong)} wrong trees, {faults['method']} are the fault of the method alone. In {faults['both']}, the",
        f"method fails, and touch cannot tell the truth, either. In {faults['touch']}, only touch cannot."
        + (f" {faults['?']} were not looked into." if faults["?"] else ""),
        f"In {only} of the {len(wrong)}, all joints are right, and the only fault is that there are too many parts.",
        "",
        "A sensor is *astray* if it is not on the found part that stands for its true part. It may feel nothing of a hinge: its normal is along",
        "the axis, or meets it. Then it *feels the same* on the next part, and touch cannot tell where it belongs. A tree can be right all",
        "the same, since most sensors of a part count. Most sensors that are astray are of this kind. The most common fault is that they",
        "make a part of their own, though they fit their true part. Another one is that hinges whose axes meet are joined in the wrong order",
        "(alex): where they meet, three parts move alike.",
        "",
    ]
    for row in wrong:
        robot = by_name[row["robot"]]
        fault = {"method": "method", "both": "method and touch", "touch": "touch"}.get(robot.get("fault"), "not looked into")
        lines.append(
            f"- **{row['robot']}** ({fault}). Astray: {int(row['astray']):,} of {int(row['sensors']):,} sensors;"
            f" {int(row['astray_either']):,} of them feel the same on a neighbour. {robot.get('why', '')}".rstrip()
        )
    lines += ["", "## What is refused", ""]
    lines += [f"- **{row['robot']}** ({row['kind']}, {row['use']}): `` {row['refused']} ``" for row in rows
              if row["movement"] == first and row["refused"]]
    lines += [
        "",
        "## What touch cannot tell",
        "",
        "A sensor feels the movement along its normal. A wheel that turns about its own axis moves all its sensors along its surface, so",
        "it feels the same as if it did not turn. Then two parts and one explain what is felt equally well; the truth may still be found,",
        "by chance. We take how fast all sensors of a part move about the axis, and the share of it along the normals (root mean square).",
        f"If that of one of the two parts is below {design['least_felt']}, the joint counts as one that touch cannot tell. A sensor counts as",
        "one that feels the same in the same way. robots.toml had this limit before anything was run. These are the parts:",
        "",
    ]
    lines += [f"- {row['robot']}: {row['unfelt']}" for row in done if row["unfelt"]] or ["No robot has such a joint."]
    return "\n".join(lines) + "\n"


def right_or_wrong(row):
    return "right" if row["tree_right"] == "true" else "wrong"


def tree(row):
    """Whether a tree is right, with the adjusted Rand index of the parts if it is not: in a table that has it of another movement."""
    if row is None:
        return "–"
    return "right" if row["tree_right"] == "true" else f"wrong ({row['ari']})"


if __name__ == "__main__":
    sys.exit(main())
