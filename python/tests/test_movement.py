"""Bodies of descriptions, and movements that were recorded, are those of the command line."""

import warnings

import numpy as np
import pytest
from conftest import ROOT, same

import bodyschema

ARMS = ROOT / "tests/data/movement/arms.bvh"
ROBOTS = ROOT / "tests/data/import"


def quietly(call, *arguments, **named):
    """What a call gives, and what it warns of."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        result = call(*arguments, **named)
    assert all(warning.category is bodyschema.BodyWarning for warning in caught)
    assert all(warning.filename == __file__ for warning in caught)
    return result, [str(warning.message) for warning in caught]


@pytest.mark.parametrize(
    ("source", "options", "arguments"),
    [
        (ROBOTS / "arm.urdf", [], {}),
        (ROBOTS / "arm.xml", ["--sensors-per-part", "7", "--strict"], {"sensors_per_part": 7, "strict": True}),
        (ROBOTS / "arm.urdf", ["--per-area", "900.5"], {"per_area": 900.5}),
        (ARMS, [], {}),
        (ARMS, ["--scale", "0.02", "--min-length", "0.3"], {"scale": 0.02, "min_length": 0.3}),
    ],
)
def test_an_imported_body_is_that_of_the_command_line(tmp_path, command, source, options, arguments):
    told = command("body", "import", source, *options, "--out", tmp_path / "theirs.toml")
    out, notes = quietly(bodyschema.import_body, source, tmp_path / "ours.toml", **arguments)
    assert out == tmp_path / "ours.toml"
    assert out.read_bytes() == (tmp_path / "theirs.toml").read_bytes()
    theirs = [line.removeprefix("note: ") for line in told.splitlines() if line.startswith("note: ")]
    assert [note.replace("min_length", "--min-length").replace("with scale", "with --scale") for note in notes] == theirs
    assert bodyschema.simulate(out, duration=1).touch.shape[0] == 10


def test_a_recorded_movement_is_that_of_the_command_line(tmp_path, command):
    body, _ = quietly(bodyschema.import_body, ARMS, str(tmp_path / "body.toml"), sensors_per_part=10)
    (tmp_path / "tenths.toml").write_text("[sense]\ninterval = 0.1\n")
    for options, arguments in [
        ([], {}),
        (["--body", body], {"body": body}),
        (["--duration", "0.5", "--keep-jumps", "--scale", "0.02"], {"duration": 0.5, "keep_jumps": True, "scale": 0.02}),
        (["--duration", "0.05"], {"duration": 0.05}),
        (["--settings", tmp_path / "tenths.toml"], {"settings": {"sense": {"interval": 0.1}}}),
    ]:
        told = command("simulate", "--movement", ARMS, *options, "--out", tmp_path / "moved")
        moved, notes = quietly(bodyschema.simulate, movement=ARMS, **arguments)
        assert same(moved.touch, np.asfortranarray(np.load(tmp_path / "moved/tactile.npy")))
        labels = np.genfromtxt(tmp_path / "moved/labels.csv", delimiter=",", names=True, dtype=None)
        assert moved.parts.tolist() == labels["part"].tolist()
        assert moved.seed is None and moved.names[:2] == ["Hips + Hips/2 + Hips/3 + Rigid", "Spine + Spine/2"]
        assert f" {moved.interval:g} s apart" in told
        assert any("never move against each other" in note for note in notes)
        assert not any("are played" in note for note in notes)
    # The settings are those of a default, too: then it is said that the recording goes on.
    _, notes = quietly(bodyschema.simulate, movement=ARMS, settings={"physics": {"duration": 0.5}})
    assert "0.5 s of 2 s are played (duration)" in notes


def test_a_mistake_is_a_line_with_the_names_of_arguments(tmp_path):
    text = ARMS.read_text()
    (tmp_path / "still.bvh").write_text(text[: text.index("MOTION")] + "MOTION\nFrames: 0\nFrame Time: 0.02\n")
    out = tmp_path / "out.toml"
    for call, arguments, message in [
        (bodyschema.import_body, (tmp_path / "absent.urdf", out), "absent.urdf: "),
        (bodyschema.import_body, (ROBOTS / "cut.xml", out), "cut.xml: "),
        (bodyschema.import_body, (3, out), "source must be the path of a file, but is 3"),
        (bodyschema.import_body, (ARMS, b"out"), "out must be the path of a file"),
        (bodyschema.import_body, (ARMS, "/dev/null"), "/dev/null: cannot be written"),
        (bodyschema.import_body, (ARMS, ARMS), "arms.bvh: is the input file; give another out$"),
    ]:
        refused(call, arguments, {}, message)
    for source, arguments, message in [
        (ARMS, {"root": "Hips"}, "arms.bvh: root is for robots, and this is a recorded movement; leave it out"),
        (ARMS, {"strict": True}, "arms.bvh: strict is for robots"),
        (ARMS, {"scale": -1.0}, "arms.bvh: scale is -1, but must be 0.000001 to 1000000"),
        (ARMS, {"min_length": 90.0}, "from which on bones carry skin; lower min_length, or check scale"),
        (ARMS, {"sensors_per_part": 4, "per_area": 9.0}, "sensors_per_part and per_area are both given"),
        (ARMS, {"sensors_per_part": 0}, "sensors_per_part must be a whole number of at least 1"),
        (ARMS, {"per_area": float("nan")}, "per_area must be a finite number"),
        (ROBOTS / "arm.urdf", {"scale": 0.1}, "arm.urdf: scale is for recorded movements, whose names end in .bvh"),
        (ROBOTS / "arm.urdf", {"min_length": 0.1}, "arm.urdf: min_length is for recorded movements"),
        (ROBOTS / "arm.urdf", {"root": "x"}, "no link is called `x` .root.; give the name of one"),
        (ROBOTS / "arm.urdf", {"root": 3}, "root must be the name of a body or link, but is 3"),
    ]:
        refused(bodyschema.import_body, (source, out), arguments, message)
    assert not out.exists()
    for arguments, message in [
        ({"movement": tmp_path / "absent.bvh"}, "absent.bvh: cannot be read"),
        ({"movement": tmp_path / "still.bvh"}, "still.bvh: "),
        ({"movement": ARMS, "body": "star"}, "star: cannot move as .*bodyschema.import_body makes a body that can"),
        ({"movement": ARMS, "coordination": 0.5}, "coordination is for movements at random"),
        ({"movement": ARMS, "duration": 0.01}, "arms.bvh: 0.01 s are played, but a sample needs 0.02 s"),
        ({"movement": ARMS, "scale": "big"}, "scale must be a finite number"),
        ({"movement": 3}, "movement must be the path of a file"),
        ({"scale": 0.1}, "scale is for recorded movements; give one .movement., or leave it out"),
        ({"keep_jumps": True}, "keep_jumps is for recorded movements"),
    ]:
        refused(bodyschema.simulate, (), arguments, message)


def refused(call, arguments, named, message):
    with pytest.raises(ValueError, match=message) as error:
        quietly(call, *arguments, **named)
    assert type(error.value) is ValueError and "\n" not in str(error.value) and "--" not in str(error.value)
