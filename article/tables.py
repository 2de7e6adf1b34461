"""The tables of the article: all claims, tree accuracies by configuration, and open choices. Used by values.py."""

import tomllib

from committed import *

# Below this share of eligible samples, a choice counts as one that loses the published rate.
HARDLY = 0.05
DEFAULT_OF = {ABLATION: "equations", STEP: "default"}


def claims(now, before, published):
    """The table of all claims: what the paper says, what came out in both runs, and the verdict by the confirmation."""
    rows = []
    for key, (row, _) in now["rows"].items():
        if key[2] != ALL:
            continue
        claim, unit = published[row["id"]], row["unit"]
        reading = {CODE: "authors' code", EQUATIONS: "equations"}[row["reading"]] if row["id"] == "tree-accuracy" else ""
        rows.append(
            {
                "claim": claim["statement"] + (f" ({reading})" if reading else ""),
                "place": claim["place"].removeprefix("sections ").removeprefix("section "),
                "published": row["wording"],
                "confirmation": shown(row["value"], unit),
                "interval": span((row["low"], row["high"]), unit),
                "before": shown(before["rows"][key][0]["value"], unit),
                "accepted": span((row["accepted_low"], row["accepted_high"]), unit),
                "verdict": marked(row["verdict"], before["rows"][key][0]["verdict"]),
            }
        )
    return rows


def marked(verdict, before):
    """A verdict, in bold if the claim is reproduced, and with a dagger if it differs from that of the run before."""
    return (f"*{verdict}*" if verdict == "reproduced" else verdict) + ("" if verdict == before else " †")


def folder(source):
    """Where in docs/shown a table lies: its folder, or the table itself."""
    path = source.removeprefix("docs/shown/")
    return path.rpartition("/")[0] or path.partition(".")[0]


# ---- Table of tree accuracies


def rates(now, before):
    """The headline in each configuration that the article speaks of."""
    rows = []

    def add(configuration, row, source, run, simulations):
        right = row["value"]
        rows.append(
            {
                "configuration": configuration,
                "run": str(run),
                "simulations": str(simulations),
                "n": thousands(row["n"]),
                "rate": percent(right) if right else "–",
                "interval": percents(row["low"], row["high"]) if right else "",
                "source": folder(source),
            }
        )

    for words, run in {"": now, ", run before": before}.items():
        for name, reading in {"default": EQUATIONS, "authors' code, with its prior and map": CODE}.items():
            row, source = run["rows"]["tree-accuracy", reading, ALL]
            add(f"{name}{words}", row, source, run["seed"], run["simulations"])
    studies = [
        (STEP, {"default": "default", "half the step": "default, half the time step"}),
        (
            ABLATION,
            {
                "equations": "default, 10 of the simulations of the run before",
                "joints integrated out of edges": "default, joints integrated out of edges",
                "tree from component 0": "default, tree from component zero",
                "and its map": "authors' code, with its prior and map",
                "no angular momentum of the engine": "default, drift taken off",
                "no fluid pushes": "default, one-way coupling",
            },
        ),
    ]
    for source, names in studies:
        found = compared(source)
        for name, words in names.items():
            add(words, found[name, "tree-accuracy"], source, seed(source), found[DEFAULT_OF[source], "number-of-parts"]["simulations"])
    for part, name, words in [
        ("default", "", "default, 4 simulations"),
        ("edge-weight", "edge_weight = literal", "default, edge weight of the letter"),
        ("sampler", None, "authors' code, with the default's prior and rows mapped"),
    ]:
        row = next(row for row in sensitivity("tree", part) if name in [None, row["setting"]])
        add(words, row, SENSITIVITY, seed(SENSITIVITY), row["simulations"])
    for words, number, reading in [
        ("fifth default, two-way coupling", "5", EQUATIONS),
        ("third default, one-way coupling, its interpretation: authors' code", "3", CODE),
        ("third default, by the equations", "3", EQUATIONS),
    ]:
        row = former_default(number, reading)
        add(words, row, FORMER, row["seed"], row["simulations"])
    found = compared(MOMENTUM)
    for name, words in {"as the engine leaves it": "third default, other simulations", "conserved": "third default, other simulations, drift taken off"}.items():
        add(words, found[name, "tree-accuracy"], MOMENTUM, seed(MOMENTUM), found[name, "number-of-parts"]["simulations"])
    return rows


# ---- The sensitivity study, and the table of open choices


def sensitivity(measure, part):
    """Rows of DPGMM-LJ at p = 0.9 and d = 14."""
    wanted = ("0.9", "14", "dpgmm-lj", measure)
    rows = [row for row in table(SENSITIVITY) if tuple(row[key] for key in ["coordination", "dimension", "model", "measure"]) == wanted]
    names = {row["configuration"]: row for row in table("docs/shown/sensitivity/configurations.csv")}
    # The base has the name "default" and no label; every other configuration has the label of one factor.
    of_part = lambda own: own["name"] == part or own.get(part)
    return [row | {"setting": names[row["configuration"]].get(part, "")} for row in rows if of_part(names[row["configuration"]])]


def seed(source):
    """The seed of a study, by its design."""
    return tomllib.loads(read(f"reproduce/{source.split('/')[-2]}.toml"))["seed"]


def choices(published):
    """Open choices in the order in which they matter: by the share of the alternatives tried that lose the published rate, and
    then by the lowest rate."""
    rows = []
    for choice in tomllib.loads(read("article/choices.toml"))["choice"]:
        if "part" in choice:
            found, source = varied(choice), SENSITIVITY
        else:
            source = f"docs/shown/{choice['study']}/study.csv"
            row, all = (compared(source)[choice["configuration"], id] for id in ["tree-accuracy", "number-of-parts"])
            found = [(choice["name"], row, int(all["n"]))]
        rows.append(choice_row(choice["state"], found, source, published["tree-accuracy"]["accept"]))
    rows = [row for _, row in sorted(rows, key=lambda pair: pair[0])]
    value("sensitivity-default", percent(sensitivity("tree", "default")[0]["value"], 0), SENSITIVITY)
    design = tomllib.loads(read("reproduce/sensitivity.toml"))["settings"]
    value("sensitivity-simulations", design["experiment"]["simulations"], "reproduce/sensitivity.toml")
    value("sensitivity-chains", design["schema"]["chains"], "reproduce/sensitivity.toml")
    literal = next(row for row in sensitivity("tree", "edge-weight") if row["setting"] == "edge_weight = literal")
    value("literal-tree", percent(literal["value"], 0), SENSITIVITY)
    first = [row["state"] for row in rows[:3]]
    says("the fluid comes first, then the shape and the program", first == ["Whether the fluid also acts on the body", "Shape of the body", "Which program made the figures"])
    return rows


def varied(choice):
    """The alternatives of a choice: name, row of the tree accuracy, and number of all samples."""
    tree, eligible = ({row["setting"]: row for row in sensitivity(measure, choice["part"])} for measure in ["tree", "eligible"])
    named = choice["names"]
    left_out = set(eligible) - set(named.values()) - set(choice.get("elsewhere", []))
    assert not left_out, f"article/choices.toml lacks a name in {choice['part']} for {left_out}"
    nothing = {"value": "", "n": "0"}
    return [(name, tree.get(setting, nothing), int(eligible[setting]["n"])) for name, setting in named.items()]


def choice_row(state, found, source, accepted):
    """A row of the table, and what orders it."""
    low, high = accepted

    def hardly(one):
        _, row, all = one
        return not row["value"] or int(row["n"]) < HARDLY * all

    def said(one):
        return "none" if not one[1]["value"] else "hardly any" if hardly(one) else percent(one[1]["value"], 0)

    rate = lambda one: -1 if hardly(one) else float(one[1]["value"])
    lost = [one for one in found if hardly(one) or float(one[1]["high"]) < low or float(one[1]["low"]) > high]
    found = sorted(found, key=rate)
    names = {}
    for one in found:
        names.setdefault(said(one), []).append(one[0])
    _, row, all = found[0]
    cells = {
        "state": state,
        "found": "; ".join(f"*{rate}* {', '.join(alike)}" for rate, alike in names.items()),
        "lost": f"{len(lost)} of {len(found)}",
        "lowest": f"{row['n']} of {all} eligible" if hardly(found[0]) else f"{percents(row['low'], row['high'], 0)}; n = {row['n']}",
        "source": folder(source),
    }
    return (-len(lost) / len(found), rate(found[0])), cells
