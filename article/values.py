#!/usr/bin/env python3
"""Take the numbers of the article from the committed results: article/values.py [--check]

It writes article/values.toml: each number that content.typ names, in the words in which it is printed, with the file that it
comes from; and all claims, for the table. With --check it writes nothing, and ends with status 1 if values.toml is not what it
would write. Where the text says something of the numbers in words ("below the range"), `says` states it here, so that new
results which contradict the text end in an error and not in a wrong article. Needs Python 3.11, and no packages.
"""

import csv
import gzip
import io
import pathlib
import sys
import tomllib

ROOT = pathlib.Path(__file__).resolve().parent.parent
TARGET = ROOT / "article" / "values.toml"
VERDICTS = ["reproduced", "not reproduced", "not testable"]

values = {}
broken = []


def main():
    settings = tomllib.loads(read("reproduce/paper.toml"))
    published = {claim["id"]: claim for claim in tomllib.loads(read("reproduce/published.toml"))["claim"]}
    stated(settings, published)
    claims = experiments(published)
    former(published)
    dimensions()
    coordinations()
    search(published)
    multiverse(published)
    ablation()
    step()
    momentum()
    mixing()
    if broken:
        sys.exit("\n".join(f"article/content.typ says: {words}; the results do not. Change the text" for words in broken))
    text = written(claims)
    if "--check" not in sys.argv[1:]:
        TARGET.write_text(text)
    elif not TARGET.exists() or TARGET.read_text() != text:
        sys.exit("article/values.toml is not what the committed results give; run article/values.py and read the article anew")


def read(name):
    return (ROOT / name).read_text()


def table(name):
    """Rows of a committed table, packed or not."""
    path = ROOT / name
    text = gzip.decompress(path.read_bytes()).decode() if path.suffix == ".gz" else path.read_text()
    return list(csv.DictReader(io.StringIO(text)))


def value(name, text, source):
    assert name not in values, name
    values[name] = (str(text), source)


def says(words, holds):
    """What the text says of its numbers in words."""
    if not holds:
        broken.append(words)


def percent(number, digits=1):
    """A rate as a percentage, without decimals if it is 0 or 1."""
    number = 100 * float(number)
    return f"{number:.0f} %" if number in (0, 100) else f"{number:.{digits}f} %"


def percents(low, high, digits=1):
    """A range of rates."""
    return f"{percent(low, digits).removesuffix(' %')} to {percent(high, digits)}"


def points(number):
    """A difference of rates, in percentage points."""
    return f"{abs(100 * float(number)):.0f}".replace("-", "−")


# ---- What the paper states


def stated(settings, published):
    paper, claims = "reproduce/paper.toml", "reproduce/published.toml"
    skin, experiment = settings["skin"], settings["experiment"]
    value("sensors", 5 * (skin["around"] * skin["along"] + skin["caps"]), paper)
    value("duration", f"{settings['physics']['duration']:,.0f}", paper)
    value("interval", settings["sense"]["interval"], paper)
    value("epoch", settings["motion"]["epoch"], paper)
    value("step", settings["physics"]["step"], paper)
    value("epoch-seconds", f"{settings['motion']['epoch'] * settings['physics']['step']:.0f}", paper)
    value("levels", settings["quantise"]["levels"], paper)
    value("around", skin["around"], paper)
    value("rings", skin["along"], paper)
    value("scale", settings["schema"]["scale"], paper)
    value("chains", settings["schema"]["chains"], paper)
    value("sweeps", settings["schema"]["sweeps"], paper)
    authors = "reproduce/authors.toml"
    value("authors-sweeps", tomllib.loads(read(authors))["schema"]["sweeps"], authors)
    value("gain", settings["motion"]["servo_gain"], paper)
    value("fluid", f"{settings['physics']['fluid_density']:.0f}", paper)
    value("bodies", experiment["simulations"], paper)
    value("seed", experiment["seed"], paper)
    value("length", settings["agent"]["part_length"], paper)
    value("radius", settings["agent"]["part_radius"], paper)
    value("gap", settings["agent"]["gap"], paper)
    value("authors-settings", len(settings["schema"]["authors"]), paper)
    value("open", sum("ours" in line.partition("#")[2] for line in read(paper).splitlines() if "=" in line), paper)
    headline = published["tree-accuracy"]
    value("published", headline["wording"], claims)
    value("accepted", percents(*headline["accept"]), claims)
    value("counts", " and ".join(f"{right}/{all}" for right, all in headline["possible_counts"]), claims)
    value("ari-published", published["ari-unknown-number"]["accept"][0], claims)
    value("counts-least", headline["possible_counts"][0][1], claims)
    value("claims", len(published), claims)


# ---- Both experiments


def experiments(published):
    """Values of single claims, and the rows of the table of all of them."""
    rows = {}
    for experiment in ["exp1", "exp2"]:
        source = f"docs/shown/{experiment}/claims.csv"
        for row in table(source):
            if row["counting"] == "all-draws":
                rows.setdefault((row["id"], row["reading"]), (row, source))
    code, equations = rows["tree-accuracy", "authors-code"], rows["tree-accuracy", "equations"]
    low, high = published["tree-accuracy"]["accept"]
    headlines("", code, equations)
    value("tree-equations-single", percents(equations[0]["lowest"], equations[0]["highest"]), equations[1])
    says("the tree accuracy is within the range by the equations", low <= float(equations[0]["value"]) <= high)
    says("the tree accuracy is below the range by the code", float(code[0]["value"]) < low)
    rate = published["tree-accuracy"]["published"]
    holds = [float(row["low"]) <= rate <= float(row["high"]) for row, _ in [code, equations]]
    says("only the interval of the equations holds the published rate", holds == [False, True])
    bodies, source = equations
    value("one-body", f"{round(float(bodies['bodies_share']) * int(bodies['bodies']))} of {bodies['bodies']}", source)
    row, source = next(pair for key, pair in rows.items() if key[0] == "best-coordination")
    value("one-body-all", round(float(row["bodies_together"]) * int(row["bodies"])), source)
    simple(rows, published)
    main = {id: row for (id, reading), (row, _) in rows.items() if (id, reading) != ("tree-accuracy", "authors-code")}
    counts = [sum(row["verdict"] == verdict for row in main.values()) for verdict in VERDICTS]
    for verdict, count in zip(VERDICTS, counts):
        value(verdict.replace(" ", "-"), count, "docs/shown/*/claims.csv")
    says("most of the other claims are reproduced", counts[0] > (len(main) - 1) / 2)
    return [claim_row(row, published[id]) for (id, _), (row, _) in rows.items()]


def headlines(prefix, code, equations):
    """The headline by both readings."""
    for name, (row, source) in {"code": code, "equations": equations}.items():
        value(f"{prefix}tree-{name}", percent(row["value"]), source)
        value(f"{prefix}tree-{name}-interval", percents(row["low"], row["high"]), source)
        value(f"{prefix}tree-{name}-n", f"{int(row['n']):,}", source)


def former(published):
    """The default without a fluid that pushes, by the authors' code."""
    source = "docs/shown/no-fluid/exp1/claims.csv"
    rows = [row for row in table(source) if (row["id"], row["counting"]) == ("tree-accuracy", "all-draws")]
    by = {row["reading"]: (row, source) for row in rows}
    headlines("former-", by["authors-code"], by["equations"])
    low, high = published["tree-accuracy"]["accept"]
    says("without a fluid the tree accuracy is below the range by the code", float(by["authors-code"][0]["value"]) < low)
    says("without a fluid it is above the range by the equations", float(by["equations"][0]["value"]) > high)
    verdicts = {}
    for experiment in ["exp1", "exp2"]:
        for row in table(f"docs/shown/no-fluid/{experiment}/claims.csv"):
            if row["counting"] == "all-draws" and (row["id"], row["reading"]) != ("tree-accuracy", "equations"):
                verdicts[row["id"]] = row["verdict"]
    value("former-reproduced", list(verdicts.values()).count("reproduced"), "docs/shown/no-fluid/*/claims.csv")


def simple(rows, published):
    """Claims that the text names by their value alone, with interval and range where it needs them."""
    own = {id: pair for (id, reading), pair in rows.items() if reading == "equations"}

    def take(name, id, column="value", shown=percent):
        row, source = own[id]
        value(name, shown(row[column]), source)

    take("prim", "baseline-tree")
    row, source = own["baseline-tree"]
    value("prim-interval", percents(row["low"], row["high"]), source)
    value("prim-n", f"{int(row['n']):,}", source)
    take("parts-worst", "number-of-parts", shown=lambda number: f"{float(number):.2f}")
    value("parts-worst-where", own["number-of-parts"][0]["found"].removeprefix("worst: "), own["number-of-parts"][1])
    take("ari-lowest", "ari-unknown-number", shown=lambda number: f"{float(number):.2f}")
    take("ari-p", "ari-over-coordination", shown=lambda number: f"{float(number):.2f}")
    take("first-dimension", "first-dimension", shown=lambda number: f"{float(number):.0f}")
    take("best-dimension", "best-dimension", shown=lambda number: f"{float(number):.0f}")
    take("best-p", "best-coordination", shown=lambda number: f"{float(number):g}")
    take("p-value", "tree-depends-on-coordination", shown=lambda number: shown(number, "p-value"))
    verdicts = {id: row["verdict"] for id, (row, _) in own.items()}
    value("prim-accepted", percent(published["baseline-tree"]["accept"][1]), "reproduce/published.toml")
    for id in ["tree-accuracy", "baseline-tree", "tree-low-dimensions", "first-dimension", "ari-unknown-number", "ari-over-coordination"]:
        says(f"{id} is reproduced", verdicts[id] == "reproduced")
    says("the effect of coordination is clear", verdicts["tree-depends-on-coordination"] == "reproduced")
    for id in ["number-of-parts", "tree-high-dimensions", "best-dimension", "best-coordination"]:
        says(f"{id} is not reproduced", verdicts[id] == "not reproduced")


def claim_row(row, claim):
    """The cells of a claim in the table of the article."""
    unit = row["unit"]
    cell = lambda text: shown(text, unit)
    reading = {"authors-code": "code", "equations": "equations"}[row["reading"]] if row["id"] == "tree-accuracy" else ""
    accepted = (row["accepted_low"], row["accepted_high"])
    return {
        "claim": claim["statement"] + (f" ({reading})" if reading else ""),
        "place": claim["place"].removeprefix("sections ").removeprefix("section "),
        "published": row["wording"],
        "reproduced": cell(row["value"]),
        "interval": span((row["low"], row["high"]), unit),
        "accepted": span(accepted, unit),
        "verdict": row["verdict"],
    }


def span(ends, unit):
    if not all(ends):
        return ""
    low, high = (shown(end, unit) for end in ends)
    if low == high:
        return low
    return f"{low.removesuffix(' %')} to {high}"


def shown(text, unit):
    if not text:
        return ""
    number = float(text)
    if unit == "rate":
        return percent(number)
    if unit == "p-value":
        return "< 0.001" if 0 < number < 0.001 else f"{number:.2g}"
    return f"{number:.2f}" if unit == "ari" else f"{number:.3g}"


def rates(source, key):
    """Tree accuracy of DPGMM-LJ over one axis of a figure."""
    return {
        float(row[key]): float(row["value"])
        for row in table(source)
        if row["counting"] == "all-draws" and row["method"] == "dpgmm-lj" and row["value"]
    }


def dimensions():
    source = "docs/shown/exp1/fig10b-tree.csv"
    found = rates(source, "dimension")
    for d in [5, 8, 9, 11, 14]:
        value(f"tree-d{d}", percent(found[d], 0), source)
    says("the tree accuracy rises from d = 5 to d = 11", found[5] < found[8] < found[9] < found[11])
    parts = "docs/shown/exp1/fig07-parts.csv"
    means = {int(row["dimension"]): float(row["mean"]) for row in table(parts) if row["counting"] == "all-draws"}
    value("parts-d14", f"{means[14]:.1f}", parts)
    says("the number of parts is slightly above five at every d but two", all(5 <= mean <= 6 for d, mean in means.items() if d != 2) and means[2] > 6)


def coordinations():
    source = "docs/shown/exp2/fig11b-tree.csv"
    found = rates(source, "coordination")
    small = [rate for p, rate in found.items() if p <= 0.4]
    value("small-p", percents(min(small), max(small), 0), source)
    best = max(found, key=found.get)
    says("p = 0.8 is the best, and 0.9 next to it", sorted(found, key=found.get)[-2:] == [0.9, 0.8])
    row = next(row for row in table(source) if row["counting"] == "all-draws" and float(row["coordination"]) == best)
    value("best-p-tree", percent(row["value"]), source)
    value("best-p-interval", percents(row["low"], row["high"]), source)


# ---- The studies


def search(published):
    parts = ["screen", "twenty", "readings", "fluid-screen", "fluid", "fluid-wide", "fluid-finalists", "fluid-scales", "fluid-pairwise"]
    claims = {name: table(f"docs/shown/{name}/scores.csv") for name in parts}
    claims["wide-best"] = [row for row in claims["fluid-wide"] if row["round"] == "2"]
    claims["fluid-wide"] = [row for row in claims["fluid-wide"] if row["round"] == "1"]
    held = lambda row, *ids: set(ids) <= set(row["hold"].split())
    for name, part in {"screened": "screen", "fluid-screened": "fluid-screen"}.items():
        source = f"docs/shown/{part}/scores.csv"
        resolved = [row for row in claims[part] if row["resolved"] == "true"]
        value(name, f"{len(claims[part]):,}", source)
        value(f"{name}-resolved", f"{len(resolved):,}", source)
        value(f"{name}-tree", sum(held(row, "tree-accuracy") for row in resolved), source)
    wide = "docs/shown/fluid-wide/scores.csv"
    value("wide-screened", f'{len(claims["fluid-wide"]):,}', wide)
    value("wide-tried", len(claims["wide-best"]), wide)
    says("all of the wide screen are resolved", all(row["resolved"] == "true" for row in claims["fluid-wide"]))
    for name, id in {"lost": "tree-random-movement", "best": "best-coordination"}.items():
        count = sum(held(row, id) for row in claims["fluid-screen"] if row["resolved"] == "true")
        value(f"fluid-screened-{name}", count, "docs/shown/fluid-screen/scores.csv")
    for part in ["twenty", "readings", "fluid", "fluid-finalists", "fluid-scales", "fluid-pairwise"]:
        value(f"{part.removeprefix('fluid-')}-tried", len(claims[part]), f"docs/shown/{part}/scores.csv")
    rounds = tomllib.loads(read("reproduce/fluid-wide.toml"))["round"]
    for name, place in {"search": -2, "last": -1}.items():
        value(f"{name}-bodies", rounds[place]["settings"]["experiment"]["simulations"], "reproduce/fluid-wide.toml")
    first, winner = claims["readings"][0], claims["fluid-pairwise"][0]
    credit = lambda source, row, id: next(r for r in table(source) if (r["candidate"], r["claim"]) == (row["candidate"], id))
    for name, part, row in [("first", "readings", first), ("winner", "fluid-pairwise", winner)]:
        source = f"docs/shown/{part}/credits.csv"
        value(f"{name}-tree", percent(credit(source, row, "tree-accuracy")["value"]), source)
        value(f"{name}-held", row["satisfied"], f"docs/shown/{part}/scores.csv")
    source = "docs/shown/fluid-pairwise/credits.csv"
    tree = credit(source, winner, "tree-accuracy")
    value("winner-tree-interval", percents(tree["low"], tree["high"]), source)
    value("winner-parts", f'{float(credit(source, winner, "number-of-parts")["value"]):.1f}', source)
    value("scored", winner["terms"], "docs/shown/fluid-pairwise/scores.csv")
    whole = [row["candidate"] for row in claims["fluid-scales"] if row["satisfied"] == row["terms"]]
    value("whole", len(whole), "docs/shown/fluid-scales/scores.csv")
    most = max(int(row["satisfied"]) for name in ["fluid", "wide-best", "fluid-finalists"] for row in claims[name])
    says("with as many bodies, none before had all", most < int(winner["terms"]))
    value("most-held", most, "docs/shown/fluid*/scores.csv")
    most = max(int(row["satisfied"]) for row in claims["fluid-pairwise"])
    says("with more bodies none has all, and the winner has most", most == int(winner["satisfied"]) == int(winner["terms"]) - 1)
    says("the winner lacks the number of parts alone", not held(winner, "number-of-parts"))
    both = [row for row in claims["fluid-pairwise"] if held(row, "number-of-parts", "tree-high-dimensions")]
    says("the tree at nine dimensions excludes the number of parts", not both)
    source = "docs/shown/collapsed/exp1/claims.csv"
    rows = [row for row in table(source) if (row["id"], row["reading"], row["counting"]) == ("tree-accuracy", "equations", "all-draws")]
    value("collapsed-tree", percent(rows[0]["value"]), source)
    more = [table(f"docs/shown/{name}/scores.csv") for name in ["first", "second", "neighbours", "finalists", "crosses"]]
    distinct = {row["settings"] for rows in [*claims.values(), *more] for row in rows}
    value("all-tried", f"{len(distinct):,}", "docs/shown/*/scores.csv")


def multiverse(published):
    folder = "docs/shown/multiverse"
    low, high = published["tree-accuracy"]["accept"]
    source = f"{folder}/multiverse.csv.gz"
    rows = [row for row in table(source) if row["claim"] == "tree-accuracy"]
    found = [float(row["value"]) for row in rows if row["value"]]
    value("universes", f"{len(rows):,}", source)
    value("universes-none", len(rows) - len(found), source)
    value("universes-below", sum(rate < low for rate in found), source)
    value("universes-zero", sum(rate == 0 for rate in found), source)
    value("universes-above", sum(rate > high for rate in found), source)
    says("no specification is within the range", all(rate < low or rate > high for rate in found))
    source = f"{folder}/specifications.csv.gz"
    rows = table(source)
    value("universes-failed", sum(row["failed"] != "0" for row in rows), source)
    value("universes-resolved", sum(row["resolved"] == "true" for row in rows), source)
    value("movements", len({row["movement"] for row in rows}), source)
    source = f"{folder}/shares.csv"
    shares = {row["claim"]: row for row in table(source) if row["group"] == "all"}
    resolved = {row["claim"]: row for row in table(source) if row["group"] == "resolved"}
    changes = [float(row["share"]) - float(shares[claim]["share"]) for claim, row in resolved.items()]
    says("shares among resolved specifications hardly differ", max(map(abs, changes)) < 0.03)
    for name, claim in {"tree": "tree-accuracy", "parts": "number-of-parts", "ari": "ari-over-coordination", "p": "best-coordination"}.items():
        row = shares[claim]
        if name != "tree":  # which the text gives as a count
            value(f"share-{name}", percent(row["share"]), source)
        value(f"share-{name}-interval", percents(row["low"], row["high"]), source)
    joint, source = table(f"{folder}/joint.csv")[0], f"{folder}/joint.csv"
    value("joint-expected", percent(joint["expected"]), source)
    value("joint-n", joint["n"], source)
    source = "docs/shown/multiverse-held-out/shares.csv"
    other = {row["claim"]: row for row in table(source) if row["group"] == "all"}
    value("held-out", other["tree-accuracy"]["n"], source)
    inside = [float(row["low"]) <= float(other[claim]["share"]) <= float(row["high"]) for claim, row in shares.items()]
    value("held-out-inside", f"{sum(inside)} of {len(inside)}", source)
    source = f"{folder}/variance.csv"
    single = [row for row in table(source) if row["claim"] == "tree-accuracy" and not row["with"]]
    first = max(single, key=lambda row: float(row["share"]))
    prim = next(row for row in table(source) if (row["claim"], row["factor"], row["with"]) == ("baseline-tree", "shape", ""))
    value("variance-shape", percent(prim["share"]), source)
    value("variance-factor", first["factor"], source)
    value("variance-share", percent(first["share"]), source)
    says("no single choice decides a fifth of the variance of the tree accuracy", float(first["share"]) < 0.2)


def ablation():
    source = "docs/shown/ablation/comparison.csv"
    rows = compared(source)
    names = list(dict.fromkeys(name for name, _ in rows))
    eight = names[names.index("none of the eight") + 1 : names.index("all eight")]
    tree = {name: rows[name, "tree-accuracy"] for name in names}
    says("there are eight departures", len(eight) == 8)
    says("without its departures the code is the equations", all(rows["none of the eight", id]["value"] == row["value"] for (name, id), row in rows.items() if name == "equations"))
    for name, configuration in {"root": "tree from component 0", "collapsed": "joints integrated out of edges"}.items():
        row = tree[configuration]
        value(f"ablation-{name}", points(row["change"]), source)
        low, high = sorted([points(row["change_low"]), points(row["change_high"])], key=float)
        value(f"ablation-{name}-interval", f"{low} to {high}", source)
    says("with the tree from component 0 it falls, and with joints integrated out it rises", float(tree["tree from component 0"]["change_high"]) < 0 < float(tree["joints integrated out of edges"]["change_low"]))
    lost = [name for name in eight if not tree[name]["value"]]
    says("with one alone no draw is eligible", lost == ["means by the inverse scale"])
    small = [name for name in eight if tree[name]["change"] and abs(float(tree[name]["change"])) < 0.05]
    says("the six others change it by less than five points", len(small) == 6)
    value("ablation-parts", f'{float(rows["means by the inverse scale", "number-of-parts"]["value"]):.1f}', source)
    row = tree["no angular momentum of the engine"]
    value("ablation-engine", f"{100 * float(row['change']):.1f}", source)
    value("ablation-engine-interval", f"{100 * float(row['change_low']):.1f} to {100 * float(row['change_high']):.1f}".replace("-", "−"), source)
    row = rows["no fluid pushes", "tree-random-movement"]
    value("ablation-dry", percent(row["value"]), source)
    value("ablation-dry-interval", percents(row["low"], row["high"]), source)
    says("without the fluid nearly no draw is eligible at p = 0.9", int(tree["no fluid pushes"]["n"]) < 10)
    value("ablation-bodies", max(int(row["simulations"]) for row in table(source)), source)


def compared(source):
    """Rows of a comparison, by configuration and claim."""
    return {(row["configuration"], row["claim"]): row for row in table(source)}


def step():
    source = "docs/shown/step/comparison.csv"
    rows = compared(source)
    half = rows["half the step", "tree-accuracy"]
    value("step-bodies", rows["default", "tree-accuracy"]["simulations"], source)
    value("step-tree", percent(rows["default", "tree-accuracy"]["value"]), source)
    value("step-tree-half", percent(half["value"]), source)
    changes = [row for (name, _), row in rows.items() if name == "half the step" and row["change"]]
    within = [row["claim"] for row in changes if float(row["change_low"]) <= 0 <= float(row["change_high"])]
    value("step-claims", len(changes), source)
    says("half the step changes no scored claim by more than its interval", len(within) == len(changes))


def momentum():
    source = "docs/shown/momentum/comparison.csv"
    rows = compared(source)
    engine, conserved, silent = "as the engine leaves it", "conserved", "conserved, and rest is no touch"
    for name, configuration in {"engine": engine, "conserved": conserved}.items():
        tree = rows[configuration, "tree-accuracy"]
        value(f"momentum-{name}-tree", percent(tree["value"]), source)
        value(f"momentum-{name}-tree-interval", percents(tree["low"], tree["high"]), source)
        value(f"momentum-{name}-small", percent(rows[configuration, "tree-random-movement"]["value"]), source)
    for name, configuration in {"engine": engine, "silent": silent}.items():
        value(f"momentum-{name}-ari", f"{float(rows[configuration, 'ari-over-coordination']['value']):.2f}", source)
    value("momentum-conserved-n", rows[conserved, "tree-accuracy"]["n"], source)
    value("momentum-bodies", rows[conserved, "number-of-parts"]["simulations"], source)
    without = [rows[configuration, "tree-accuracy"] for configuration in [conserved, silent]]
    says("without the error no tree is right at p = 0.9", all(float(row["value"]) == 0 for row in without))
    says("with rest as no touch nearly no draw is eligible", int(without[1]["n"]) < 10)


def mixing():
    source = "docs/shown/mixing/bodies-chains.csv"
    rows = [row for row in table(source) if row["sweeps"] == "100"]
    for d in [6, 9, 14]:
        exact = [row["exact"] == "true" for row in rows if row["dimension"] == str(d)]
        value(f"mixed-d{d}", percent(sum(exact) / len(exact), 0), source)
    source = "docs/shown/mixing/bodies-posterior.csv"
    for d in [6, 14]:
        exact = [row for row in table(source) if row["exact"] == "true" and row["dimension"] == str(d)]
        right = sum(row["tree_right"] == "true" for row in exact)
        value(f"mixed-tree-d{d}", f"{right} of {len(exact)}", source)


# ---- The file


def written(claims):
    quote = lambda text: '"' + text.replace("\\", "\\\\").replace('"', '\\"') + '"'
    lines = ["# Made by article/values.py from the committed results. Do not edit.", ""]
    for name, (text, source) in sorted(values.items()):
        lines.append(f"{name} = {{ text = {quote(text)}, from = {quote(source)} }}")
    for row in claims:
        lines += ["", "[[table]]", *(f"{key} = {quote(text)}" for key, text in row.items())]
    return "\n".join(lines) + "\n"


main()
