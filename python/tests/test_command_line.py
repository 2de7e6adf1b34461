"""The numbers are those of the command line, bit for bit."""

import json
import warnings

import numpy as np
import pytest
from conftest import same

import bodyschema

SEED = 2**63 + 5  # more than a file of settings can have


def table(path):
    return np.genfromtxt(path, delimiter=",", names=True, dtype=None, encoding="utf-8", ndmin=1)


@pytest.fixture(scope="module")
def folder(tmp_path_factory, command, small_body):
    folder = tmp_path_factory.mktemp("simulated")
    (folder / "short.toml").write_text("[motion]\ncoordination = 0.0\n")
    command("simulate", "--body", small_body, "--settings", folder / "short.toml", "--duration", 100, "--seed", 1, "--out", folder)
    return folder


def test_simulate(folder, moved):
    assert same(np.load(folder / "tactile.npy"), moved.touch)
    assert table(folder / "labels.csv")["part"].tolist() == moved.parts.tolist()
    assert [list(row) for row in table(folder / "tree.csv").tolist()] == moved.tree.tolist()


@pytest.mark.parametrize("kind", ["plain", "gaps", "signed", "float64"])
def test_estimate(folder, tmp_path, command, moved, kind):
    touch = moved.touch.copy() if kind == "plain" else moved.touch[:400].copy()
    if kind == "gaps":
        touch[40], touch[:, 3], touch[7, 5] = np.nan, 0, np.inf
    elif kind == "signed":
        touch -= np.roll(touch, 1, axis=1)
    elif kind == "float64":
        touch = touch.astype(np.float64) * np.pi
    np.save(tmp_path / "touch.npy", touch)
    repeats = {"gaps": 2}.get(kind, 0)
    command("estimate", tmp_path / "touch.npy", "--seed", SEED, "--force", "--repeats", repeats, "--out", tmp_path / "found")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", bodyschema.RecordingWarning)
        found = bodyschema.estimate(touch, random_state=SEED, force=True, repeats=repeats)
    summary = json.loads((tmp_path / "found/summary.json").read_text())
    fit = found.fit
    facts = [fit.verdict, fit.cause, fit.explained, fit.novelty, len(found.samples), len(found.labels), found.doubts, found.noisy, found.signed]
    names = ["fit", "cause", "explained", "novelty", "samples", "parts", "doubts", "noisy", "signed"]
    assert [*facts, found.seed] == [summary[name] for name in [*names, "seed"]]
    rows = table(tmp_path / "found/parts.csv")
    own = rows["sensor"]
    assert np.flatnonzero(found.parts >= 0).tolist() == own.tolist()
    assert found.parts[own].tolist() == rows["part"].tolist()
    assert found.residuals[own].tobytes() == rows["residual"].tobytes()
    assert found.next_parts[own].tolist() == rows["next_part"].tolist()
    assert found.next_residuals[own].tobytes() == rows["next_residual"].tobytes()
    if repeats > 0:
        assert found.repeated[own].tobytes() == rows["repeated"].tobytes()
        shares = table(tmp_path / "found/repeats.csv")["repeated"].tolist()
        assert [*found.repeated_parts.tolist(), *found.repeated_joints.tolist()] == shares
    else:
        assert found.repeated is None and found.repeated_parts is None and found.repeated_joints is None
    dropped = table(tmp_path / "found/dropped.csv") if found.dropped else np.empty(0)
    assert list(found.dropped.items()) == dropped.tolist()
    tree = table(tmp_path / "found/tree.csv")
    assert found.tree.tolist() == [[row["child"], row["parent"]] for row in tree]
    assert found.support.tobytes() == tree["support"].tobytes()
    pairs = table(tmp_path / "found/edges.csv")
    assert found.pairs.tolist() == [[row["part"], row["other"]] for row in pairs]
    assert found.pair_correlation.tobytes() == pairs["correlation"].tobytes()
    assert found.pair_information.tobytes() == pairs["information"].tobytes()
    assert found.pair_support.tobytes() == pairs["support"].tobytes()


def test_what_is_said_of_a_recording(folder, tmp_path, command, moved):
    touch = np.minimum(moved.touch, np.quantile(moved.touch[moved.touch > 0], 0.9))[:600]
    touch[touch == 0] = -1e-6 * np.arange(1, 1 + (touch == 0).sum()) / touch.size
    np.save(tmp_path / "touch.npy", touch)
    warned = {}
    for options, arguments in [
        ([], {}),
        (["--keep-saturated"], {"keep_saturated": True}),
        (["--signed", "yes"], {"signed": True}),
        (["--signed", "no", "--keep-saturated"], {"signed": False, "keep_saturated": True}),
    ]:
        command("estimate", tmp_path / "touch.npy", *options, "--force", "--out", tmp_path / "found")
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            found = bodyschema.estimate(tmp_path / "touch.npy", force=True, **arguments)
        warned[bool(arguments.get("keep_saturated"))] = any("keep_saturated=True uses them" in str(one.message) for one in caught)
        summary = json.loads((tmp_path / "found/summary.json").read_text())
        assert (found.signed, summary["saturated"] == 0) == (summary["signed"], "--keep-saturated" in options)
        assert found.signed == (arguments.get("signed") is True)
        rows = table(tmp_path / "found/parts.csv")
        assert found.residuals[rows["sensor"]].tobytes() == rows["residual"].tobytes()
        command("tree", tmp_path / "touch.npy", "--parts", folder / "labels.csv", *options, "--out", tmp_path / "joined")
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", bodyschema.RecordingWarning)
            joints = bodyschema.estimate_tree(touch, moved.parts, **arguments)
        assert joints.pair_correlation.tobytes() == table(tmp_path / "joined/edges.csv")["correlation"].tobytes()
    assert warned == {False: True, True: False}


def test_parameters_are_those_of_the_command_line(folder, tmp_path, command, moved, found):
    options = ["--parameter", "samples=300", "--parameter", "monomial_ridge=0.0005"]
    command("estimate", folder / "tactile.npy", *options, "--out", tmp_path / "found")
    changed = bodyschema.estimate(moved.touch, parameters={"samples": 300, "monomial_ridge": 0.0005})
    summary = json.loads((tmp_path / "found/summary.json").read_text())
    assert changed.parameters == summary["parameters"] == {"samples": 300, "monomial_ridge": 0.0005}
    rows = table(tmp_path / "found/parts.csv")
    assert changed.residuals[rows["sensor"]].tobytes() == rows["residual"].tobytes()
    assert changed.pair_correlation.tobytes() == table(tmp_path / "found/edges.csv")["correlation"].tobytes()
    # Each of the two changes something.
    assert changed.residuals.tobytes() != found.residuals.tobytes()
    other = bodyschema.estimate(moved.touch, parameters={"samples": 300})
    assert other.pair_correlation.tobytes() != changed.pair_correlation.tobytes()


def test_a_file_is_read_as_the_command_line_reads_it(folder, tmp_path, moved, found):
    assert same(bodyschema.estimate(folder / "tactile.npy", interval=moved.interval), found)
    np.savetxt(tmp_path / "touch.csv", moved.touch, delimiter=",", header=",".join(["a"] * moved.touch.shape[1]), comments="", fmt="%.9g")
    assert same(bodyschema.read_touch(tmp_path / "touch.csv"), moved.touch)


def test_a_column_of_times_is_said_and_gives_the_interval(tmp_path, moved, found):
    times = 0.1 * np.arange(len(moved.touch))[:, None]
    names = ",".join(["time", *["a"] * moved.touch.shape[1]])
    np.savetxt(tmp_path / "touch.csv", np.hstack([times, moved.touch]), delimiter=",", header=names, comments="", fmt="%.9g")
    with pytest.warns(bodyschema.RecordingWarning, match="touch.csv: .*time"):
        read = bodyschema.estimate(tmp_path / "touch.csv")
    assert same(read.parts, found.parts) and read.interval == 0.1


def test_the_tree_over_known_parts(folder, tmp_path, command, moved):
    command("tree", folder / "tactile.npy", "--parts", folder / "labels.csv", "--seed", SEED, "--out", tmp_path)
    joints = bodyschema.estimate_tree(moved.touch, moved.parts, random_state=SEED)
    tree, pairs = table(tmp_path / "tree.csv"), table(tmp_path / "edges.csv")
    assert joints.tree.tolist() == [[row["child"], row["parent"]] for row in tree]
    assert joints.support.tobytes() == tree["support"].tobytes()
    assert joints.pair_correlation.tobytes() == pairs["correlation"].tobytes()


def test_the_stages_of_the_paper(folder, tmp_path, command, moved):
    command("distance", folder / "tactile.npy", "--out", tmp_path / "distance.npy")
    distances = bodyschema.information_metric(bodyschema.quantise(moved.touch))
    assert same(np.load(tmp_path / "distance.npy"), distances)
    for method in ["classical", "smacof-random", "nonmetric"]:
        command("map", tmp_path / "distance.npy", "--dims", 3, "--method", method, "--seed", SEED, "--out", tmp_path / "map.npy")
        map_ = bodyschema.body_map(distances, 3, method=method, random_state=SEED)
        assert same(np.load(tmp_path / "map.npy"), map_)
    for model, sampler, run in [
        ("dpgmm-lj", "equations", bodyschema.dpgmm_lj),
        ("dpgmm-lj", "split-merge", bodyschema.dpgmm_lj),
        ("dpgmm", "authors-code", bodyschema.dpgmm),
    ]:
        sizes = ["--chains", 3, "--sweeps", 20, "--burn-in", 5]
        command("infer", tmp_path / "map.npy", "--model", model, "--sampler", sampler, *sizes, "--seed", SEED, "--out", tmp_path / "out")
        settings = {"schema": {"sampler": sampler, "burn_in": 5}}
        posterior = run(map_, n_chains=3, n_sweeps=20, settings=settings, random_state=SEED)
        rows = table(tmp_path / "out/samples.csv")
        assert posterior.log_posterior.tobytes() == rows["log_posterior"].tobytes()
        assert posterior.chain.tolist() == rows["chain"].tolist()
        assert posterior.n_parts.tolist() == rows["parts"].tolist()
        if sampler != "split-merge":  # whose components the command line names after the consensus
            assert same(np.load(tmp_path / "out/assignments.npy"), posterior.labels)
            trees = [[row["child"], row["parent"]] for row in table(tmp_path / "out/trees.csv")]
            assert np.concatenate(posterior.trees).tolist() == trees
