"""What a result says, and what its documentation promises."""

import doctest
import html.parser
import importlib
import inspect

import numpy as np
import pytest

import bodyschema


def test_three_lines_give_parts_and_tree(moved, tmp_path):
    np.savetxt(tmp_path / "recording.csv", moved.touch, delimiter=",", fmt="%.9g")
    found = bodyschema.estimate(tmp_path / "recording.csv")
    assert bodyschema.score(found.parts, found.tree, moved.parts, moved.tree) == bodyschema.Score(1.0, True, True)
    lines = str(found).splitlines()
    assert lines[0].startswith("fit: good: rigid motions explain ")
    assert lines[1] == f"3 parts of {len(moved.parts)} sensors over 1000 samples"
    assert all(f"─ {100 * support:.0f} % ─ part" in str(found) for support in found.support) and len(lines) == 6
    assert (found.support > 0.95).all(), found.support
    assert repr(found) == f"<Estimate: 3 parts of {len(moved.parts)} sensors, fit: good>"


def test_the_arrays_are_of_the_shapes_that_are_promised(moved, found):
    sensors = moved.touch.shape[1]
    for name, shape, dtype in [
        ("parts", (sensors,), np.int64),
        ("residuals", (sensors,), np.float64),
        ("next_parts", (sensors,), np.int64),
        ("next_residuals", (sensors,), np.float64),
        ("labels", (3,), np.int64),
        ("ranks", (3,), np.int64),
        ("tree", (2, 2), np.int64),
        ("support", (2,), np.float64),
        ("pairs", (3, 2), np.int64),
        ("pair_correlation", (3,), np.float64),
        ("pair_information", (3,), np.float64),
        ("pair_support", (3,), np.float64),
        ("samples", (1000,), np.int64),
        ("mapped", (sensors,), np.int64),
        ("distances", (sensors, sensors), np.float64),
    ]:
        array = getattr(found, name)
        assert (array.shape, array.dtype) == (shape, dtype), name
    assert (found.interval, found.seed, found.signed, found.noisy) == (0.1, bodyschema.SEED, False, 0)
    assert found.sensors_of(0).tolist() == np.flatnonzero(found.parts == 0).tolist()


def test_networkx_has_the_tree(found):
    networkx = pytest.importorskip("networkx")
    graph = found.to_networkx()
    assert networkx.is_tree(graph) and sorted(graph) == found.labels.tolist()
    assert sorted(sensor for part in graph for sensor in graph.nodes[part]["sensors"]) == list(range(len(found.parts)))
    for (child, parent), support in zip(found.tree.tolist(), found.support.tolist()):
        assert graph.edges[child, parent]["support"] == support
        assert 0 < graph.edges[child, parent]["correlation"] <= 1
        assert graph.edges[child, parent]["information"] > 0


class Checker(html.parser.HTMLParser):
    def __init__(self):
        super().__init__()
        self.open, self.seen = [], []

    def handle_starttag(self, tag, attributes):
        self.seen.append(tag)
        if tag != "br":
            self.open.append(tag)

    def handle_endtag(self, tag):
        assert self.open.pop() == tag


def test_a_notebook_shows_a_picture(found):
    page = found._repr_html_()
    checker = Checker()
    checker.feed(page)
    assert checker.open == [] and checker.seen.count("svg") == 2
    assert checker.seen.count("circle") == len(found.mapped) + 3 and checker.seen.count("line") == 2
    assert "<script" not in page and "http://" not in page.replace("http://www.w3.org/2000/svg", "")


def test_what_does_not_fit_has_no_tree_unless_it_is_forced(moved):
    pads = (moved.touch > 0.1).astype(np.float32)
    with pytest.warns(bodyschema.RecordingWarning, match="does not fit: .*contact pads.*no tree is given"):
        found = bodyschema.estimate(pads)
    assert found.tree.shape == (0, 2) and found.support.shape == (0,) and "no tree is shown" in str(found)
    assert "No tree is shown" in found._repr_html_()
    with pytest.raises(ValueError, match="there is no tree"):
        found.to_networkx()
    with pytest.warns(bodyschema.RecordingWarning, match="parts and tree mean nothing"):
        forced = bodyschema.estimate(pads, force=True)
    assert len(forced.tree) + 1 == len(forced.labels) and forced.parts.tolist() == found.parts.tolist()


def test_warnings_name_the_line_of_the_caller(moved):
    touch = moved.touch.copy()
    touch[:, 0] = 0
    touch[5] = np.nan
    with pytest.warns(bodyschema.RecordingWarning) as told:
        bodyschema.estimate(touch)
    assert [str(one.message) for one in told] == [
        "1 samples are left out, because most sensors have no value there",
        f"1 of {touch.shape[1]} sensors are left out (the first, 0, is dead); see dropped",
    ]
    assert all(one.filename == __file__ for one in told)


def test_generators_give_seeds():
    seeds = [
        bodyschema.simulate("star", duration=1, random_state=state).seed
        for state in [None, 7, np.int64(7), np.random.RandomState(7), np.random.default_rng(7)]
    ]
    assert seeds[:3] == [bodyschema.SEED, 7, 7] and len(set(seeds)) == 4
    again = bodyschema.simulate("star", duration=1, random_state=np.random.default_rng(7))
    assert again.seed == seeds[4]


MODULES = ["", "._estimate", "._joints", "._simulate", "._stages", "._schema", ".cluster"]


@pytest.mark.parametrize("name", MODULES)
def test_examples_in_docstrings_are_right(name):
    if name == ".cluster":
        pytest.importorskip("sklearn")
    failed, _ = doctest.testmod(importlib.import_module(f"bodyschema{name}"))
    assert failed == 0


@pytest.mark.parametrize("name", [name for name in bodyschema.__all__ if inspect.isfunction(getattr(bodyschema, name))])
def test_every_function_documents_parameters_results_and_errors(name):
    function = getattr(bodyschema, name)
    text = inspect.getdoc(function)
    if name == "dpgmm":
        assert "are those\nof `dpgmm_lj`" in text
        return
    for section in ["Parameters", "Returns", "Raises"]:
        assert f"\n{section}\n{'-' * len(section)}\n" in text, section
    for parameter in inspect.signature(function).parameters:
        assert parameter in text.split("Returns\n")[0], parameter
