"""The replications of a multiverse, as `reproduce/multiverse.sh gather` writes them: multiverse.py and promising.py read them."""

import copy
import math
import tomllib

import numpy as np
from estimated import ROOT, flat, read
from surrogate import OVERRIDDEN

HEADLINE = "tree-accuracy"
# The factor that says which samples are eligible.
MEANING = "ARI of 1.00"
# What is said of several claims together: the two sides of the dependence on d, and of that on p.
TOGETHER = {
    "dependence on d": ["tree-low-dimensions", "tree-high-dimensions"],
    "dependence on p": ["tree-random-movement", "best-coordination"],
}
# A tie counts as the best p, so that a tree that is never found would be found best everywhere. The dependence on p needs this tree accuracy
# at p = 0.9, too: the half that the claims about d take for "recovered".
RECOVERED = 0.5
# In the order of the page.
CLAIMS = {
    "tree-accuracy": "the headline: tree accuracy at p = 0.9, d = 14",
    "tree-low-dimensions": "no tree at d of 8 and below",
    "tree-high-dimensions": "the tree at each d from 9 on",
    "first-dimension": "the tree from about d = 9 on",
    "tree-random-movement": "no tree at p of 0.4 and below",
    "best-coordination": "p = 0.9 is best (a tie counts)",
    "baseline-tree": "DPGMM + Prim never finds the tree",
    "number-of-parts": "slightly more than five parts at each d",
    "ari-unknown-number": "ARI above 0.8 at each d",
    "ari-over-coordination": "ARI above 0.8 at each p but 1",
}


class Part:
    """The configurations of one design, and what each gave: arrays with one entry for each, in the order of their numbers."""

    def __init__(self, folder):
        self.factors, self.rows, self.movements = [], [], np.array([])
        if not (folder / "design.toml").is_file():
            return
        self.design = tomllib.loads((folder / "design.toml").read_text())
        self.factors = [factor["name"] for factor in self.design["factor"]]
        self.labels = [[option["label"] for option in factor["option"]] for factor in self.design["factor"]]
        self.rows = read(folder / "configurations.csv")
        self.movements = np.array([int(row["movement"]) for row in self.rows])
        self.resolved = np.array([row["resolved"] == "true" for row in self.rows])
        self.codes = np.array([[self.code(at, row[factor]) for at, factor in enumerate(self.factors)] for row in self.rows])
        self.values, self.holds, self.judged, self.ends, self.accepted = {}, {}, {}, {}, {}
        claims = read(folder / "study.csv")
        for claim in CLAIMS:
            own = [row for row in claims if row["claim"] == claim]
            self.values[claim] = np.array([float(row["value"] or "nan") for row in own])
            self.judged[claim] = np.array([row["verdict"] != "not testable" for row in own])
            self.holds[claim] = np.array([row["verdict"] == "reproduced" for row in own])
            self.ends[claim] = np.array([[float(row[end] or "nan") for end in ("low", "high")] for row in own])
            self.accepted[claim] = (float(own[0]["accepted_low"]), float(own[0]["accepted_high"]))
            if claim == HEADLINE:
                self.eligible = np.array([int(row["n"]) for row in own])
        for name, claims in TOGETHER.items():
            self.judged[name] = np.all([self.judged[claim] for claim in claims], axis=0)
            self.holds[name] = np.all([self.holds[claim] for claim in claims], axis=0)
        self.holds["dependence on p"] &= self.values[HEADLINE] >= RECOVERED

    def is_literal(self):
        """Which configurations take an ARI of 1.00 for exactly 1."""
        at = self.factors.index(MEANING)
        return self.codes[:, at] == self.labels[at].index("exactly 1")

    def literal(self):
        """These configurations only: one for each replication."""
        if not len(self):
            return self
        keep = self.is_literal()
        found = copy.copy(self)
        found.rows = [row for row, kept in zip(self.rows, keep) if kept]
        found.movements, found.resolved, found.codes, found.eligible = (
            own[keep] for own in (self.movements, self.resolved, self.codes, self.eligible))
        found.values, found.holds, found.judged, found.ends = (
            {name: own[keep] for name, own in all_claims.items()} for all_claims in (self.values, self.holds, self.judged, self.ends))
        return found

    def same_verdicts(self):
        """In how many replications both meanings of an ARI of 1.00 give the same verdicts, and in how many there are both."""
        literal = self.is_literal()
        at = self.factors.index(MEANING)
        key = lambda row: (self.movements[row], *np.delete(self.codes[row], at), self.rows[row]["maps"])
        verdicts = lambda row: [(self.judged[claim][row], self.holds[claim][row]) for claim in CLAIMS]
        first = {key(row): verdicts(row) for row in np.flatnonzero(literal)}
        both = [first[key(row)] == verdicts(row) for row in np.flatnonzero(~literal) if key(row) in first]
        return sum(both), len(both)

    def __len__(self):
        return len(self.rows)

    def code(self, at, label):
        return self.labels[at].index(label) if label else OVERRIDDEN


def default(part):
    """The option of each factor that paper.toml has."""
    settings = dict(flat(tomllib.loads((ROOT / "reproduce" / "paper.toml").read_text())))
    found = []
    for factor in part.design["factor"]:
        same = [all(settings[key] == value for key, value in flat(option.get("settings", {}))) and "settings" in option
                for option in factor["option"]]
        found.append(same.index(True))
    return found


def overrides(part):
    """For each factor and option the factors that it overrides."""
    factors = part.design["factor"]
    keys = [[set(key for key, _ in flat(option.get("settings", {}))) for option in factor["option"]] for factor in factors]
    return [[[other for other in range(at) if keys[other][0] and keys[other][0] <= own] for own in options]
            for at, options in enumerate(keys)]


def settings(factors, codes):
    """What a configuration has instead of the default's values, by dotted names: those of its options, later ones over earlier ones, and the
    stiffness and damping of a torque, whose option says what it does to a part (src/study/choices.rs)."""
    found, gains = {}, None
    for factor, code in zip(factors, codes):
        if code != OVERRIDDEN:
            option = factor["option"][code]
            found |= dict(flat(option.get("settings", {})))
            gains = option.get("gains", gains)
    if gains:
        paper = dict(flat(tomllib.loads((ROOT / "reproduce" / "paper.toml").read_text())))
        density, radius, length, step = (
            (paper | found)[key] for key in ["agent.density", "agent.part_radius", "agent.part_length", "physics.step"])
        mass = density * math.pi * radius**2 * length
        stiffness = gains["frequency"] ** 2 * mass * length**2 / 3
        damping = gains["spin_damping"] * mass * radius**2 / 2 / step
        found |= {"motion.controller": "torque", "motion.stiffness": float(f"{stiffness:.2e}"), "motion.damping": float(f"{damping:.2e}")}
    return found
