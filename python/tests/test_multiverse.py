"""The page of the multiverse, reproduce/multiverse.py: its surrogate, its intervals, and what its explorer predicts."""

import csv
import gzip
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tomllib

import numpy as np
import pytest

pytest.importorskip("sklearn")
pytest.importorskip("matplotlib")
ROOT = pathlib.Path(__file__).resolve().parents[2]
SHARDS = ROOT / "docs/shown/multiverse/shards"
sys.path.insert(0, str(ROOT / "reproduce"))

import multiverse  # noqa: E402
import promising  # noqa: E402
import replications  # noqa: E402
import surrogate  # noqa: E402
import trade_offs  # noqa: E402


@pytest.fixture(scope="module")
def part(tmp_path_factory):
    """The first shard of the committed ones."""
    folder = tmp_path_factory.mktemp("gathered")
    for file in (SHARDS / "multiverse/movements-01-04").glob("*.gz"):
        (folder / file.stem).write_bytes(gzip.decompress(file.read_bytes()))
    return multiverse.Part(folder).literal()


def made_up(movements, seed):
    """Codes of seven factors, the first two of which are shared within a movement, and values: two factors, one pair, and chance."""
    random = np.random.default_rng(seed)
    shared = np.repeat(random.integers(3, size=(movements, 2)), 12, axis=0)
    codes = np.concatenate([shared, random.integers(3, size=(12 * movements, 5))], axis=1)
    exact = 2.0 * (codes[:, 2] == 1) + 1.0 * codes[:, 0] + 2.0 * ((codes[:, 3] == 0) & (codes[:, 4] == 2))
    return codes, exact, exact + random.normal(0, 0.3, len(codes)), np.repeat(np.arange(movements), 12)


def test_the_surrogate_predicts_movements_that_it_has_not_seen():
    codes, _, values, movements = made_up(40, 1)
    found = surrogate.Chosen(codes, values, movements, 0)
    other, exact, _, _ = made_up(40, 2)
    left = ((exact - found.surrogate.predict(other)) ** 2).mean() / exact.var()
    assert left < 0.05 and found.pairs > 0, "it has the pair"
    inside = (np.abs(made_up(40, 2)[2] - found.surrogate.predict(other)) <= found.half_width()).mean()
    assert 0.85 < inside < 0.95


def test_the_surrogate_finds_nothing_in_chance():
    codes, _, values, movements = made_up(40, 3)
    shuffled = np.random.default_rng(0).permutation(values)
    assert surrogate.Chosen(codes, shuffled, movements, 0).error > 0.95


def test_knowing_a_factor_takes_away_its_share_of_the_variance():
    codes, exact, values, _ = made_up(200, 4)
    fitted = surrogate.Surrogate(codes, values, 0.5, 0.1)
    # Variances of the means: of an indicator of 1/3 times 2, of 0, 1, 2, and half of the pair's, for each of its factors.
    expected = [2 / 3, 0, 4 * 2 / 9, 4 / 9 * 2 / 9, 4 / 9 * 2 / 9, 0, 0]
    assert surrogate.knowing(fitted, codes[::4]) == pytest.approx(expected, abs=0.04)


def test_what_two_factors_do_only_together_is_told_of_them_alone():
    codes, exact, values, _ = made_up(200, 4)
    means = surrogate.Means(surrogate.Surrogate(codes, values, 0.5, 0.1), codes[::4])
    # Of a product of two indicators of 1/3, times 2.
    assert means.taken_together(3, 4) == pytest.approx(4 * (2 / 9) ** 2, abs=0.04)
    others = [means.taken_together(first, second) for first in range(7) for second in range(first + 1, 7) if (first, second) != (3, 4)]
    assert max(others) < 0.02


def test_knowing_a_factor_that_overrides_another_counts_what_goes_with_it():
    """With its option 1, the next factor has no choice, and the value is 1 more on average."""
    random = np.random.default_rng(6)
    codes = random.integers(2, size=(400, 3))
    values = np.where(codes[:, 0] == 1, 2.0, 1.0 * codes[:, 1])
    codes[codes[:, 0] == 1, 1] = surrogate.OVERRIDDEN
    fitted = surrogate.Surrogate(codes, values, 0.5, 0.1)
    expected = [0.25 * 1.5**2, 0.5 * 0.25, 0]
    assert surrogate.knowing(fitted, codes, overriding=[0]) == pytest.approx(expected, abs=0.05)


def test_an_overridden_choice_agrees_with_nothing():
    none = surrogate.OVERRIDDEN
    assert surrogate.kernel(np.array([[none, 1]]), np.array([[none, 1], [0, 1]]), 0.0).tolist() == [[0.5, 0.5]]


def test_intervals_of_shares_hold_the_truth():
    """Movements differ, so an interval as of independent configurations would be far too narrow."""
    random = np.random.default_rng(5)
    inside = 0
    for _ in range(60):
        rates = random.beta(1, 2, size=30)
        holds = random.random((30, 8)) < rates[:, None]
        _, low, high = multiverse.share(holds.ravel(), np.repeat(np.arange(30), 8))
        inside += low <= 1 / 3 <= high
        assert high - low < 0.45, "no wider than that of 17 independent trials"
    assert inside >= 52, "with 95 %, it is less in one of 100 runs"
    assert multiverse.share(np.zeros(8, bool), np.arange(8))[2] > 0.3, "none of eight is not zero"


def test_the_default_is_a_point_of_the_space(part):
    chosen = {name: labels[at] for name, labels, at in zip(part.factors, part.labels, multiverse.default(part))}
    assert chosen["fluid"] == "pushes back, 1010" and chosen["prior scatter"] == "0.5 x covariance / K^(2/d)"
    assert chosen["sweeps"] == "300" and chosen["number of levels"] == "8" and chosen["controller"] == "slow servo"


def test_the_authors_code_overrides_the_prior(part):
    reading = part.factors.index("reading")
    equations, code, _ = multiverse.overrides(part)[reading]
    assert equations == [] and part.factors.index("prior scatter") in code and part.factors.index("fluid") not in code
    rows = part.codes[part.codes[:, reading] == 1]
    assert len(rows) and (rows[:, code] == surrogate.OVERRIDDEN).all()


def test_the_score_of_a_replication_is_the_mean_of_its_credits(part):
    """By hand, of the first replication that can judge the headline."""
    at = int(np.flatnonzero(part.judged["tree-accuracy"])[0])
    claims = tomllib.loads((ROOT / "reproduce/scored.toml").read_text())["claim"]
    credits = []
    for claim in claims:
        value, (low, high) = part.values[claim["id"]][at], part.accepted[claim["id"]]
        distance = max(0, low - value, value - high)
        credits.append(0 if np.isnan(value) else claim["weight"] * max(0, 1 - distance / claim["slack"]))
    found = promising.scores(part)
    assert found[at] == pytest.approx(sum(credits) / sum(claim["weight"] for claim in claims))
    assert found[np.isnan(part.values["number-of-parts"])].sum() == 0 and 0 <= found.min() < found.max() <= 1


def test_settings_are_those_that_ran(part):
    """Also stiffness and damping of a torque, and what a reading overrides."""
    torques = 0
    for row, codes in zip(part.rows, part.codes):
        # What every replication has, in addition to its options.
        usual = dict(replications.flat(part.design["settings"]))
        found = usual | replications.settings(part.design["factor"], codes)
        ran = dict(one.split(" = ", 1) for one in re.split(r", (?=[a-z]+\.[a-z_]+ = )", row["settings"]))
        written = {key: str(value).lower() if isinstance(value, bool) else str(value) for key, value in found.items()}
        for key in written.keys() & ran.keys():
            same = written[key] == ran[key] or float(written[key]) == pytest.approx(float(ran[key]), rel=1e-12)
            assert same, f"{key}: {written[key]}, not {ran[key]}"
        assert set(ran) <= set(written), set(ran) - set(written)
        torques += ran.get("motion.controller") == "torque"
    assert torques > 0


def test_a_climb_ends_where_no_change_of_a_choice_predicts_more(part):
    chosen = surrogate.Chosen(part.codes, promising.scores(part), part.movements, 0).surrogate
    space = promising.Space(part)
    assert (space.cleaned(part.codes[0]) == part.codes[0]).all(), "a replication is a configuration of the space"
    looked_at = space.climb(part.codes[0], chosen)
    predicted = chosen.predict(looked_at)
    top = looked_at[predicted.argmax()]
    assert predicted.max() > predicted[0]
    assert chosen.predict(np.array(list(space.changes(top)))).max() <= predicted.max() + 1e-9
    # What an option overrides has no choice, and what nothing overrides has one.
    hidden = [other for at, option in enumerate(top) for other in space.overrides[at][option]]
    assert set(np.flatnonzero(top == surrogate.OVERRIDDEN)) == set(hidden)


def test_the_design_of_the_most_promising_has_the_default_and_each_of_them(part):
    chosen = surrogate.Chosen(part.codes, promising.scores(part), part.movements, 0)
    space = promising.Space(part)
    design = tomllib.loads(promising.design(space, [(part.codes[0], 0.5), (part.codes[1], 0.4)], chosen, len(part)))
    names = {one["name"]: one["settings"] for one in design["configuration"]}
    assert list(names) == ["default", "candidate 1", "candidate 2"] and names["default"] == {}
    written = dict(replications.flat(names["candidate 1"]))
    assert written == replications.settings(space.factors, part.codes[0])
    assert 0.8 in design["settings"]["experiment"]["coordinations"] and 15 in design["settings"]["experiment"]["dimensions"]


def test_claims_that_exclude_each_other_fall_short_of_chance():
    made = type("Made", (), {})()
    made.judged = {name: np.array([True] * 6 + [False] * 2) for name in "abc"}
    made.holds = {name: np.array(list(holds)) == "1" for name, holds in {"a": "11100011", "b": "00011111", "c": "10110100"}.items()}
    assert trade_offs.together(made, "abc").tolist() == [2, 1, 2, 2, 1, 2, 0, 0]
    first, *_, last = trade_offs.pairs(made, "abc")
    assert first == {"claim": "a", "other": "b", "judged": 6, "holds": 3, "other_holds": 3, "both": 0, "expected": "1.50"}
    assert float(last["expected"]) == 2 == last["both"]


def test_the_explorer_predicts_what_the_surrogate_predicts(part, tmp_path):
    if not shutil.which("chromium"):
        assert not os.environ.get("CI"), "chromium is missing"
        pytest.skip("chromium is missing")
    chosen = multiverse.surrogates(part)
    text = multiverse.explorer(chosen, part)
    (tmp_path / "explorer.html").write_text(text)
    command = ["chromium", "--headless", "--no-sandbox", "--disable-dev-shm-usage", f"--user-data-dir={tmp_path / 'chromium'}",
               "--dump-dom", (tmp_path / "explorer.html").as_uri()]
    seen = subprocess.run(command, capture_output=True, text=True, check=True, timeout=120).stdout
    body = re.search(r'<tbody id="predicted">(.*?)</tbody>', seen, re.S)[1]
    rows = [re.findall(r"<t[hd][^>]*>(.*?)</t[hd]>", row) for row in body.split("</tr>") if row]
    assert [row[0] for row in rows] == list(multiverse.CLAIMS.values())
    usual = np.array([multiverse.default(part)])
    parts = rows[list(multiverse.CLAIMS).index("number-of-parts")]
    _, _, fitted = chosen["number-of-parts", "value"]
    # Its weights have four digits.
    assert float(parts[2].split()[0]) == pytest.approx(fitted.surrogate.predict(usual)[0], abs=0.02)
    judged = float(rows[0][1].removesuffix(" %"))
    _, _, fitted = chosen["tree-accuracy", "can be judged"]
    assert judged == pytest.approx(100 * fitted.surrogate.predict(usual)[0].clip(0, 1), abs=1)


def test_the_page_is_of_the_committed_shards():
    """Whoever adds a shard makes the page again."""
    shares = SHARDS.parent / "shares.csv"
    groups = ("all", "ARI of 1.00: rounds to 1.00")
    rows = [row for row in csv.DictReader(shares.open()) if row["group"] in groups and row["claim"] == "tree-accuracy"]
    counted = {name: sum(int(row["n"]) for row in rows if row["part"] == name) for name in {row["part"] for row in rows}}
    for name in ("multiverse", "multiverse-near", "multiverse-held-out"):
        tables = sorted((SHARDS / name).glob("*/configurations.csv.gz"))
        assert counted.get(name, 0) == sum(len(list(csv.DictReader(gzip.open(table, "rt")))) for table in tables), name
    data = json.loads(re.search(r"const data = (.*);\n", (SHARDS.parent / "explorer.html").read_text())[1])
    assert len(data["codes"]) == counted["multiverse"] // 2
