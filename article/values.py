#!/usr/bin/env python3
"""Take the numbers of the article from the committed results: article/values.py [--check]

It writes article/values.toml: each number that content.typ names, in the words in which it is printed, with the file that it
comes from; what holds, by which content.typ chooses between two wordings; and the tables. It writes the abstract, too, into
article/metadata.yaml and CITATION.cff. With --check it writes nothing, and ends with status 1 if one of the three is not what it
would write. Where the text says something of the numbers in words and has no other wording, `says` states it here, so that new
results which contradict the text end in an error and not in a wrong article. Needs Python 3.11, and no packages.
"""

import pathlib
import sys
import tomllib

sys.dont_write_bytecode = True
sys.path[:0] = [str(pathlib.Path(__file__).resolve().parent / folder) for folder in [".", "../reproduce"]]
import abstract
import confirm  # the registered rule and its sentences
import tables
from committed import *

TARGET = ROOT / "article" / "values.toml"


def main():
    settings = tomllib.loads(read("reproduce/paper.toml"))
    published = {claim["id"]: claim for claim in tomllib.loads(read("reproduce/published.toml"))["claim"]}
    stated(settings, published)
    before = claims_of(BEFORE)
    now = confirmation(published, before)
    dimensions()
    coordinations(now)
    search()
    multiverse(published)
    fluid()
    departures()
    step()
    besides(before)
    rows = {
        "claims": tables.claims(now, before, published),
        "rates": tables.rates(now, before),
        "choices": tables.choices(published),
    }
    if broken:
        sys.exit("\n".join(f"article/content.typ says: {words}; the results do not. Change the text" for words in broken))
    files = {TARGET: written(rows)} | {ROOT / name: abstract.put_into(name) for name in ["article/metadata.yaml", "CITATION.cff"]}
    for path, content in files.items():
        if "--check" not in sys.argv[1:]:
            path.write_text(content)
        elif not path.exists() or path.read_text() != content:
            name = path.relative_to(ROOT)
            sys.exit(f"{name} is not what the committed results give; run reproduce/article.sh --write and read the article anew")


# ---- What the paper states, and what is ours


def stated(settings, published):
    paper, claims, authors = "reproduce/paper.toml", "reproduce/published.toml", "reproduce/authors.toml"
    skin, experiment, schema = settings["skin"], settings["experiment"], settings["schema"]
    value("sensors", 5 * (skin["around"] * skin["along"] + skin["caps"]), paper)
    value("duration", thousands(settings["physics"]["duration"]), paper)
    value("interval", settings["sense"]["interval"], paper)
    value("epoch", settings["motion"]["epoch"], paper)
    value("step", settings["physics"]["step"], paper)
    value("epoch-seconds", f"{settings['motion']['epoch'] * settings['physics']['step']:.0f}", paper)
    value("levels", settings["quantise"]["levels"], paper)
    value("around", skin["around"], paper)
    value("rings", skin["along"], paper)
    value("scale", schema["scale"], paper)
    value("chains", schema["chains"], paper)
    value("sweeps", schema["sweeps"], paper)
    value("dimension", experiment["dimension"], paper)
    value("authors-sweeps", tomllib.loads(read(authors))["schema"]["sweeps"], authors)
    value("gain", settings["motion"]["servo_gain"], paper)
    value("fluid", f"{settings['physics']['fluid_density']:.0f}", paper)
    value("length", settings["agent"]["part_length"], paper)
    value("radius", settings["agent"]["part_radius"], paper)
    value("gap", settings["agent"]["gap"], paper)
    value("departures", len(schema["authors"]), paper)
    value("open", sum("ours" in line.partition("#")[2] for line in read(paper).splitlines() if "=" in line), paper)
    says("the default weighs edges pairwise", schema["edge_weight"] == "pairwise")
    says("the default has two-way fluid coupling", settings["physics"]["fluid_density"] > 0)
    headline = published["tree-accuracy"]
    value("published", headline["wording"], claims)
    value("accepted", percents(*headline["accept"]), claims)
    value("counts", " and ".join(f"{right}/{all}" for right, all in headline["possible_counts"]), claims)
    value("counts-least", headline["possible_counts"][0][1], claims)
    value("ari-published", published["ari-unknown-number"]["accept"][0], claims)
    value("prim-accepted", percent(published["baseline-tree"]["accept"][1]), claims)
    value("claims", len(published), claims)


# ---- The confirmation, and the run before it


def confirmation(published, before):
    """Values of single claims in the confirmation, and which hold."""
    source = "reproduce/confirm.toml"
    registered = tomllib.loads(read(source))
    fixed, expected = registered["registered"], registered["secondary"]
    now = claims_of(CONFIRMATION)
    if (now["seed"], now["simulations"]) != (fixed["seed"], fixed["simulations"]):
        sys.exit(f"article: {CONFIRMATION} is not the run that {source} registers")
    value("registered", fixed["on"], source)
    value("confirm-seed", fixed["seed"], source)
    value("simulations", fixed["simulations"], source)
    value("expected", len(expected["reproduced"]) + len(expected["not_reproduced"]), source)
    value("confirm-revision", now["revision"], f"{CONFIRMATION}/exp1/manifest.json")
    value("before-seed", before["seed"], f"{BEFORE}/exp1/manifest.json")
    value("before-simulations", before["simulations"], f"{BEFORE}/exp1/manifest.json")
    value("before-revision", before["revision"], f"{BEFORE}/exp1/manifest.json")

    confirmed, text = confirm.conclusion(registered, {name: confirm.read_claims(ROOT / CONFIRMATION / name) for name in confirm.EXPERIMENTS})
    flag("confirmed", confirmed)
    value("primary", text.splitlines()[0], f"{CONFIRMATION}/exp1/claims.csv")
    low, high = published["tree-accuracy"]["accept"]
    rate = published["tree-accuracy"]["published"]
    says("the accepted range is ten points to either side", max(abs(rate - low - 0.1), abs(high - rate - 0.1)) < 1e-9)
    for prefix, run in {"": now, "before-": before}.items():
        for name, reading in {"equations": EQUATIONS, "code": CODE}.items():
            row, source = run["rows"]["tree-accuracy", reading, ALL]
            value(f"{prefix}tree-{name}", percent(row["value"]), source)
            if (prefix, name) != ("before-", "code"):
                value(f"{prefix}tree-{name}-interval", percents(row["low"], row["high"]), source)
    code, source = now["rows"]["tree-accuracy", CODE, ALL]
    value("code-side", side(float(code["value"]), low, high), source)
    flag("code-agrees", float(code["low"]) <= rate <= float(code["high"]))
    flag("code-lower", float(code["high"]) < float(own(now, "tree-accuracy")[0]["low"]))
    says("the run before it reproduced the headline", own(before, "tree-accuracy")[0]["verdict"] == "reproduced")

    row, source = own(now, "tree-accuracy")
    value("tree-single", percents(row["lowest"], row["highest"]), source)
    value("one-simulation", f"{round(float(row['bodies_share']) * int(row['bodies']))} of {row['bodies']}", source)
    row, source = own(now, "best-coordination")
    value("one-simulation-all", f"{round(float(row['bodies_together']) * int(row['bodies']))} of {row['bodies']}", source)

    verdicts = {id: own(now, id)[0]["verdict"] for id in published}
    for verdict in VERDICTS:
        value(verdict.replace(" ", "-"), list(verdicts.values()).count(verdict), f"{CONFIRMATION}/*/claims.csv")
    says("two claims cannot be tested", list(verdicts.values()).count("not testable") == 2)
    wanted = {id: verdict for verdict in VERDICTS[:2] for id in expected[verdict.replace(" ", "_")]}
    differ = [id for id, verdict in wanted.items() if verdicts[id] != verdict]
    value("judged", len(wanted), f"{CONFIRMATION}/*/claims.csv")
    value("as-expected", len(wanted) - len(differ), f"{CONFIRMATION}/*/claims.csv")
    flag("all-as-expected", not differ)
    for id in ["baseline-tree", "number-of-parts", "ari-unknown-number", "ari-worse-with-joints", "first-dimension"]:
        flag(id, verdicts[id] == "reproduced")
    for id in ["tree-high-dimensions", "best-dimension", "best-coordination", "tree-random-movement", "tree-depends-on-coordination"]:
        flag(id, verdicts[id] == "reproduced")

    def take(name, id, words):
        row, source = own(now, id)
        says(f"{id} has a value", row["value"])
        value(name, words(row) if row["value"] else "none", source)

    take("prim", "baseline-tree", lambda row: percent(row["value"]))
    take("prim-n", "baseline-tree", lambda row: thousands(row["n"]))
    take("parts-worst", "number-of-parts", lambda row: f"{float(row['value']):.2f}")
    take("parts-worst-where", "number-of-parts", where)
    take("ari-lowest", "ari-unknown-number", lambda row: f"{float(row['value']):.2f}")
    take("ari-p", "ari-over-coordination", lambda row: f"{float(row['value']):.2f}")
    take("first-dimension", "first-dimension", lambda row: f"{float(row['value']):.0f}")
    take("high-worst", "tree-high-dimensions", lambda row: percent(row["value"]))
    take("high-worst-where", "tree-high-dimensions", where)
    take("best-dimension", "best-dimension", lambda row: f"{float(row['value']):.0f}")
    take("best-p", "best-coordination", lambda row: f"{float(row['value']):g}")
    take("p-value", "tree-depends-on-coordination", lambda row: shown(row["value"], "p-value"))
    return now


def where(row):
    """The d that decides a claim over several."""
    return row["found"].removeprefix("worst: d = ").split(";")[0]


def rates(source, key):
    """Tree accuracy of DPGMM-LJ over one axis of a figure."""
    return {
        float(row[key]): row
        for row in table(source)
        if row["counting"] == ALL and row["method"] == "dpgmm-lj" and row["value"]
    }


def dimensions():
    source = f"{CONFIRMATION}/exp1/fig10b-tree.csv"
    found = {d: float(row["value"]) for d, row in rates(source, "dimension").items()}
    for d in [5, 9, 14]:
        value(f"tree-d{d}", percent(found[d], 0), source)
    says("the tree accuracy rises from d = 5 to d = 9 and to d = 14", found[5] < found[9] < found[14])
    parts = f"{CONFIRMATION}/exp1/fig07-parts.csv"
    means = {int(row["dimension"]): float(row["mean"]) for row in table(parts) if row["counting"] == ALL}
    value("parts-d14", f"{means[14]:.1f}", parts)
    flag("parts-but-two", all(5 <= mean <= 6 for d, mean in means.items() if d != 2))


def coordinations(now):
    source = f"{now['folders']['exp2']}/fig11b-tree.csv"
    rows = rates(source, "coordination")
    found = {p: float(row["value"]) for p, row in rows.items()}
    small = [rate for p, rate in found.items() if p <= 0.4]
    value("small-p", percents(min(small), max(small), 0), source)
    best = max(found, key=found.get)
    value("best-p-tree", percent(rows[best]["value"]), source)
    flag("best-p-near", best in [0.8, 0.95])
    flag("small-p-lower", max(small) < found[0.9])


# ---- The search


def search():
    source = "docs/shown/searches.csv"
    rounds = table(source)
    two_way = [row for row in rounds if row["coupling"] == "two-way"]
    tried, pushed = (sum(int(row["new"]) for row in some) for some in [rounds, two_way])
    value("tried", thousands(tried), source)
    value("tried-one-way", thousands(tried - pushed), source)
    value("tried-two-way", thousands(pushed), source)
    *earlier, scales, last = two_way
    value("search-simulations", scales["simulations"], source)
    value("whole", scales["all"], source)
    as_many = [row for row in earlier if row["simulations"] == scales["simulations"]]
    says("with as many simulations, none before had all", as_many and all(row["all"] == "0" for row in as_many))
    value("last-simulations", last["simulations"], source)
    value("last-tried", last["configurations"], source)
    value("scored", last["scored"], source)
    value("winner-held", last["reproduced"], source)
    says("with more simulations none has all, and the winner all but one", last["all"] == "0" and int(last["reproduced"]) == int(last["scored"]) - 1)
    value("collapsed-tree", percent(former_default("5", EQUATIONS)["value"]), FORMER)
    # Of single configurations, whose tables are history: these numbers do not change any more.
    source = "docs/shown/fluid-pairwise/credits.csv at revision e9468f1"
    value("winner-tree", "85.0 %", source)
    value("winner-parts", "6.2", source)
    source = "docs/shown/fluid-wide/scores.csv at revision e9468f1"
    value("rings-7", "57 of 751", source)
    value("rings-14", "0 of 381", source)


# ---- The multiverse analysis


def multiverse(published):
    folder = "docs/shown/multiverse"
    source = "reproduce/multiverse.toml"
    draws = tomllib.loads(read(source))["draws"]
    planned = draws["movements"]
    value("movements-planned", planned, source)
    value("universes-planned", thousands(planned * draws["distances"] * draws["maps"] * draws["inferences"]), source)
    source = f"{folder}/shares.csv"
    shares = {(row["part"], row["group"], row["claim"]): row for row in table(source)}
    own = lambda claim, group="all": shares["multiverse", group, claim]
    movements = int(own("number-of-parts")["movements"])
    value("movements", movements, source)
    flag("multiverse-complete", movements == planned)
    headline = own("tree-accuracy")
    value("universes", thousands(headline["n"]), source)
    value("universes-judged", thousands(headline["judged"]), source)
    value("universes-hold", thousands(headline["holds"]), source)
    value("universes-resolved", thousands(own("tree-accuracy", "resolved")["n"]), source)
    value("resolved-judged", thousands(own("tree-accuracy", "resolved")["judged"]), source)
    value("resolved-share", share(own("tree-accuracy", "resolved")), source)
    names = {"tree": "tree-accuracy", "d": "dependence on d", "p": "dependence on p", "parts": "number-of-parts", "ari": "ari-over-coordination"}
    for name, claim in names.items():
        value(f"share-{name}", share(own(claim)), source)
    source = f"{folder}/distribution.csv"
    [rates] = table(source)
    for name in ["below", "zero", "above"]:
        value(f"rates-{name}", rates[name], source)
    source = f"{folder}/near.csv"
    near = next(row for row in table(source) if row["least"] == "0" and row["claim"] == "tree-accuracy")
    says("the nearest replications differ in at most two choices", near["most"] == "2")
    value("near", near["n"], source)
    value("near-judged", near["judged"], source)
    value("near-share", share(near), source)
    source = f"{folder}/questions.csv"
    questions = table(source)
    answers = [name for name in questions[0] if name not in ("factor", "all") and not name.endswith(("_low", "_high"))]
    value("answers-count", len(answers), source)
    asked = lambda row: QUESTIONS.get(row["factor"], f"the {row['factor']}")
    for key, name in ANSWERS.items():
        certain = [row for row in questions if float(row.get(f"{name}_low", 0)) > 0]
        first = sorted(certain, key=lambda row: -float(row[name]))[:3]
        named = [f"{asked(row)}, {share(row, name, f'{name}_low', f'{name}_high', 1)}" for row in first]
        value(f"asked-{key}", "; ".join(named) or "none yet", source)
    for at, row in enumerate(questions[:3], 1):
        value(f"question-{at}", asked(row), source)
        value(f"question-{at}-share", share(row, "all", "all_low", "all_high"), source)


# What the tables call answers and settings; the latter in the words of the article.
ANSWERS = {
    "judged": "whether a tree can be judged", "headline": "the headline", "d": "dependence on d", "p": "dependence on p", "parts": "parts",
}
QUESTIONS = {
    "reading": "whether the equations or the authors' code made the figures", "start of a chain": "how a chain starts",
    "sensor layout": "the layout of the sensors", "shape": "the shape of the body", "parts": "the size of the parts",
    "fluid": "whether the fluid pushes back", "scaling": "the kind of scaling", "what is scaled": "what is scaled",
    "targets of a joint's axes": "whether both axes of a joint share a target",
}


def share(row, middle="share", low="low", high="high", digits=0):
    """A share with its interval."""
    middle, low, high = (f"{100 * float(row[key]):.{digits}f}" for key in (middle, low, high))
    return f"{middle} % ({low} to {high})"


# ---- Fluid coupling, departures of the authors' code, time step


def fluid():
    rows = compared(ABLATION)
    dry = "no fluid pushes"
    eligible = int(rows[dry, "tree-accuracy"]["n"])
    # The mean number of parts is over all samples of one condition.
    samples = int(rows[dry, "number-of-parts"]["n"])
    value("dry-eligible", f"{eligible} of {samples}", ABLATION)
    says("with one-way coupling hardly any sample is eligible", eligible < tables.HARDLY * samples)
    small = {name: rows[name, "tree-random-movement"] for name in ["equations", dry]}
    value("dry-small", percent(small[dry]["value"]), ABLATION)
    value("wet-small", percent(small["equations"]["value"]), ABLATION)
    says("with one-way coupling the tree is recovered without coordination", float(small[dry]["low"]) > 0.9)
    drift = rows["no angular momentum of the engine", "tree-accuracy"]
    value("drift-change", points(drift["change"], 1), ABLATION)
    says("the drift changes nothing that could be told", float(drift["change_low"]) < 0 < float(drift["change_high"]))

    rows = compared(MOMENTUM)
    engine, conserved, silent = "as the engine leaves it", "conserved", "conserved, and rest is no touch"
    for name, configuration in {"engine": engine, "conserved": conserved}.items():
        value(f"{name}-tree", percent(rows[configuration, "tree-accuracy"]["value"]), MOMENTUM)
        value(f"{name}-small", percent(rows[configuration, "tree-random-movement"]["value"]), MOMENTUM)
    value("conserved-n", rows[conserved, "tree-accuracy"]["n"], MOMENTUM)
    value("silent-ari", f"{float(rows[silent, 'ari-over-coordination']['value']):.2f}", MOMENTUM)
    value("engine-ari", f"{float(rows[engine, 'ari-over-coordination']['value']):.2f}", MOMENTUM)
    says("without the drift no tree is recovered at p = 0.9", all(float(rows[name, "tree-accuracy"]["value"]) == 0 for name in [conserved, silent]))
    says("with rest as no touch nearly no sample is eligible", int(rows[silent, "tree-accuracy"]["n"]) < 10)


def departures():
    rows = compared(ABLATION)
    names = list(dict.fromkeys(name for name, _ in rows))
    eight = names[names.index("none of the eight") + 1 : names.index("all eight")]
    tree = {name: rows[name, "tree-accuracy"] for name in names}
    says("there are eight departures", len(eight) == int(values["departures"][0]) == 8)
    says("without its departures the code is the equations", all(rows["none of the eight", id]["value"] == row["value"] for (name, id), row in rows.items() if name == "equations"))
    root = tree["tree from component 0"]
    value("root-change", points(-float(root["change"])), ABLATION)
    says("with the tree from component 0 it falls", float(root["change_high"]) < 0)
    says("with one alone no sample is eligible", [name for name in eight if not tree[name]["value"]] == ["means by the inverse scale"])
    small = [name for name in eight if tree[name]["change"] and abs(float(tree[name]["change"])) < 0.05]
    says("the six others change it by less than five points", len(small) == 6)
    value("inverse-parts", f'{float(rows["means by the inverse scale", "number-of-parts"]["value"]):.1f}', ABLATION)
    value("code-parts", f'{float(rows["and its map", "number-of-parts"]["value"]):.1f}', ABLATION)


def step():
    rows = compared(STEP)
    chains = {name: tomllib.loads(read(f"reproduce/{name}.toml"))["settings"]["schema"]["chains"] for name in ["step", "ablation", "momentum"]}
    for name in ["step", "ablation"]:
        value(f"{name}-chains", chains[name], f"reproduce/{name}.toml")
    says("ablation and momentum have as many chains", chains["ablation"] == chains["momentum"])
    value("step-tree", percent(rows["default", "tree-accuracy"]["value"]), STEP)
    value("step-tree-half", percent(rows["half the step", "tree-accuracy"]["value"]), STEP)
    changes = [row for (name, _), row in rows.items() if name == "half the step" and row["change"]]
    within = [row["claim"] for row in changes if float(row["change_low"]) <= 0 <= float(row["change_high"])]
    value("step-claims", len(changes), STEP)
    says("half the step changes no scored claim by more than its interval", len(within) == len(changes))


# ---- Beside the replication


def besides(before):
    source = "docs/shown/mixing/bodies-chains.csv.gz"
    rows = [row for row in table(source) if row["sweeps"] == values["authors-sweeps"][0]]
    for d in [6, 14]:
        exact = [row["exact"] == "true" for row in rows if row["dimension"] == str(d)]
        value(f"mixed-d{d}", percent(sum(exact) / len(exact), 0), source)

    source = "docs/shown/bodies/recordings.csv"
    rows = table(source)
    groups = {}
    for row in rows:
        groups.setdefault((row["coordination"], row["samples"], row["noise"]), []).append(row["dpgmm_lj_right"] == "true")
    value("shapes", len({row["body"] for row in rows}), source)
    value("shapes-most", percent(max(sum(right) / len(right) for right in groups.values())), source)
    paper = [row for row in rows if row["body"] == "paper"]
    value("shapes-paper", f"{sum(row['dpgmm_lj_right'] == 'true' for row in paper)} of {len(paper)}", source)
    says("the most probable sample never has five parts on the paper's body", all(row["dpgmm_lj_parts"] != "5" for row in paper))

    # The same samples, of which another one of those that tie was taken.
    for experiment in ["exp1", "exp2"]:
        row, source = before["apart"][experiment]["tree-accuracy", EQUATIONS, BEST]
        value(f"tied-{experiment}", percent(row["value"]), source)
    one, two = (before["apart"][name]["tree-accuracy", EQUATIONS, ALL][0] for name in ["exp1", "exp2"])
    says("both experiments have the same samples at p = 0.9 and d = 14", one == two)


# ---- The file


def written(rows):
    quote = lambda text: '"' + text.replace("\\", "\\\\").replace('"', '\\"') + '"'
    lines = ["# Made by article/values.py from the committed results. Do not edit.", ""]
    for name, (text, source) in sorted(values.items()):
        lines.append(f"{name} = {{ text = {quote(text)}, from = {quote(source)} }}")
    lines += ["", "# What holds, by which content.typ chooses its words.", "[holds]"]
    lines += [f"{name} = {str(true).lower()}" for name, true in sorted(holds.items())]
    for name, some in rows.items():
        for row in some:
            lines += ["", f"[[table.{name}]]", *(f"{key} = {quote(text)}" for key, text in row.items())]
    return "\n".join(lines) + "\n"


main()
