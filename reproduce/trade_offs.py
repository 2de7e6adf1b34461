"""How many claims one replication reproduces together, and which claims seldom hold together: multiverse.py shows it."""

import itertools
import tomllib

import numpy as np
from estimated import ROOT


def scored():
    """The claims that the default was chosen by."""
    return [claim["id"] for claim in tomllib.loads((ROOT / "reproduce" / "scored.toml").read_text())["claim"]]


def together(part, claims):
    """How many of some claims hold in each replication; one that cannot be judged does not hold."""
    return np.sum([part.holds[claim] & part.judged[claim] for claim in claims], axis=0)


def pairs(part, claims):
    """For each two claims, in how many replications that can judge both each holds, and both do; and in how many both would if neither
    told anything of the other. Those that fall short the most come first."""
    rows = []
    for claim, other in itertools.combinations(claims, 2):
        judged = part.judged[claim] & part.judged[other]
        first, second = part.holds[claim][judged], part.holds[other][judged]
        expected = first.sum() * second.sum() / max(1, judged.sum())
        rows.append({"claim": claim, "other": other, "judged": int(judged.sum()), "holds": int(first.sum()), "other_holds": int(second.sum()),
                     "both": int((first & second).sum()), "expected": f"{expected:.2f}"})
    return sorted(rows, key=lambda row: row["both"] - float(row["expected"]))
