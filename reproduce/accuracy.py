"""How often `estimate` is right, as README.md, docs/own-data.md and docs/estimate.md show it: tables from docs/shown/bodies,
docs/shown/rhythmic, docs/shown/recordings, docs/shown/robots and docs/shown/boxes. Used by docs.py."""

import json
import tomllib

from estimated import ROOT, USES, interval, is_alarm, read, revisions, trees_right, wilson

SHOWN = ROOT / "docs" / "shown"
# s: one sample, and how long a joint has one target or is locked (bodies.toml).
INTERVAL, EPOCH = 0.1, 5.0
# Bootstrap support, in percent, from one to below the other.
BINS = {"50 to 80 %": (0.5, 0.8), "80 to 95 %": (0.8, 0.95), "95 to 99 %": (0.95, 0.99), "100 %": (1.0, 2.0)}


def tables():
    """By file and name of its marks: the text between them."""
    return {**summary(), **goals(), **of_alarm(), **of_bodies(), **of_rhythmic_bodies(), **of_recordings(), **of_robots()}


def summary():
    """What was held out, a row for each kind of data."""
    bodies = read(SHOWN / "bodies" / "recordings.csv")
    recordings, robots, boxes = of_use("held out", shown("recordings")), of_use("held out", moved_robots()), shown("boxes")
    counts = [int(row["samples"]) for row in recordings]
    of_study, of_gaits = (run_of(folder)["revision"][:7] for folder in ("bodies", "rhythmic"))
    rows = [
        ("[15 bodies](shown/bodies/README.md), random movement", "100,000", of(bodies, 100_000, 0.0), of_study),
        ("the same, noise of 10 % of the root mean square", "100,000", of(bodies, 100_000, 0.1), of_study),
        ("the same bodies swim in [gaits that change](estimate.md#rhythmic-movement)", "10,000", swum("changing-gaits"), of_gaits),
        ("[movements](#recorded-movements) recorded by others", f"{min(counts)} to {max(counts):,}", recordings, revisions(recordings)),
        ("[robots of boxes](shown/boxes/README.md), random movement", "20,000", boxes, revisions(boxes)),
        ("[robots as published](shown/robots/README.md), random movement", "100,000", robots, revisions(robots)),
    ]
    lines = ["| data | samples | tree right | revision |", "|---|---|---|---|"]
    for name, samples, own, revision in rows:
        lines.append(f"| {name} | {samples} | {trees_right(own)} | {revision} |")
    return {("docs/own-data.md", "summary"): lines}


def goals():
    """What was aimed at, what was reached on held-out data, and what fails."""
    bodies, edges = (read(SHOWN / "bodies" / f"{name}.csv") for name in ("recordings", "edges"))
    gaits = swum("changing-gaits")
    moved, robots, alarms = of_use("held out", shown("recordings")), of_use("held out", moved_robots()), shown("alarm")
    index = sum(float(row["ari"]) for row in moved) / len(moved)
    share = lambda rows: sum(row["right"] == "true" for row in rows) / len(rows)
    (samples, _, p), worst = min(certain_edges(bodies, edges).items(), key=lambda group: share(group[1]))
    short = lambda p: [row for row in of(bodies, 1000, 0.0) if float(row["coordination"]) == p]
    def told(truth):
        own = [row for row in alarms if row["truth"] == truth]
        return interval(sum(map(is_alarm, own)), len(own))

    tree = lambda rows: rate(rows, "tree_right", f"; n = {len(rows):,}")
    trunk = "joints at the trunk, above all in short recordings: an arm is joined to the other one. A skin that feels how the trunk turns would tell"
    rows = [
        ("recorded movements, adjusted Rand index", "0.95 on average", f"{index:.3f} (n = {len(moved)})", "parts that hardly move: longer recordings"),
        ("recorded movements, trees", "80 %", tree(moved), trunk),
        ("gaits that change, trees", "95 %", tree(gaits), "surplus parts, and joints of parts that keep step: joints must also move by themselves"),
        ("noise of a tenth, 100,000 samples, trees", "90 %", tree(of(bodies, 100_000, 0.1)), f"{wrong_parts(of(bodies, 100_000, 0.1))}. {hardest(of(bodies, 100_000, 0.1))}"),
        ("1,000 samples, p = 0, trees", "75 %", tree(short(0.0)), "100 s are too short for the joints: with 10,000 samples nearly all trees are right"),
        ("1,000 samples, p = 0.5, trees", "65 %", tree(short(0.5)), "the same"),
        ("does not fit, and is recognised", "95 %", told("does not fit"), "nothing here; an earlier count missed strokes over the body `arm`"),
        ("fits, and is refused", "2 % at most", told("fits"), "nothing; too few recordings to show 2 %"),
        (f"joints with a support of 95 % or more, the worst kind of recording ({samples:,} samples, p = {float(p):g})", "95 %",
         rate(worst, "right", f"; n = {len(worst):,}"), "wrong parts, which support does not count: `--repeats` does"),
        ("robots as published, trees", "80 %", tree(robots), f"{wrong_parts(robots)}. Some have joints that touch cannot tell: [each robot](shown/robots/README.md)"),
    ]
    lines = ["| held-out data | aimed at | reached | what fails, and what would be needed |", "|---|---|---|---|"]
    return {("docs/estimate.md", "goals"): lines + [f"| {' | '.join(row)} |" for row in rows]}


def wrong_parts(rows):
    """How many wrong trees have too many parts, and how many too few."""
    wrong = [int(row["parts"]) - int(row["true_parts"]) for row in rows if row["tree_right"] == "false"]
    return f"of {len(wrong)} wrong trees, {sum(more > 0 for more in wrong)} have too many parts, {sum(more < 0 for more in wrong)} too few, and {sum(more == 0 for more in wrong)} the right number"


def hardest(rows):
    """The two bodies whose trees are right least often."""
    bodies = {row["body"]: [] for row in rows}
    for row in rows:
        bodies[row["body"]].append(row["tree_right"] == "true")
    worst = sorted(bodies, key=lambda body: sum(bodies[body]) / len(bodies[body]))[:2]
    return " and ".join(f"`{body}` is right in {sum(bodies[body])} of {len(bodies[body])}" for body in worst)


def shown(name):
    """The rows of a table in docs/shown."""
    return read(SHOWN / name / f"{name}.csv")


def swum(kind):
    """The rhythmic recordings of a kind."""
    return [row for row in read(SHOWN / "rhythmic" / "recordings.csv") if row["kind"] == kind]


def of_use(use, rows):
    return [row for row in rows if row["use"] == use]


def moved_robots():
    """Robots that were not refused, in the movement that is reported."""
    return [row for row in shown("robots") if row["movement"] == "p = 0.5" and not row["refused"]]


def run_of(folder):
    """Seed and revision of a study of bodies in docs/shown."""
    return json.loads((SHOWN / folder / "run.json").read_text())


def of_bodies():
    recordings = read(SHOWN / "bodies" / "recordings.csv")
    edges = read(SHOWN / "bodies" / "edges.csv")
    source = made("bodies", "reproduce/bodies.sh")
    return {
        ("README.md", "accuracy"): [*shortest(recordings), "", f"[Held out](docs/estimate.md#accuracy): {source[0].lower()}{source[1:]}"],
        ("docs/own-data.md", "lengths"): [*by_length(recordings), "", source],
        ("docs/own-data.md", "certain"): certain(recordings, edges),
        ("docs/own-data.md", "failures"): failures(recordings),
        ("docs/estimate.md", "long"): long_and_exact(recordings),
        ("docs/estimate.md", "accuracy"): [*pooled(recordings), "", source, "", wrong_trees(recordings)],
        ("docs/estimate.md", "support"): support(recordings, edges),
        ("docs/estimate.md", "sure"): sure(recordings, edges),
    }


def long_and_exact(recordings):
    rows = of(recordings, 100_000, 0.0)
    return ["From 10,000 s of random movement without noise, this recovers the tree in",
            f"{rate(rows, 'tree_right', f'; n = {len(rows)}')} of the simulations of [15 bodies](shown/bodies/README.md)."]


def wrong_trees(recordings):
    """What is wrong in long exact recordings."""
    wrong = [row for row in of(recordings, 100_000, 0.0) if row["tree_right"] == "false"]
    parts = sum(row["parts_right"] == "true" for row in wrong)
    return f"At T = 100,000 without noise, {parts} of {len(wrong)} wrong trees have the right parts."


def failures(recordings):
    """Recordings with noise, and those in which joints seldom move."""
    seldom = [row for row in of(recordings, 1000, 0.0) if float(row["coordination"]) == 0.9]
    few = sum(int(row["parts"]) < int(row["true_parts"]) for row in seldom)
    right, good = sum(row["tree_right"] == "true" for row in seldom), sum(row["fit"] == "good" for row in seldom)
    return [
        "- **Noise** costs trees, also in long recordings: the last row of the [table of accuracy](estimate.md#accuracy). With noise of 10 %,",
        f"  the trees of two bodies are wrong most often: {hardest(of(recordings, 100_000, 0.1))}.",
        "- **Joints that seldom move.** Parts that never move against each other come out as one, and nothing in the recording shows it. In the",
        f"  study of 15 bodies, 1,000 samples at p = 0.9 are two targets of each joint. Of {len(seldom)} such recordings, {few} have too few parts and",
        f"  {right} have the right tree, but the fit is good in {good}. Move every joint often before you trust a good fit.",
    ]


def of_alarm():
    rows = shown("alarm")
    told = {truth: [row for row in rows if row["truth"] == truth] for truth in ("fits", "does not fit")}
    alarms = {truth: interval(sum(map(is_alarm, own)), len(own)) for truth, own in told.items()}
    doubtful = sum(row["fit"] == "doubtful" for row in told["fits"])
    return {("docs/own-data.md", "alarm"): [
        f"- **How often is a wrong fit noticed?** [Counted](shown/alarm/README.md) on {len({row['body'] for row in rows})} random robots that had not been drawn",
        f"  before (revision {revisions(rows)}). Of recordings that do not fit, {alarms['does not fit']} were recognised. Of those that fit,",
        f"  {alarms['fits']} were refused, and {doubtful} were called doubtful. The limits of 80 and 90 % were chosen on other recordings",
        "  ([estimate.md](estimate.md#limits)). In an earlier count on six bundled bodies (revision c31b6e1), 2 of 48 were missed: strokes over",
        "  `arm`, and a loop of `snake`, which is recognised since.",
    ]}


def of_rhythmic_bodies():
    source = made("rhythmic", "bodyschema bodies --design reproduce/rhythmic-bodies.toml --out rhythmic")
    lines = ["| movement | n | parts right | tree right | tree right, true parts given |", "|---|---|---|---|---|"]
    for name, kind in [("one gait", "one-gait"), ("gaits that change", "changing-gaits")]:
        own = swum(kind)
        lines.append(f"| {' | '.join([name, str(len(own)), *rates(own)])} |")
    wrong = [row for row in swum("changing-gaits") if row["tree_right"] != "true"]
    own = sum(row["parts_right"] == "true" for row in wrong)
    told = f"Of the {len(wrong)} wrong trees in gaits that change, {own} have the right parts."
    return {("docs/estimate.md", "rhythmic"): [*lines, "", f"{told} {source}"]}


def made(folder, command):
    """Seed, command and revision of a study of bodies in docs/shown."""
    facts = run_of(folder)
    return f"Seed {facts['seed']}; `{command}` of revision {facts['revision'][:7]}."


def of_recordings():
    moved, recordings = shown("recordings"), design("recordings")["recording"]
    held_out = of_use("held out", moved)
    counts, seed = [int(row["samples"]) for row in held_out], design("recordings")["seed"]
    failed = [one["name"] for one in recordings if "held_out_until" in one]
    further = {one["name"] for one in recordings if one.get("further")}
    both = held_out + [row for row in moved if row["recording"] in failed]
    right = sum(row["tree_right"] == "true" for row in both)
    more = f"; with {len(failed)} that failed and was taken out, {right} of {len(both)}" if failed else ""
    found = [
        f"Held-out [recorded movements](docs/own-data.md#recorded-movements), {min(counts)} to {max(counts):,} samples: trees right in",
        f"{trees_right(held_out)}{more}. Seed {seed}; `reproduce/recordings.py` of revision {revisions(held_out)}.",
    ]
    return {("README.md", "recorded"): found, ("docs/own-data.md", "recorded"): recorded(moved, further)}


def design(name):
    """A design of this folder."""
    return tomllib.loads((ROOT / "reproduce" / f"{name}.toml").read_text())


def of_robots():
    ran, boxes = moved_robots(), shown("boxes")
    held_out, seen = (of_use(use, ran) for use in USES)
    counted = sum(row["parts"] == row["true_parts"] for row in boxes)
    made_by = lambda revision, script: f"revision {revision}; `reproduce/{script}`"
    wrong = [row for row in ran if row["tree_right"] != "true"]
    surplus = sum(row["joints_right"] == row["true_joints"] and int(row["parts"]) > int(row["true_parts"]) for row in wrong)
    good = [row for row in held_out if row["fit"] == "good"]
    lines = [
        f"- **Public robots.** At p = 0.5 and 100,000 samples, trees of held-out robots were right in {trees_right(held_out)}. Of those",
        f"  that the method was developed on, they were in {trees_right(seen)}. **A good fit does not mean a right tree:** of the held-out",
        f"  robots whose fit is good by the limits of that revision, they were in {trees_right(good)}. Trees count here also where the fit is not good (`--force`). Of all",
        f"  {len(ran)}, {len(wrong)} trees are wrong; in {surplus} of these all joints are right, and some part is found as several.",
        f"  [Which ones and why](shown/robots/README.md): seed {ran[0]['seed']}; {made_by(revisions(ran), 'robots.py')}.",
        f"- **Robots of boxes.** At p = 0.5 and 20,000 samples, the tree was right for {trees_right(boxes)}, which were drawn at random.",
        f"  The number of parts was right for {interval(counted, len(boxes))} ([page](shown/boxes/README.md)). Sides along a hinge have the same",
        "  velocity along it on both of its parts, and can be taken for one part. Parts whose hinges are parallel can be taken for joined.",
        f"  Seeds {boxes[0]['body']} to {boxes[-1]['body']}; {made_by(revisions(boxes), 'boxes.py')}.",
    ]
    return {
        ("README.md", "robots"): [
            f"Held-out [robots](docs/own-data.md#known-failures), 100,000 samples: trees right in {trees_right(held_out)}.",
            f"Seed {ran[0]['seed']}; `reproduce/robots.py` of revision {revisions(held_out)}.",
        ],
        ("docs/own-data.md", "robots"): lines,
    }


def shortest(recordings):
    rows = [("100,000 samples", 100_000, 0.0), ("10,000 samples", 10_000, 0.0), ("1,000 samples", 1_000, 0.0),
            ("100,000 samples, noise of 10 %", 100_000, 0.1)]
    coordinations = ", ".join(f"{p:g}" for p in sorted({float(row["coordination"]) for row in recordings}))
    lines = [f"| simulated random movement, 15 bodies, p of {coordinations}; samples of {INTERVAL:g} s | trees right | 95 % interval | n |", "|---|---|---|---|"]
    for name, samples, noise in rows:
        own = of(recordings, samples, noise)
        share, low, high = ends(own, "tree_right")
        lines.append(f"| {name} | {share} % | {low} to {high} % | {len(own)} |")
    return lines


def by_length(recordings):
    lines = ["| T (time) | p | targets | noise | parts right | tree right | tree right, true parts given |", "|---|---|---|---|---|---|---|"]
    for samples, noise in kinds(recordings):
        for p in sorted({float(row["coordination"]) for row in recordings}):
            own = [row for row in of(recordings, samples, noise) if float(row["coordination"]) == p]
            seconds = samples * INTERVAL
            targets = round(seconds / EPOCH * (1 - p))
            cells = [f"{samples:,} ({seconds:,.0f} s)", f"{p:g}", f"{targets:,}", f"{noise:g}", *rates(own)]
            lines.append(f"| {' | '.join(cells)} |")
    return lines


def pooled(recordings):
    lines = ["| T | noise | n | parts right | tree right | tree right, true parts given |", "|---|---|---|---|---|---|"]
    for samples, noise in kinds(recordings):
        own = of(recordings, samples, noise)
        lines.append(f"| {' | '.join([f'{samples:,}', f'{noise:g}', str(len(own)), *rates(own)])} |")
    return lines


def support(recordings, edges):
    """How often edges are right, by their bootstrap support, the noise, and whether the parts are right."""
    groups = [(noise, right) for noise in (0.0, 0.1) for right in (True, False)]
    names = [f"{'noise 0.1' if noise else 'no noise'}, {'right' if right else 'wrong'} parts" for noise, right in groups]
    lines = [f"| support | {' | '.join(names)} |", f"|---|{'---|' * len(groups)}"]
    for name, ends in BINS.items():
        cells = [supported(recordings, edges, ends, *group) for group in groups]
        lines.append(f"| {name} | {' | '.join(cells)} |")
    return lines


def certain(recordings, edges):
    """The same of edges with a support of 100 %."""
    lines = ["| | right parts | wrong parts |", "|---|---|---|"]
    for name, noise in [("no noise", 0.0), ("noise of 10 %", 0.1)]:
        cells = [supported(recordings, edges, BINS["100 %"], noise, right) for right in (True, False)]
        lines.append(f"| {name} | {' | '.join(cells)} |")
    return lines


def sure(recordings, edges):
    """How often edges with a support of 95 % and more are right, whatever the parts, by length, noise and p."""
    coordinations = sorted({row["coordination"] for row in edges}, key=float)
    lines = [f"| T | noise | {' | '.join(f'p = {float(p):g}' for p in coordinations)} |", f"|---|---|{'---|' * len(coordinations)}"]
    groups = certain_edges(recordings, edges)
    for samples, noise in kinds(recordings):
        own = [groups[samples, noise, p] for p in coordinations]
        cells = [rate(one, "right", f"; n = {len(one):,}") for one in own]
        lines.append(f"| {samples:,} | {noise:g} | {' | '.join(cells)} |")
    return lines


def certain_edges(recordings, edges):
    """The edges with a support of 95 % and more, by length, noise and p."""
    certain = [row for row in edges if float(row["support"]) >= 0.95]
    return {(*kind, p): [row for row in of(certain, *kind) if row["coordination"] == p]
            for kind in kinds(recordings) for p in sorted({row["coordination"] for row in edges})}


def supported(recordings, edges, ends, noise, parts_right):
    """How often edges with a support in this range are right."""
    key = lambda row: tuple(row[name] for name in ["body", "coordination", "movement", "samples", "noise"])
    wanted = {key(row) for row in recordings if (row["parts_right"] == "true") == parts_right}
    own = [row for row in edges
           if float(row["noise"]) == noise and key(row) in wanted and ends[0] <= float(row["support"]) < ends[1]]
    return rate(own, "right", f"; n = {len(own):,}") if own else "–"


def recorded(moved, further):
    """What came out of recorded movements, by use, collection and length."""
    groups = [
        ("held out, one collection of acted movements", [row for row in of_use("held out", moved) if row["recording"] not in further]),
        ("held out, further collections", [row for row in of_use("held out", moved) if row["recording"] in further]),
        ("calibration", of_use("calibration", moved)),
    ]
    lines = ["| recordings | samples | mean adjusted Rand index | parts right | tree right | revision |", "|---|---|---|---|---|---|"]
    for name, rows in groups:
        for length, is_long in [("fewer than 1,000 samples", False), ("1,000 samples or more", True)]:
            own = [row for row in rows if (int(row["samples"]) >= 1000) == is_long]
            if own:
                counts = [int(row["samples"]) for row in own]
                mean = sum(float(row["ari"]) for row in own) / len(own)
                parts = interval(sum(row["parts"] == row["true_parts"] for row in own), len(own))
                cells = [f"{name}, {length}", f"{min(counts):,} to {max(counts):,}", f"{mean:.3f}", parts, trees_right(own), revisions(own)]
                lines.append(f"| {' | '.join(cells)} |")
    return [*lines, "", "In this table, parts count as right if their number is right. Made by `reproduce/recordings.py`."]


def kinds(recordings):
    return sorted({(int(row["samples"]), float(row["noise"])) for row in recordings}, key=lambda kind: (kind[1], kind[0]))


def of(recordings, samples, noise):
    return [row for row in recordings if int(row["samples"]) == samples and float(row["noise"]) == noise]


def rates(rows):
    return [rate(rows, column) for column in ("parts_right", "tree_right", "tree_of_true_parts_right")]


def rate(rows, column, more=""):
    share, low, high = ends(rows, column)
    return f"{share} % ({low} to {high}{more})"


def ends(rows, column):
    """A share with its 95 % interval (Wilson), in percent, as text."""
    count = sum(row[column] == "true" for row in rows)
    shares = [count / len(rows), *(min(1.0, max(0.0, end)) for end in wilson(count, len(rows)))]
    return [{"0.0": "0", "100.0": "100"}.get(text, text) for text in (f"{100 * share:.1f}" for share in shares)]
