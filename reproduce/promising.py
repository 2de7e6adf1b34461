#!/usr/bin/env python3
"""Does any configuration do it all? The most promising ones: reproduce/promising.py [FOLDER] [--out FILE]

Reads what `reproduce/multiverse.sh gather` wrote into FOLDER (default: results/multiverse/gathered). Writes a design of the ten
configurations that should reproduce the paper's claims best, by a surrogate of the score: reproduce/promising.toml, which
reproduce/promising.sh runs. Needs Python 3.11 and the packages of python/requirements.txt. Status: 0, or 2 on an error.
"""

import argparse
import pathlib
import sys

try:
    import tomllib

    import numpy as np
    from replications import MEANING, Part, default, overrides, settings
    from surrogate import OVERRIDDEN, Chosen
except ModuleNotFoundError as missing:
    sys.exit(f"promising: needs Python 3.11 or newer; and {missing.name}: pip install -r python/requirements.txt")

from estimated import ROOT, fail, flat

SEED = 6700000
COUNT = 10
# The climbs begin at this many random configurations, and at the best of those that ran.
STARTS = 200
BEST = 50
# In so many choices, at least, one that is taken differs from the default, and from all that were taken before.
APART = 3


def main():
    parser = argparse.ArgumentParser(description="Write a design of the most promising configurations.")
    parser.add_argument("folder", nargs="?", type=pathlib.Path, default=ROOT / "results" / "multiverse" / "gathered")
    parser.add_argument("--out", type=pathlib.Path, default=ROOT / "reproduce" / "promising.toml")
    arguments = parser.parse_args()
    parts = [Part(arguments.folder / name) for name in ("multiverse", "multiverse-near", "multiverse-held-out")]
    if not len(parts[0]):
        fail(f"{arguments.folder}: has no multiverse; run reproduce/multiverse.sh gather first")
    whole, near, held_out = (part.literal() for part in parts)
    fitted = [part for part in (whole, near) if len(part)]
    codes = np.concatenate([part.codes for part in fitted])
    values = np.concatenate([scores(part) for part in fitted])
    # Movements of the two parts are different ones.
    movements = np.concatenate([1000 * at + part.movements for at, part in enumerate(fitted)])
    chosen = Chosen(codes, values, movements, SEED)
    space = Space(whole)
    starts = [*space.drawn(STARTS), space.usual, *codes[np.argsort(-values)[:BEST]]]
    looked_at = np.unique(np.concatenate([space.climb(start, chosen.surrogate) for start in starts]), axis=0)
    predicted = chosen.surrogate.predict(looked_at)
    taken = []
    for at in np.argsort(-predicted, kind="stable"):
        others = [space.usual, *(looked_at[other] for other in taken)]
        if len(taken) < COUNT and all(differing(looked_at[at], other) >= APART for other in others):
            taken.append(at)
    text = design(space, [(looked_at[at], predicted[at]) for at in taken], chosen, len(values))
    arguments.out.write_text(text)
    if len(held_out):
        truth = scores(held_out)
        left = ((truth - chosen.surrogate.predict(held_out.codes)) ** 2).sum() / ((truth - values.mean()) ** 2).sum()
        print(f"on {len(truth)} held-out replications the surrogate explains {100 * (1 - left):.0f} % of the variance of the score")


def differing(codes, other):
    """In how many choices two configurations differ; what another choice overrides is none."""
    return ((codes != other) & (codes != OVERRIDDEN) & (other != OVERRIDDEN)).sum()


def scores(part):
    """The score of each configuration, as a study ranks by it (scored.toml): full credit within the accepted range, falling to 0 at a distance
    of `slack`; none where a claim has no value, or anything of the configuration failed."""
    claims = tomllib.loads((ROOT / "reproduce" / "scored.toml").read_text())["claim"]
    total = np.zeros(len(part))
    for claim in claims:
        values = part.values[claim["id"]]
        low, high = part.accepted[claim["id"]]
        outside = np.maximum(0, np.maximum(low - values, values - high))
        total += claim["weight"] * np.nan_to_num(np.maximum(0, 1 - outside / claim["slack"]))
    failed = np.array([row["failed"] != "0" for row in part.rows])
    return np.where(failed, 0, total / sum(claim["weight"] for claim in claims))


class Space:
    """All configurations of a design, as numbers of options; OVERRIDDEN where another choice decides."""

    def __init__(self, part):
        self.factors = part.design["factor"]
        self.counts = [len(labels) for labels in part.labels]
        self.overrides = overrides(part)
        self.usual = np.array(default(part))
        # By the literal meaning alone, which is the only one that was fitted.
        self.fixed = part.factors.index(MEANING)

    def drawn(self, count):
        random = np.random.default_rng(SEED)
        return [self.cleaned(random.integers(self.counts)) for _ in range(count)]

    def cleaned(self, codes):
        """With an option of each factor, but OVERRIDDEN exactly where another option decides."""
        found = np.where(codes == OVERRIDDEN, self.usual, codes)
        found[self.fixed] = self.usual[self.fixed]
        hidden = [other for at, option in enumerate(found) for other in self.overrides[at][option]]
        found[hidden] = OVERRIDDEN
        return found

    def changes(self, codes):
        """All configurations that differ in one choice, and in what it overrides."""
        for at, count in enumerate(self.counts):
            if at == self.fixed or codes[at] == OVERRIDDEN:
                continue
            for option in range(count):
                if option != codes[at]:
                    changed = codes.copy()
                    changed[at] = option
                    yield self.cleaned(changed)

    def climb(self, codes, surrogate):
        """All configurations that are looked at on the way up, by the best change of one choice at a time."""
        codes = self.cleaned(codes)
        looked_at = [codes[None]]
        reached = surrogate.predict(codes[None])[0]
        while True:
            changed = np.array(list(self.changes(codes)))
            predicted = surrogate.predict(changed)
            looked_at.append(changed)
            best = predicted.argmax()
            if predicted[best] <= reached + 1e-12:
                return np.concatenate(looked_at)
            codes, reached = changed[best], predicted[best]

    def differs(self, codes):
        """The choices that differ from the default's, in words."""
        return [f"{factor['name']} = {factor['option'][code]['label']}"
                for factor, code, usual in zip(self.factors, codes, self.usual) if code not in (usual, OVERRIDDEN)]


def design(space, taken, chosen, fitted):
    lines = [
        "# Does any configuration reproduce all claims? The ten most promising ones: `reproduce/promising.sh`. Written by promising.py.",
        "",
        'title = "The most promising configurations"',
        'about = """',
        "Does any configuration reproduce all scored claims? These are the ten that a surrogate of the multiverse's score holds for the best, with",
        f"today's default first. The surrogate is fitted to {fitted} replications, and explains {100 * (1 - chosen.error):.0f} % of the variance",
        f"of the score in movements that it has not seen. Each differs from the default and from the others in at least {APART} choices. What a surrogate promises for",
        "the best of many is too good: these runs, on a seed that nothing else used, are the answer. If one of them reproduces all scored claims,",
        "it runs once more on a further seed, with settings and sentences registered before, and may become the default. If none does, no",
        'configuration is known that does it all, and this page says which claims trade off."""',
        "# Nothing was chosen by it.",
        "seed = 6730000",
        'sections = ["ranking", "values"]',
        "",
        "[settings]",
        "schema = { chains = 6 }",
        "map = { starts = 2 }",
        "experiment = { simulations = 60, dimensions = [2, 5, 8, 9, 10, 14, 15], coordinations = [0.0, 0.4, 0.8, 0.95] }",
        "",
        "[[configuration]]",
        'name = "default"',
        "settings = {}",
    ]
    for at, (codes, predicted) in enumerate(taken, 1):
        lines += [
            "",
            f"# Predicted score: {predicted:.2f}. Other than the default: {'; '.join(space.differs(codes))}.",
            "[[configuration]]",
            f'name = "candidate {at}"',
            f"settings = {{ {inline(settings(space.factors, codes))} }}",
        ]
    return "\n".join(lines) + "\n"


def inline(settings):
    """Settings by dotted names as the inside of a table in one line."""
    groups = {}
    for key, value in settings.items():
        group, name = key.split(".", 1)
        written = f'"{value}"' if isinstance(value, str) else str(value).lower()
        groups.setdefault(group, []).append(f"{name} = {written}")
    return ", ".join(f"{group} = {{ {', '.join(items)} }}" for group, items in groups.items())


if __name__ == "__main__":
    sys.exit(main())
