"""Files are read as the command line reads them; what is guessed or wrong is said with the names of arguments."""

import re
import subprocess
import warnings

import numpy as np
import pytest
from conftest import BINARY, same

import bodyschema

# Of 40 rows: two sensors that are 0 on every other row.
VALUES = np.array([[0.5 * (t % 2), 1.5 * ((t + 1) % 2)] for t in range(40)], dtype=np.float32)


def text_of(rows, separator=",", decimal=".", names=""):
    lines = [separator.join(f"{value:g}".replace(".", decimal) for value in row) for row in rows]
    return "\n".join([names, *lines] if names else lines) + "\n"


def read(path, **arguments):
    """What is read, and what is guessed."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        touch = bodyschema.read_touch(path, **arguments)
    assert all(warning.category is bodyschema.RecordingWarning and warning.filename == __file__ for warning in caught)
    return touch, [str(warning.message).removeprefix(f"{path}: ") for warning in caught]


@pytest.mark.parametrize("separator", [",", ";", "\t", " "])
@pytest.mark.parametrize("decimal", [".", ","])
def test_separators_and_decimals_are_guessed_or_said(tmp_path, separator, decimal):
    if separator == decimal:
        return
    path = tmp_path / "touch.csv"
    path.write_text(text_of(VALUES, separator, decimal))
    touch, guesses = read(path)
    assert same(touch, np.asfortranarray(VALUES))
    is_usual = (separator, decimal) == (",", ".")
    assert [guess.endswith("; separator and decimal say otherwise") for guess in guesses] == ([] if is_usual else [True])
    touch, guesses = read(path, separator=separator, decimal=decimal, header=False, time=False)
    assert same(touch, np.asfortranarray(VALUES)) and guesses == []


def test_columns_that_are_no_sensors(tmp_path):
    path = tmp_path / "touch.csv"
    times = 0.1 * np.arange(40)
    rows = np.column_stack([times, np.full(40, 7), VALUES])
    path.write_text(text_of(rows, names="clock,2,a,b"))
    touch, guesses = read(path)
    assert touch.shape == (40, 3)
    assert guesses == ["column 1 (`clock`) is taken for the time by its name, and is no sensor (interval 0.1 s); time=False counts it as one"]
    assert read(path, time=False, header=True)[0].shape == (40, 4)
    for time in ["clock", "CLOCK", 1]:
        touch, guesses = read(path, time=time, leave_out=["2"])
        assert same(touch, np.asfortranarray(VALUES)) and guesses == []
    assert read(path, time=1, leave_out=(np.int64(3), "b"))[0].tolist() == [[7.0]] * 40
    # A text is a name, also if it is a number.
    path.write_text(text_of(VALUES, names="0,1"))
    first, second = VALUES[:, :1], VALUES[:, 1:]
    for leave_out, left in [(["0"], second), ([1], second), (["1"], first), ([2], first)]:
        assert same(read(path, header=True, leave_out=leave_out)[0], np.asfortranarray(left))


def test_rows_and_arrays_are_chosen(tmp_path):
    path = tmp_path / "touch.csv"
    path.write_text("0,1,2\n" + text_of(np.column_stack([VALUES, VALUES[:, 0]])))
    touch, guesses = read(path)
    assert touch.shape == (40, 3)
    assert guesses == ["row 1 counts the columns and is taken for names; header=False counts it as a sample"]
    assert read(path, header=False)[0].shape == (41, 3) and read(path, header=True)[1] == []
    np.savez(tmp_path / "both.npz", left=VALUES, right=2 * VALUES)
    assert same(read(tmp_path / "both.npz", array="right")[0], np.asfortranarray(2 * VALUES))
    (tmp_path / "-").write_text(text_of(VALUES))
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(tmp_path)
        assert same(read("-")[0], np.asfortranarray(VALUES))


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_the_interval_has_no_rounding_errors(tmp_path, moved, dtype):
    times = 0.1 * np.arange(len(moved.touch))[:, None]
    np.save(tmp_path / "touch.npy", np.hstack([times, moved.touch]).astype(dtype))
    with pytest.warns(bodyschema.RecordingWarning, match=r"interval 0\.1 s"):
        assert bodyschema.estimate(tmp_path / "touch.npy").interval == 0.1


MISTAKES = [
    ("1,2\n3,x\n", {}, "row 2, column 2: `x` is not a number; empty the cell if a value is missing, or say leave_out=[2] if", "--leave-out 2"),
    ("12:00:01,1\n12:00:02,2\n", {}, "if it is a time, say time=1", "--time 1"),
    ("1,2\n3;4,5\n5,6\n7,8\n", {}, 'if `;` is between cells, say separator=";"', "--separator semicolon"),
    ("1,2\n3\t4,5\n5,6\n7,8\n", {}, 'if tabs are between cells, say separator="\\t"', "--separator tab"),
    ("1;2\n3;4\n5;6,5\n7;8.5\n", {}, 'if decimals have commas, say decimal=","', "--decimal comma"),
    ("a;b\n1,5;2\n3;4\n5;1.234,5\n", {}, 'if they have points, say decimal="."', "--decimal point"),
    ("1,05,2,75\n3,25,4,00\n", {}, 'say decimal="." if its numbers are whole', "--decimal point"),
    ("a,b\n1,2\n3\n", {}, "say what is between cells with separator", "with --separator"),
    ("1 2\n3 4\n5\n6 7\n", {}, "write nan where a value is missing, or say what is between cells with separator", "with --separator"),
    ("time\n1\n2\n", {}, "if its columns are no times, say time=False", "--time none"),
    ("1,2\n", {"array": "x"}, 'is no .npz archive, so that array="x" means nothing', "--array x"),
    ("1,2\n", {"time": "c"}, "has no column `c`; time takes a name, or a number from 1 on, of its 2 columns", "--time takes"),
    ("1,2\n", {"leave_out": [3]}, "has no column `3`; leave_out takes a name", "--leave-out takes"),
]


@pytest.mark.parametrize(("text", "arguments", "ours", "theirs"), MISTAKES)
def test_a_mistake_is_said_with_the_argument_or_the_option_that_helps(tmp_path, text, arguments, ours, theirs):
    path = tmp_path / "touch.csv"
    path.write_text(text)
    with pytest.raises(ValueError, match=re.escape(ours)) as error:
        read(path, **arguments)
    message = str(error.value)
    assert "\n" not in message and "--" not in message and type(error.value) is ValueError
    if BINARY.exists():
        options = [
            word
            for name, value in arguments.items()
            for word in ["--" + name.replace("_", "-"), ",".join(map(str, value)) if isinstance(value, list) else value]
        ]
        run = [BINARY, "estimate", path, *options, "--out", tmp_path / "out"]
        done = subprocess.run(run, capture_output=True, text=True, check=False)
        assert done.returncode == 2 and theirs in done.stderr, done.stderr


def test_arguments_that_do_not_fit_are_refused_in_a_line(tmp_path):
    path = tmp_path / "touch.csv"
    path.write_text(text_of(VALUES))
    for arguments, message in [
        ({"separator": "|"}, "separator must be one of ',', ';', "),
        ({"decimal": ""}, "decimal must be one of '.', ','"),
        ({"header": "no"}, "header must be True, False or None, but is 'no'"),
        ({"time": True}, "time: a column must be a name or a number from 1 on, but is True"),
        ({"time": 0}, "time: a column must be"),
        ({"leave_out": "a"}, "leave_out must be a sequence"),
        ({"leave_out": [1.5]}, "leave_out: a column must be"),
        ({"array": 1}, "array must be the name of an array"),
    ]:
        with pytest.raises(ValueError, match=re.escape(message)):
            read(path, **arguments)
    np.savez(tmp_path / "both.npz", left=VALUES, right=VALUES)
    with pytest.raises(ValueError, match="holds 2 arrays; say which with array, one of: left, right"):
        read(tmp_path / "both.npz")
