"""Whatever NumPy calls an array gives the same result, or one clear line says why not."""

from dataclasses import replace

import numpy as np
import pytest
from conftest import same

import bodyschema
from bodyschema import _bodyschema


def unaligned(array):
    raw = np.empty(array.nbytes + 1, dtype=np.uint8)[1:]
    other = raw.view(array.dtype).reshape(array.shape)
    other[...] = array
    assert not other.flags.aligned
    return other


class Wrapped:
    def __init__(self, array):
        self.array = array

    def __array__(self, dtype=None, copy=None):
        return self.array


@pytest.mark.parametrize(
    "form",
    [
        np.ascontiguousarray,
        np.asfortranarray,
        lambda x: np.repeat(x, 2, axis=1)[:, ::2],
        lambda x: np.repeat(x, 3, axis=0)[::3],
        lambda x: x[::-1, ::-1].copy()[::-1, ::-1],
        lambda x: x.astype(">f4"),
        lambda x: x.astype(np.float64),
        lambda x: x.astype(np.float64).T.copy().T,
        lambda x: x.astype(np.longdouble),
        lambda x: x.astype(object),
        lambda x: x.tolist(),
        lambda x: np.broadcast_to(x[:, None], (len(x), 2, x.shape[1]))[:, 1],
        lambda x: np.ma.masked_invalid(x),
        unaligned,
        Wrapped,
    ],
)
def test_any_form_of_the_same_numbers_gives_the_same(moved, found, form):
    touch = form(moved.touch)
    assert same(bodyschema.estimate(touch, interval=moved.interval), found)


def test_a_read_only_file_in_memory_will_do(moved, found, tmp_path):
    np.save(tmp_path / "touch.npy", moved.touch)
    touch = np.load(tmp_path / "touch.npy", mmap_mode="r")
    assert same(bodyschema.estimate(touch, interval=moved.interval), found)


def test_integers_truth_values_and_half_precision_are_numbers(moved):
    raw = np.round(moved.touch * 1000)
    expected = bodyschema.quantise(raw)
    for dtype in [np.int32, np.int64, np.uint32, ">i4", np.float16]:
        assert same(bodyschema.quantise(raw.clip(0, 2000).astype(dtype)), bodyschema.quantise(raw.clip(0, 2000).astype(dtype).astype("f4")))
    assert same(bodyschema.quantise(raw.astype(np.int64)), expected)
    pads = moved.touch > 0.1
    with pytest.warns(bodyschema.RecordingWarning, match="does not fit"):
        expected = bodyschema.estimate(pads.astype(np.float32))
    with pytest.warns(bodyschema.RecordingWarning, match="does not fit"):
        assert same(bodyschema.estimate(pads), expected)


@pytest.mark.parametrize("order", ["C", "F"])
@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_an_array_is_neither_copied_nor_changed(moved, monkeypatch, order, dtype):
    touch = np.array(moved.touch, order=order, dtype=dtype)
    touch[3, 5] = np.nan
    before = touch.copy()
    taken = []

    def spy(array, *rest, inner=_bodyschema.estimate):
        taken.append(array)
        return inner(array, *rest)

    monkeypatch.setattr(_bodyschema, "estimate", spy)
    with pytest.warns(bodyschema.RecordingWarning, match="^1 values are missing of the sensors that are used"):
        bodyschema.estimate(touch)
    assert taken[0] is touch or np.shares_memory(taken[0], touch)
    assert same(touch, before)


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_infinite_values_are_missing_and_counted(moved, dtype):
    touch = moved.touch.astype(dtype)
    touch[3, 5] = np.inf
    with pytest.warns(bodyschema.RecordingWarning, match="^1 values are infinite, and count as missing"):
        bodyschema.estimate(touch)


def test_masked_values_are_missing(moved):
    touch = np.ma.array(moved.touch, mask=np.zeros(moved.touch.shape, dtype=bool))
    touch[:, 4] = np.ma.masked
    with pytest.warns(bodyschema.RecordingWarning):
        found = bodyschema.estimate(touch)
    assert found.dropped == {4: "missing"} and found.parts[4] == -1 and np.isnan(found.residuals[4])


@pytest.mark.parametrize(
    ("touch", "message"),
    [
        (3.0, "two dimensions"),
        (np.zeros(5), "two dimensions"),
        (np.zeros((2, 3, 4)), "two dimensions"),
        (np.zeros((0, 20)), "empty"),
        (np.zeros((20, 0)), "empty"),
        ([], "two dimensions"),
        ([[1.0, 2.0], [3.0]], "not a table"),
        ([["a", "b"]], "real numbers"),
        (np.zeros((5, 20), dtype=complex), "real numbers"),
        (np.zeros((5, 20), dtype="datetime64[s]"), "real numbers"),
        (np.array([[object()]]), "real numbers"),
        (None, "two dimensions"),
        (np.zeros((5, 20)), "0 of 20 sensors feel anything usable"),
        (np.full((5, 20), np.nan), "0 of 20 sensors"),
        (np.eye(11)[::-1], "11 of 11 sensors feel anything usable, but estimating parts needs at least 12"),
        (np.zeros((2, 20_001), dtype=np.float32), "is it transposed"),
        (np.arange(600.0).reshape(30, 20), "column 0 of touch rises with every row"),
    ],
)
@pytest.mark.filterwarnings("ignore::bodyschema.RecordingWarning")
def test_what_is_no_recording_is_refused_in_a_line(touch, message):
    with pytest.raises(ValueError, match=message) as error:
        bodyschema.estimate(touch)
    assert "\n" not in str(error.value)
    assert type(error.value) is ValueError


def test_what_does_not_fit_the_memory_is_refused():
    for dtype in [np.float32, np.float64]:
        huge = np.broadcast_to(np.zeros(1, dtype=dtype), (10**11, 100))
        with pytest.raises(MemoryError, match="does not fit the memory"):
            bodyschema._bodyschema.estimate(huge, (None, False), (1, {}), (0, False), 1, None)
        with pytest.raises(MemoryError, match="does not fit the memory"):
            bodyschema._bodyschema.quantise(huge, "", 1)
    with pytest.raises(MemoryError, match="does not fit the memory"):
        bodyschema.information_metric(np.broadcast_to(np.uint8(1), (10**12, 100)))


@pytest.mark.filterwarnings("ignore::bodyschema.RecordingWarning")
@pytest.mark.parametrize("samples", [1, 2, 3, 5, 8, 60])
@pytest.mark.parametrize("sensors", [12, 25])
def test_nonsense_never_ends_in_a_mistake_of_ours(samples, sensors):
    rng = np.random.default_rng(samples * sensors)
    forms = [
        rng.normal(size=(samples, sensors)),
        rng.exponential(size=(samples, sensors)) * rng.integers(2, size=(samples, sensors)),
        rng.choice([1e-45, 1e38, 0.0, -1e38], size=(samples, sensors)),
        np.where(rng.random((samples, sensors)) < 0.1, np.nan, rng.random((samples, sensors))),
        np.tile(rng.random((samples, 1)) - 0.5, sensors),
        rng.integers(2, size=(samples, sensors)),
    ]
    for at, touch in enumerate(forms):
        try:
            found = bodyschema.estimate(touch, signed=[None, False][at % 2], force=True)
        except ValueError as error:
            assert "feel anything usable" in str(error)
        else:
            assert len(found.tree) + 1 == len(found.labels) and str(found) and found._repr_html_()
        try:
            joints = bodyschema.estimate_tree(touch, np.arange(sensors) % 5 - 1, rank=[None, 1, 6][at % 3])
        except ValueError as error:
            assert "no sensor that has a part" in str(error)
        else:
            assert len(joints.tree) + 1 == len(joints.labels) and str(joints)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"interval": 0}, "interval"),
        ({"interval": float("nan")}, "interval"),
        ({"signed": "yes"}, "signed"),
        ({"keep_saturated": "yes"}, "keep_saturated"),
        ({"parameters": 7}, "parameters must be a mapping"),
        ({"parameters": {"samples": "many"}}, "samples"),
        ({"parameters": {"samples": 0}}, "parameter `samples` is 0, but must be a whole number from 15"),
        ({"parameters": {"size": 3}}, "no parameter is called `size`"),
        ({"random_state": -1}, "random_state"),
        ({"random_state": 2**64}, "random_state"),
        ({"random_state": "1"}, "random_state"),
        ({"repeats": -1}, "repeats"),
        ({"repeats": 1001}, "repeats"),
        ({"n_jobs": 0}, "n_jobs"),
        ({"n_jobs": 5000}, "n_jobs"),
        ({"progress": 7}, "progress"),
    ],
)
def test_wrong_arguments_are_named(moved, arguments, message):
    with pytest.raises(ValueError, match=message):
        bodyschema.estimate(moved.touch, **arguments)


def test_a_path_that_leads_nowhere_is_named(tmp_path):
    with pytest.raises(FileNotFoundError, match="nowhere.csv"):
        bodyschema.estimate(tmp_path / "nowhere.csv")
    (tmp_path / "words.csv").write_text("a,b\nx,y\n")
    with pytest.raises(ValueError, match="words.csv: row 2, column 1"):
        bodyschema.estimate(tmp_path / "words.csv")


@pytest.mark.filterwarnings("ignore::bodyschema.RecordingWarning")
def test_negative_values_count_or_do_not(moved):
    touch = (moved.touch - np.roll(moved.touch, 1, axis=1))[:300]
    assert bodyschema.estimate(touch, signed=True).signed
    unsigned = bodyschema.estimate(touch, signed=False)
    assert not unsigned.signed
    # The results also hold what was said.
    assert same(unsigned, replace(bodyschema.estimate(np.maximum(touch, 0)), given_signed=False))
    assert same(replace(bodyschema.estimate(touch), given_signed=True), bodyschema.estimate(touch, signed=True))
    # Fewer than the data need to tell it: all stages go by what is said.
    few = np.where(touch < 0, touch / 1000, touch)
    told, forced = bodyschema.estimate(few), bodyschema.estimate(few, signed=True)
    assert (told.signed, forced.signed) == (False, True)
    assert not same(told.residuals, forced.residuals) and not same(told.distances, forced.distances)
    joints = [bodyschema.estimate_tree(few, moved.parts, signed=signed) for signed in [None, False, True]]
    assert same(joints[0], bodyschema.estimate_tree(few, moved.parts)) and not same(joints[0], joints[2])
    assert same(joints[1], bodyschema.estimate_tree(np.maximum(few, 0), moved.parts))


@pytest.mark.parametrize("touch", [np.full((3, 4), -1.0), np.array([[1.0, np.nan]]), np.array([[np.inf]])])
def test_stages_of_the_paper_want_pressures(touch):
    with pytest.raises(ValueError, match=r"touch\[0, .\] is .*must be a finite number and not negative"):
        bodyschema.quantise(touch)


def test_symbols_distances_points_and_labels_are_checked():
    with pytest.raises(ValueError, match="quantise makes them"):
        bodyschema.information_metric([[0.5]])
    with pytest.raises(ValueError, match="quantise makes them"):
        bodyschema.information_metric([[np.nan]])
    with pytest.raises(ValueError, match="`quantise.levels` is 300"):
        bodyschema.quantise([[1.0]], levels=300)
    with pytest.raises(ValueError, match="unknown variant `x`"):
        bodyschema.quantise([[1.0]], scheme="x")
    for distances, message in [
        ([[0.0, 1.0]], "square"),
        ([[0.0, 1.0], [2.0, 0.0]], "symmetric"),
        ([[1.0]], "diagonal"),
        ([[0.0, -1.0], [-1.0, 0.0]], "negative"),
        ([[0.0, np.nan], [np.nan, 0.0]], "finite"),
        ([[0.0, 0.0], [0.0, 0.0]], "nothing to map"),
        ([[0.0, 1e200], [1e200, 0.0]], "too large"),
    ]:
        with pytest.raises(ValueError, match=message):
            bodyschema.body_map(distances, 1)
    with pytest.raises(ValueError, match="ask for at most 1"):
        bodyschema.body_map([[0.0, 1.0], [1.0, 0.0]], 2)
    for points, message in [([[1.0], [1.0]], "span fewer"), ([[np.inf], [1.0]], "finite"), ([[1e300], [-1e300], [0.0]], "too large")]:
        with pytest.raises(ValueError, match=message):
            bodyschema.dpgmm_lj(points, n_chains=1, n_sweeps=1)
    with pytest.raises(ValueError, match="unknown setting `schema.speed`"):
        bodyschema.dpgmm_lj([[1.0], [2.0]], settings={"schema": {"speed": 1}})
    with pytest.raises(ValueError, match="one for each sensor"):
        bodyschema.score([0, 1], [], [0], [])
    with pytest.raises(ValueError, match="parts has 1 entries, but touch has 2 sensors"):
        bodyschema.estimate_tree([[1.0, 2.0]], [0])
    with pytest.raises(ValueError, match="no sensor that has a part feels anything"):
        bodyschema.estimate_tree([[1.0, 2.0], [0.0, 0.0]], [-1, -1])


def test_bodies_and_settings_are_checked(tmp_path):
    assert len(bodyschema.BODIES) == 15 and "star" in bodyschema.BODIES
    for arguments, message in [
        ({"body": "nobody"}, "'nobody' is neither a file nor one of arm, "),
        ({"body": 3}, "name of bodyschema.BODIES"),
        ({"duration": 0.0}, "`physics.duration` is 0"),
        ({"duration": float("nan")}, "duration must be a finite number"),
        ({"duration": 1e12}, "`physics.duration` is"),
        ({"coordination": 2}, "`motion.coordination` is 2"),
        ({"settings": {"motion": {"speed": 3}}}, "unknown setting `motion.speed`"),
        ({"settings": {"motion": 3}}, "must be a mapping"),
        ({"settings": {"experiment": {"seed": 3}}}, "random_state is the seed"),
        ({"settings": {"motion": {"epoch": None}}}, "motion.epoch must be a number"),
        ({"settings": {'a"]\n[b': {"x": 1}}}, "unknown setting"),
    ]:
        with pytest.raises(ValueError, match=message):
            bodyschema.simulate(**{"duration": 1.0, **arguments})
    (tmp_path / "body.toml").write_text("[[part]]\n")
    with pytest.raises(ValueError, match="body.toml: line 1"):
        bodyschema.simulate(tmp_path / "body.toml")
