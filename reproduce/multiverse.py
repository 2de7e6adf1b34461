#!/usr/bin/env python3
"""The page of the multiverse: reproduce/multiverse.py [FOLDER] [--out FOLDER]

FOLDER holds what `reproduce/multiverse.sh gather` makes (default: results/multiverse/gathered). Writes into the folder of --out, which
is docs/shown/multiverse: README.md, its tables and pictures, and explorer.html, which predicts what a choice of settings would give.
Needs Python 3.11 and the packages of python/requirements.txt. Takes some minutes. Status: 0, or 2 on an error.
"""

import argparse
import json
import math
import pathlib
import sys
import textwrap
import tomllib

try:
    import matplotlib
    import numpy as np
    from scipy import stats
    from replications import CLAIMS, HEADLINE, MEANING, TOGETHER, Part, default, overrides
    from surrogate import OVERRIDDEN, Chosen, Means, Surrogate, knowing
except ModuleNotFoundError as missing:
    sys.exit(f"multiverse: needs {missing.name}; run: pip install -r python/requirements.txt")

import trade_offs
from estimated import ROOT, fail, wilson, write

SEED = 6700000
PERCENT = {"tree-accuracy", "tree-low-dimensions", "tree-high-dimensions", "tree-random-movement", "baseline-tree"}
# What the authors are to be asked about: each of these answers counts the same, whatever the number of its claims.
ANSWERS = {
    "whether a tree can be judged": [(HEADLINE, "can be judged")],
    "the headline": [(HEADLINE, "value")],
    "dependence on d": [("tree-low-dimensions", "value"), ("tree-high-dimensions", "value")],
    "dependence on p": [("tree-random-movement", "value")],
    "parts": [("number-of-parts", "value"), ("ari-unknown-number", "value"), ("ari-over-coordination", "value")],
}
# Movements of the three parts.
MOVEMENTS = (64, 16, 20)
# Groups of movements that the jackknife leaves out, one after the other.
GROUPS = 16
# Pairs of factors that have an interval and are on the page; and pairs of claims.
PAIRS, CLAIM_PAIRS = 5, 3
# Settings that are named of each answer, at most; and those whose options are on the page: the first ones of each answer about trees.
NAMED, SHOWN = 3, {"whether a tree can be judged": 2, "the headline": 1, "dependence on d": 1, "dependence on p": 1}
# Fewer eligible samples than this give a coarse rate.
FEW = 5
# Numbers of choices that differ from the default, for the table of the surroundings.
DISTANCES = [(0, 2), (3, 5), (6, 8), (9, 99)]


def main():
    parser = argparse.ArgumentParser(description="Make the page of the multiverse.")
    parser.add_argument("folder", nargs="?", type=pathlib.Path, default=ROOT / "results" / "multiverse" / "gathered")
    parser.add_argument("--out", type=pathlib.Path, default=ROOT / "docs" / "shown" / "multiverse")
    arguments = parser.parse_args()
    parts = {name: Part(arguments.folder / name) for name in ("multiverse", "multiverse-near", "multiverse-held-out")}
    if not len(parts["multiverse"]):
        fail(f"{arguments.folder}: has no multiverse; run reproduce/multiverse.sh gather first")
    arguments.out.mkdir(parents=True, exist_ok=True)
    shares = [row for name, part in parts.items() if len(part) for row in shares_of(name, part)]
    same = parts["multiverse"].same_verdicts()
    # From here on by the literal meaning alone, so that no replication counts twice.
    parts = {name: part.literal() for name, part in parts.items()}
    whole, near, held_out = parts.values()
    write(arguments.out / "shares.csv", list(shares[0]), shares)
    chosen = surrogates(whole)
    errors = errors_of(chosen, whole, held_out)
    write(arguments.out / "surrogate.csv", list(errors[0]), errors)
    questions = questions_of(chosen, whole)
    write(arguments.out / "questions.csv", list(questions[0]), questions)
    pairs = pairs_of(chosen, whole)
    write(arguments.out / "pairs.csv", list(pairs[0]), pairs)
    choices = [row for factor in whole.factors if factor != MEANING for row in by_option(whole, factor)]
    write(arguments.out / "choices.csv", list(choices[0]), choices)
    claims = trade_offs.pairs(whole, trade_offs.scored())
    write(arguments.out / "trade-offs.csv", list(claims[0]), claims)
    around = by_distance(near) if len(near) else []
    if around:
        write(arguments.out / "near.csv", list(around[0]), around)
    picture(arguments.out / "shares.svg", [row for row in shares if row["part"] == "multiverse" and row["group"] == "all"])
    curve(arguments.out / "tree-accuracy.svg", whole)
    rates = distribution(whole)
    write(arguments.out / "distribution.csv", list(rates), [rates])
    (arguments.out / "explorer.html").write_text(explorer(chosen, whole))
    (arguments.out / "README.md").write_text(page(parts, shares, same, choices, claims, around, questions, pairs, errors))


# ---- Shares


def share(holds, movements):
    """A share with its 95 % interval over resamples of the movements; never narrower than Wilson's interval for as many trials as there are
    movements."""
    if not len(holds):
        return None, None, None
    random = np.random.default_rng(SEED)
    clusters = [holds[movements == one] for one in np.unique(movements)]
    found = []
    for _ in range(2000):
        drawn = [clusters[at] for at in random.integers(len(clusters), size=len(clusters))]
        found.append(sum(one.sum() for one in drawn) / sum(map(len, drawn)))
    middle = holds.mean()
    low, high = wilson(middle * len(clusters), len(clusters))
    return middle, min(max(0.0, low), np.quantile(found, 0.025)), max(high, np.quantile(found, 0.975))


def row_of(part, keep, claim):
    """In what share of some configurations a claim can be judged, and in what share of these it holds."""
    judged = part.judged[claim] & keep
    holds, movements = part.holds[claim][judged], part.movements[judged]
    middle, low, high = share(holds, movements)
    return {
        "claim": claim, "n": int(keep.sum()), "judged": int(judged.sum()), "movements": len(set(movements)), "holds": int(holds.sum()),
        "share": rounded(middle), "low": rounded(low), "high": rounded(high),
    }


def rounded(value):
    return "" if value is None else f"{value:.4f}"


def shares_of(name, part):
    literal = part.is_literal()
    groups = {"all": literal, "resolved": literal & part.resolved, "ARI of 1.00: rounds to 1.00": ~literal}
    return [{"part": name, "group": group, **row_of(part, keep, claim)}
            for group, keep in groups.items() for claim in [*CLAIMS, *TOGETHER]]


def by_option(part, factor):
    """The shares with each option of a factor."""
    at = part.factors.index(factor)
    options = [*enumerate(part.labels[at]), (OVERRIDDEN, "of the authors' code")]
    return [{"factor": factor, "option": label, **row_of(part, part.codes[:, at] == option, claim)}
            for option, label in options if (part.codes[:, at] == option).any() for claim in [HEADLINE, *TOGETHER]]


def by_distance(part):
    """The shares by the number of choices that differ from the default's."""
    usual = np.array(default(part))
    applies = part.codes != OVERRIDDEN
    differ = ((part.codes != usual) & applies).sum(axis=1)
    return [{"least": least, "most": most, **row_of(part, (least <= differ) & (differ <= most), claim)}
            for least, most in DISTANCES for claim in [HEADLINE, *TOGETHER]]


# ---- The surrogate


def targets(part):
    """What is predicted: of each claim its value where there is one, and whether it can be judged where this differs."""
    for claim in CLAIMS:
        has = ~np.isnan(part.values[claim])
        if part.judged[claim].any() and not part.judged[claim].all() and len(set(part.movements)) >= 4:
            yield claim, "can be judged", np.arange(len(part)), part.judged[claim].astype(float)
        if has.sum() >= 30 and len(set(part.movements[has])) >= 4 and np.ptp(part.values[claim][has]):
            yield claim, "value", np.flatnonzero(has), part.values[claim][has]


def surrogates(part):
    return {(claim, what): (rows, values, Chosen(part.codes[rows], values, part.movements[rows], SEED))
            for claim, what, rows, values in targets(part)}


def errors_of(chosen, part, held_out):
    """How much of the variance the surrogate leaves: in cross-validation over movements, and in the held-out movements."""
    rows = []
    for (claim, what), (own, values, one) in chosen.items():
        row = {"claim": claim, "predicts": what, "n": len(values), "movements": len(set(part.movements[own])),
               "pairs": one.pairs, "penalty": one.penalty, "standard_deviation": f"{values.std():.4f}",
               "left": f"{one.error:.4f}", "left_by_forest": f"{one.forest:.4f}", "half_width_90": f"{one.half_width():.4f}",
               "held_out_n": "", "held_out_left": "", "held_out_inside": ""}
        if len(held_out):
            has = np.full(len(held_out), True) if what == "can be judged" else ~np.isnan(held_out.values[claim])
            truth = (held_out.judged[claim].astype(float) if what == "can be judged" else held_out.values[claim])[has]
            if len(truth) > 1 and np.ptp(truth):
                found = one.surrogate.predict(held_out.codes[has])
                left = ((truth - found) ** 2).sum() / ((truth - values.mean()) ** 2).sum()
                inside = (np.abs(truth - found) <= one.half_width()).mean()
                row |= {"held_out_n": len(truth), "held_out_left": f"{left:.4f}", "held_out_inside": f"{inside:.4f}"}
        rows.append(row)
    return rows


def questions_of(chosen, part):
    """What would narrow the answers most, if it were known: by factor the share of each answer's variance that knowing it would take
    away, the mean over the answers first. Intervals are by the jackknife over groups of movements."""
    groups = groups_of(part)
    asked = asked_of(chosen)

    def shares(keep):
        """By answer, then by factor."""
        return {name: np.mean([taken(part, keep, *one) for one in found], axis=0) for name, found in asked.items()}

    def with_mean(found):
        return {"all": np.mean(list(found.values()), axis=0), **found}

    everything = with_mean(shares(np.full(len(part), True)))
    left_out = [with_mean(shares(groups != one)) for one in sorted(set(groups))]
    rows = []
    for at, factor in enumerate(part.factors):
        row = {"factor": factor}
        for name, found in everything.items():
            row |= ends(name, found[at], [one[name][at] for one in left_out])
        rows.append(row)
    return sorted(rows, key=lambda row: -float(row["all"]))


def pairs_of(chosen, part):
    """By pair of factors the share of each answer's variance that knowing both would take away beyond what each takes away alone, the
    mean over the answers first, from the largest on. The first PAIRS have an interval, as those of `questions_of`."""
    groups, asked, count = groups_of(part), asked_of(chosen), len(part.factors)

    def shares(keep, pairs):
        """By answer, then by pair."""
        return {name: np.mean([together(part, keep, pairs, *one) for one in found], axis=0) for name, found in asked.items()}

    pairs = [(first, second) for first in range(count) for second in range(first + 1, count)]
    found = shares(np.full(len(part), True), pairs)
    mean = np.mean(list(found.values()), axis=0)
    order = np.argsort(-mean, kind="stable")
    largest = [pairs[at] for at in order[:PAIRS]]
    left_out = [np.mean(list(shares(groups != one, largest).values()), axis=0) for one in sorted(set(groups))]
    rows = []
    for place, at in enumerate(order):
        first, second = pairs[at]
        all_answers = {"all": rounded(mean[at]), "all_low": "", "all_high": ""}
        if place < PAIRS:
            all_answers = ends("all", mean[at], [one[place] for one in left_out])
        rows.append({"factor": part.factors[first], "other": part.factors[second], **all_answers,
                     **{name: rounded(own[at]) for name, own in found.items()}})
    return rows


def groups_of(part):
    """The group of movements, for the jackknife, that each configuration is in."""
    movements = np.unique(part.movements)
    return np.searchsorted(movements, part.movements) % min(GROUPS, len(movements))


def asked_of(chosen):
    """The surrogates of each answer; not where they predict no better than the mean, since they then say nothing."""
    asked = {name: [chosen[one] for one in claims if one in chosen and chosen[one][2].error < 1] for name, claims in ANSWERS.items()}
    return {name: found for name, found in asked.items() if found}


def taken(part, keep, rows, values, one):
    """The share of the variance of some values that knowing each factor would take away, by a surrogate of those that are kept."""
    surrogate, codes, overriding, variance = refitted(part, keep, rows, values, one)
    return knowing(surrogate, codes, overriding) / variance


def together(part, keep, pairs, rows, values, one):
    """The same of pairs of factors, beyond what each takes away alone."""
    surrogate, codes, overriding, variance = refitted(part, keep, rows, values, one)
    means = Means(surrogate, codes, overriding)
    return np.array([means.taken_together(*pair) for pair in pairs]) / variance


def refitted(part, keep, rows, values, one):
    """A surrogate of the values that are kept, some of their configurations, the factors that override others, and the variance."""
    own = keep[rows]
    codes = part.codes[rows][own]
    surrogate = Surrogate(codes, values[own], one.pairs, one.penalty)
    some = np.random.default_rng(SEED).permutation(len(codes))[:400]
    overriding = [at for at, own in enumerate(overrides(part)) if any(own)]
    return surrogate, codes[some], overriding, values[own].var()


def ends(name, value, left_out):
    """A value with its 95 % interval by the jackknife, not below 0."""
    count = len(left_out)
    spread = math.sqrt((count - 1) / count * sum((one - np.mean(left_out)) ** 2 for one in left_out))
    half = stats.t.ppf(0.975, count - 1) * spread
    low, high = max(0.0, value - half), value + half
    return {name: rounded(value), f"{name}_low": rounded(low), f"{name}_high": rounded(high)}


def explorer(chosen, part):
    """The page that predicts: the template with the configurations, what they gave, and the weights of the surrogates."""
    published = {claim["id"]: claim for claim in tomllib.loads((ROOT / "reproduce" / "published.toml").read_text())["claim"]}
    data = {
        "factors": [{"name": name, "options": labels} for name, labels in zip(part.factors, part.labels)],
        "default": default(part),
        "overrides": overrides(part),
        "codes": ["".join("-" if code == OVERRIDDEN else str(code) for code in codes) for codes in part.codes],
        "names": [int(row["configuration"]) for row in part.rows],
        "shown": [HEADLINE, "tree-low-dimensions", "tree-high-dimensions", "tree-random-movement"],
        "claims": [
            {
                "id": claim, "name": name, "published": published[claim].get("wording", ""), "percent": claim in PERCENT,
                "accepted": part.accepted[claim], "bounds": [1, None] if claim in ("number-of-parts", "first-dimension") else [0, 1],
                "always": float(part.judged[claim].mean()),
                "values": [None if math.isnan(value) else float(f"{value:.4g}") for value in part.values[claim]],
                "judged": model(chosen.get((claim, "can be judged"))),
                "value": model(chosen.get((claim, "value"))),
            }
            for claim, name in CLAIMS.items()
        ],
    }
    template = (ROOT / "reproduce" / "explorer.html").read_text()
    return template.replace("/* DATA */", json.dumps(data, separators=(",", ":")).replace("<", "\\u003c"))


def model(found):
    if found is None:
        return None
    rows, _, one = found
    return {
        "rows": [int(row) for row in rows], "weights": [float(f"{weight:.4g}") for weight in one.surrogate.weights],
        "constant": float(f"{one.surrogate.constant:.6g}"), "pairs": one.pairs, "half": float(f"{one.half_width():.4g}"),
        "left": float(f"{one.error:.3g}"),
    }


# ---- The page


def picture(file, rows):
    """For each claim the shares of the configurations that cannot judge it, in which it fails, and in which it holds."""
    names = [label(row["claim"]) for row in rows]
    parts = [
        ("holds", "#1b7837", [row["holds"] / row["n"] for row in rows]),
        ("does not hold", "#b2182b", [(row["judged"] - row["holds"]) / row["n"] for row in rows]),
        ("cannot be judged", "#d9d9d9", [1 - row["judged"] / row["n"] for row in rows]),
    ]
    pyplot = plotting()
    figure, axes = pyplot.subplots(figsize=(9, 0.42 * len(rows) + 1), layout="constrained")
    left = np.zeros(len(rows))
    for name, colour, widths in parts:
        axes.barh(names, 100 * np.array(widths), left=left, color=colour, label=name)
        left += 100 * np.array(widths)
    axes.invert_yaxis()
    axes.set(xlim=(0, 100), xlabel=f"share of {rows[0]['n']} replications, %")
    axes.legend(ncols=3, loc="lower center", bbox_to_anchor=(0.4, 1), frameon=False)
    axes.spines[["top", "right"]].set_visible(False)
    figure.savefig(file, metadata={"Date": None})
    pyplot.close(figure)


def curve(file, part):
    """A specification curve (Simonsohn, Simmons and Nelson 2020): all tree accuracies by size, with their intervals, and beneath them the
    choices that they come from."""
    told = np.flatnonzero(~np.isnan(part.values[HEADLINE]))
    told = told[np.argsort(part.values[HEADLINE][told], kind="stable")]
    rates, ends = 100 * part.values[HEADLINE][told], 100 * part.ends[HEADLINE][told]
    options = [(at, option) for at in range(len(part.factors)) if part.factors[at] != MEANING for option in range(len(part.labels[at]))]
    names = [f"{part.factors[at]}: {textwrap.shorten(part.labels[at][option], 40, placeholder=' …')}" for at, option in options]
    pyplot = plotting()
    figure, (above, below) = pyplot.subplots(
        2, figsize=(9, 3 + 0.14 * len(options)), sharex=True, layout="constrained", height_ratios=[3, 0.14 * len(options)])
    places = np.arange(1, len(told) + 1)
    above.axhspan(*(100 * end for end in part.accepted[HEADLINE]), color="#c7e9c0", label="accepted range")
    above.axhline(100 * published_rate()["published"], color="black", linestyle="--", linewidth=1, label="published")
    above.vlines(places, *ends.T, color="#bdbdbd", linewidth=1, label="95 % interval")
    above.plot(places, rates, ".", color="#2166ac", markersize=4, label="tree accuracy")
    above.set(ylabel="tree accuracy, %", ylim=(-3, 103))
    above.legend(ncols=4, loc="lower center", bbox_to_anchor=(0.5, 1), frameon=False)
    for row, (at, option) in enumerate(options):
        own = places[part.codes[told, at] == option]
        below.plot(own, np.full(len(own), row), "|", color="#636363", markersize=5)
    below.set_yticks(range(len(options)), names, fontsize=6)
    below.set(ylim=(len(options) - 0.5, -0.5), xlabel=f"{len(told)} replications with eligible samples, by tree accuracy")
    for axes in (above, below):
        axes.spines[["top", "right"]].set_visible(False)
    figure.savefig(file, metadata={"Date": None})
    pyplot.close(figure)


def plotting():
    """pyplot, for SVG files that are the same each time."""
    matplotlib.use("svg")
    from matplotlib import pyplot

    matplotlib.rcParams |= {"svg.hashsalt": "multiverse", "svg.fonttype": "none", "font.family": "sans-serif"}
    return pyplot


def label(claim):
    return CLAIMS.get(claim, claim)


def percent(value):
    return "–" if value in (None, "") else f"{100 * float(value):.0f} %"


def with_ends(row, name="share", decimals=0):
    """A share in percent with its interval, from columns `name` or, of shares, `low` and `high`."""
    low, high = (("low", "high") if name == "share" else (f"{name}_low", f"{name}_high"))
    if not row[name]:
        return "–"
    middle, low, high = (f"{100 * float(row[key]):.{decimals}f}" for key in (name, low, high))
    return f"{middle} % ({low} to {high})"


def table(header, rows):
    return ["| " + " | ".join(header) + " |", "|" + "---|" * len(header),
            *("| " + " | ".join(str(cell) for cell in row) + " |" for row in rows)]


def page(parts, shares, same, choices, claims, around, questions, pairs, errors):
    whole, near, held_out = parts.values()
    of = {(row["part"], row["group"], row["claim"]): row for row in shares}
    own = lambda claim, group="all": of["multiverse", group, claim]
    headline = own(HEADLINE)
    lines = ["# A multiverse that contains today's default", "", *answer(whole, own, questions)]
    lines += [
        "",
        "![Shares of the claims](shares.svg)",
        "",
        progress(parts),
        "",
        "A replication takes one reasonable value for each setting that the paper leaves open. It is small:",
        "four simulations with six chains each, seven d (2, 5, 8, 9, 10, 14 and 15) and five p (0, 0.4, 0.8, 0.9 and 0.95). \"Each d\" and",
        "\"each p\" are of these, as far as they have an eligible sample. An ARI of 1.00 is taken literally, as exactly 1; with 0.995 and more, all",
        f"verdicts are the same in {same[0]:,} of {same[1]:,} replications. [multiverse.toml](../../../reproduce/multiverse.toml) has all values, and the",
        "reason for each. It was written before the first run. A claim about trees *can be judged* if samples are eligible: right number of",
        "parts, and an adjusted Rand index (ARI) of 1. Intervals are 95 % intervals over resamples of the movements. They are never narrower than",
        "Wilson's for as many trials as there are movements, which decides where a share is 0 or 100 %.",
        "",
        f"The seeds of the movements are {SEED + 1:,} on. Made by:",
        "",
        "    reproduce/multiverse.sh            # runs what is left",
        "    reproduce/multiverse.sh gather",
        "    python3 reproduce/multiverse.py    # this page",
        "",
        "## In what share does each claim hold?",
        "",
        "The last two columns count only replications that can judge the claim; the last one only those whose movements the time step",
        "resolves. A tree that is never found has its best p everywhere, which counts as a tie. So the dependence on p asks for half of the trees",
        "at p = 0.9, too. All groups, and both meanings of an ARI of 1.00: [shares.csv](shares.csv).",
        "",
        *table(["claim", "n", "can be judged", "holds, of those judged", "the same, resolved"],
               [[label(claim), f"{own(claim)['n']:,}", f"{own(claim)['judged']:,} ({percent(own(claim)['judged'] / own(claim)['n'])})",
                 with_ends(own(claim)), with_ends(own(claim, "resolved"))] for claim in [*CLAIMS, *TOGETHER]]),
        "",
        "## What does it depend on?",
        "",
        "These settings have the largest shares of the answers about trees in the [table below](#what-to-ask-the-authors), though some may be 0: the",
        "first two of whether a tree can be judged, and the first one of each other answer. Before each share stands the number of replications",
        "that can judge the claim. All settings: [choices.csv](choices.csv).",
        "",
        *table(["choice", "n", "tree accuracy: judged, holds", *(f"{name}: judged, holds" for name in TOGETHER)],
               by_choice([row for factor in deciding(questions) for row in choices if row["factor"] == factor])),
        "",
        *least_judged(choices),
        "",
        "## Which claims hold together?",
        "",
        *in_one(parts),
        "",
        "These pairs of claims hold together less often than by chance: in how many replications that can judge both each claim holds, and both do.",
        "The last column is in how many both would hold if the claims were independent. The pairs are the first of 45, so part of their distance is",
        "chance, too. All pairs: [trade-offs.csv](trade-offs.csv).",
        "",
        *table(["claim", "other claim", "can judge both", "the one holds", "the other holds", "both hold", "both by chance"],
               [[label(row["claim"]), label(row["other"]), row["judged"], row["holds"], row["other_holds"], row["both"], f"{float(row['expected']):.1f}"]
                for row in claims[:CLAIM_PAIRS]]),
        "",
        "## Where does the published number lie?",
        "",
        *distribution_in_words(whole),
        "",
        "![Specification curve of the tree accuracy](tree-accuracy.svg)",
        "",
        "All replications with eligible samples, by tree accuracy; beneath, a mark for each choice that they have.",
        "",
        "## How far from the default?",
        "",
    ]
    if around:
        lines += [
            f"The {len(near)} replications of [multiverse-near.toml](../../../reproduce/multiverse-near.toml) stay near today's default. They",
            "differ from it in the number of choices in the first column. Shares are as above. All: [near.csv](near.csv).",
            "",
            *table(["choices that differ", "n", "tree accuracy: judged, holds", *(f"{name}: judged, holds" for name in TOGETHER)],
                   by_choice(around, distance_of)),
            "",
            *lost(around),
        ]
    else:
        lines += ["The replications near the default have not been run yet."]
    lines += [
        "",
        "## What to ask the authors",
        "",
        "If the authors told one setting, how much would the answers narrow? The table has the share of the variance that knowing a setting would",
        f"take away (Sobol's first-order index of the surrogate below), and the mean over {len(answers_in(questions))} answers. An answer is left out where the",
        "surrogate predicts no better than the mean. Intervals are by the jackknife over",
        f"{min(GROUPS, len(set(whole.movements)))} groups of movements. The surrogate shrinks what it is unsure of, and intervals do not count that: shares are rather",
        "too small than too large, and \"0 %\" may be \"not told yet\". All: [questions.csv](questions.csv).",
        "",
        *ranking(questions),
        "",
        "What two settings do only together comes on top: the second-order terms of Sobol's decomposition. These pairs have the largest shares of the",
        "variance, as the mean over the answers. All pairs, and each answer: [pairs.csv](pairs.csv).",
        *without_pairs(pairs, answers_in(questions)),
        "",
        *table(["settings", "share"], [[f"{row['factor']}, with {row['other']}", with_ends(row, "all", 1)] for row in pairs[:PAIRS]]),
        "",
        "## The surrogate",
        "",
        "The surrogate predicts a claim's value, or whether it can be judged, from the choices: ridge regression on all single choices and all",
        "pairs ([surrogate.py](../../../reproduce/surrogate.py)). It is tested on movements that it has not seen (cross-validation) and on the",
        "replications of [multiverse-held-out.toml](../../../reproduce/multiverse-held-out.toml), to which nothing is fitted. *Explained* is the",
        "share of the variance; below 0, the mean would predict better. The settings of the surrogate were chosen by the same cross-validation, so its",
        "own numbers are a little too good; those of held-out movements are not. All: [surrogate.csv](surrogate.csv).",
        "",
        *table(["claim", "predicts", "n", "explained", "by a random forest", "held out: n", "held out: explained", "inside its 90 % interval"],
               [[label(row["claim"]), row["predicts"], f"{row['n']:,}", explained(row["left"]), explained(row["left_by_forest"]),
                 row["held_out_n"] or "–", explained(row["held_out_left"]), percent(row["held_out_inside"])] for row in errors]),
        "",
        "[explorer.html](explorer.html) shows what it predicts for any choice, and the nearest replications that were run. It is one file and",
        "needs no network.",
    ]
    return wrapped(lines)


def wrapped(lines):
    """The text, its paragraphs in lines of at most 130 characters."""
    blocks, text = [], []
    for line in [*lines, ""]:
        if line and line[0] not in "#|! -":
            text.append(line)
            continue
        if text:
            blocks.append(textwrap.fill(" ".join(text), 130, break_long_words=False, break_on_hyphens=False))
            text = []
        blocks.append(line)
    return "\n".join(blocks).rstrip() + "\n"


def progress(parts):
    counts = [(len(set(part.movements)) if len(part) else 0, planned) for part, planned in zip(parts.values(), MOVEMENTS)]
    done = [f"{count} of {planned} movements" for count, planned in counts]
    if all(count == planned for count, planned in counts):
        return "All movements of the design are finished."
    return (f"**Not complete.** Finished are {done[0]}, {done[1]} near the default, and {done[2]} held out. They are an even sample of the "
            "design, and most shares should stay within their intervals. What needs many movements to be told, such as the effect of the body's "
            "shape, is uncertain.")


def answer(whole, own, questions):
    """The answer in a paragraph."""
    headline, on_d, on_p = own(HEADLINE), own("dependence on d"), own("dependence on p")
    few = (whole.eligible[whole.judged[HEADLINE]] < FEW).sum()
    lines = [
        f"Of {headline['n']:,} reasonable replications, {headline['judged']:,} ({percent(headline['judged'] / headline['n'])}) can judge the",
        f"published tree accuracy: the others find no sample with the right parts at p = 0.9 and d = 14. It holds in {headline['holds']} of these, "
        f"**{with_ends(headline)}**: the rate lies between 74.6 and 94.6 %. {few} of the {headline['judged']:,} have fewer than {FEW} samples.",
        f"The dependence on d holds in **{with_ends(on_d)}** of the {on_d['judged']:,} that can judge it: no tree at d of 8 and below, and the tree",
        f"at each d from 9 on. The dependence on p holds in **{with_ends(on_p)}** of {on_p['judged']:,}: p = 0.9 is best, with at least half of",
        "the trees right, and at most half at p of 0.4 and below.",
    ]
    lines += deciding_in_words(questions)
    missing = [name for name in ANSWERS if name not in questions[0]]
    if missing:
        lines.append(f"Nothing can be told yet of what decides {' and '.join(missing)}.")
    return lines


def told(questions, answer):
    """The settings that an answer depends on for certain, the most important first."""
    certain = [row for row in questions if float(row[f"{answer}_low"]) > 0]
    return sorted(certain, key=lambda row: -float(row[answer]))


def deciding_in_words(questions):
    """What each answer depends on, as far as that is told, and which question would narrow all of them most."""
    named = lambda row, answer: f"{quoted(row['factor'])} ({with_ends(row, answer, 1)})"
    answers = {answer: [named(row, answer) for row in told(questions, answer)[:NAMED]] for answer in answers_in(questions)}
    lines = ["What do these answers depend on? A share is how much the variance of an answer falls if the setting is known (first-order Sobol index)."]
    lines += [f"For {answer}: {', '.join(names)}." for answer, names in answers.items() if names]
    untold = [answer for answer, names in answers.items() if not names]
    if untold:
        lines.append(f"For {' and '.join(untold)}, nothing is certain yet: every interval reaches 0.")
    first = told(questions, "all")
    if first:
        most = max(answers_in(questions), key=lambda answer: float(first[0][answer]))
        lines.append(f"If the authors answered one question, {quoted(first[0]['factor'])} would narrow the answers most: it takes away "
                     f"{with_ends(first[0], 'all')} of their variance on average, and {with_ends(first[0], most)} of that of {most}.")
    return lines


def deciding(questions):
    """The settings whose options the page shows."""
    found = []
    for answer, count in SHOWN.items():
        if answer in questions[0]:
            found += [row["factor"] for row in sorted(questions, key=lambda row: -float(row[answer]))[:count]]
    return list(dict.fromkeys(found))


def least_judged(choices):
    """The options with which hardly any replication can judge the tree accuracy, in a list."""
    own = [row for row in choices if row["claim"] == HEADLINE and 20 * row["judged"] < row["n"]]
    lines = [f"- {quoted(row['factor'] + ': ' + row['option'])}: {row['judged']} of {row['n']}" for row in own]
    return ["With these options, fewer than one replication in twenty can judge the tree accuracy:", "", *lines] if lines else []


def in_one(parts):
    """How many of the scored claims hold at once, in sentences."""
    claims, lines = trade_offs.scored(), []
    names = dict(zip(parts, ["the replications", "those near the default", "those held out"]))
    for name, part in parts.items():
        if len(part):
            counts = trade_offs.together(part, claims)
            best = (counts == counts.max()).sum()
            lines.append(f"Of {names[name]} ({len(part)}), {best} {'has' if best == 1 else 'have'} {counts.max()} of the {len(claims)} scored claims "
                         "at once, and none has more.")
    return lines


def answers_in(questions):
    return [name for name in ANSWERS if name in questions[0]]


def quoted(factor):
    return f"*{factor}*"


def by_choice(rows, name=lambda row: f"{row['factor']}: {row['option']}"):
    found = {}
    for row in rows:
        found.setdefault(name(row), {})[row["claim"]] = row
    return [[key, f"{own[HEADLINE]['n']:,}", *(f"{one['judged']}, {with_ends(one)}" if one["judged"] else "0" for one in own.values())]
            for key, own in found.items()]


def without_pairs(pairs, answers):
    """Which answers have surrogates without pairs, in a sentence."""
    names = [name for name in answers if not any(float(row[name]) for row in pairs)]
    return [f"Cross-validation chose a surrogate without pairs for {' and '.join(names)}, so their shares are 0."] if names else []


def lost(around):
    """At which distances it can be told whether a claim holds in more or less than half of the replications that can judge it."""
    lines, untold = [], []
    for claim in [HEADLINE, *TOGETHER]:
        own = [row for row in around if row["claim"] == claim and row["judged"]]
        name = "headline" if claim == HEADLINE else claim
        more, less = ([distance_of(row) for row in own if told(row)] for told in
                      (lambda row: float(row["low"]) > 0.5, lambda row: float(row["high"]) < 0.5))
        for found, size in ((more, "more"), (less, "less")):
            if found:
                lines.append(f"With {', '.join(found)} such choices, the {name} holds in {size} than half of the replications that can judge it.")
        if not more and not less:
            untold.append(f"the {name}")
    if untold:
        lines.append(f"So few movements do not tell at any distance whether these hold in more or less than half of the replications: {', '.join(untold)}.")
    return lines


def distance_of(row):
    return f"{row['least']} to {row['most']}" if row["most"] < 99 else f"{row['least']} and more"


def distribution(part):
    """How many tree accuracies are where, and their quartiles; a row of distribution.csv."""
    rates = part.values[HEADLINE]
    found = rates[~np.isnan(rates)]
    low, high = part.accepted[HEADLINE]
    published = published_rate()["published"]
    ends_low, ends_high = part.ends[HEADLINE][~np.isnan(rates)].T
    quartiles = np.quantile(found, [0.25, 0.5, 0.75]) if len(found) else ["", "", ""]
    return {
        "n": len(found), "zero": (found == 0).sum(), "below": (found < low).sum(), "within": ((low <= found) & (found <= high)).sum(),
        "above": (found > high).sum(), "below_published": (found < published).sum(),
        "interval_has_published": ((ends_low <= published) & (published <= ends_high)).sum(),
        **dict(zip(["lower_quartile", "median", "upper_quartile"], quartiles)),
    }


def published_rate():
    claims = tomllib.loads((ROOT / "reproduce" / "published.toml").read_text())["claim"]
    return next(claim for claim in claims if claim["id"] == HEADLINE)


def distribution_in_words(part):
    own = distribution(part)
    if not own["n"]:
        return ["No replication has a tree accuracy yet."]
    of_all = lambda name: percent(own[name] / own["n"])
    return [
        f"Of the {own['n']:,} replications with a tree accuracy, {of_all('below')} are below the accepted range ({of_all('zero')} at 0), ",
        f"{of_all('within')} within it, and {of_all('above')} above. {of_all('below_published')} are below the published "
        f"{published_rate()['wording']}. The median is {percent(own['median'])}, and the middle half lies between "
        f"{percent(own['lower_quartile'])} and {percent(own['upper_quartile'])}.",
        f"The intervals of {own['interval_has_published']:,} contain the published number; with four simulations each, they are wide.",
    ]


def ranking(questions):
    names = ["all", *answers_in(questions)]
    return table(["setting", *names], [[row["factor"], *(with_ends(row, name) for name in names)] for row in questions])


def explained(left):
    return "–" if left == "" else f"{100 * (1 - float(left)):.0f} %"


if __name__ == "__main__":
    sys.exit(main())
