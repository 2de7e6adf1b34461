"""Parts and joints are placed where sensors' positions are known, as the command line places them."""

import csv
import warnings
import xml.etree.ElementTree as ElementTree

import numpy as np
import pytest

import bodyschema


@pytest.fixture(scope="module")
def moved():
    return bodyschema.simulate("star", duration=300, coordination=0.5, random_state=3)


@pytest.fixture(scope="module")
def found(moved):
    return bodyschema.estimate(moved.touch)


@pytest.mark.parametrize("noise", [0.0, 0.01])
@pytest.mark.filterwarnings("ignore::bodyschema.RecordingWarning")
def test_the_same_as_the_command_line(command, tmp_path, noise):
    moved = bodyschema.simulate("chain-3", duration=200, coordination=0.0, random_state=3)
    size = noise * np.sqrt((moved.touch**2).mean(axis=0))
    touch = (moved.touch + size * np.random.default_rng(1).standard_normal(moved.touch.shape)).astype(np.float32)
    found = bodyschema.estimate(touch)
    placed = bodyschema.place_joints(touch, found, moved.positions, moved.normals, moved.solids)
    np.save(tmp_path / "tactile.npy", touch)
    sites = np.column_stack([moved.solids, moved.positions, moved.normals])
    np.savetxt(tmp_path / "sensors.csv", sites, delimiter=",", header="frame,x,y,z,nx,ny,nz", comments="", fmt=["%d"] + 6 * ["%.17g"])
    command("estimate", tmp_path / "tactile.npy", "--sensors", tmp_path / "sensors.csv", "--out", tmp_path / "found")
    assert placed.to_urdf(tmp_path / "own.urdf").read_text() == (tmp_path / "found" / "body.urdf").read_text()
    with open(tmp_path / "found" / "places.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    for at, row in enumerate(rows):
        assert [int(row["child"]), int(row["parent"])] == placed.tree[at].tolist()
        assert float(row["standard_error_m"]) == pytest.approx(placed.standard_error[at], abs=1e-6)
        written = [float(row[f"child_{axis}_m"]) for axis in "xyz"]
        assert written == pytest.approx(placed.in_child[at].tolist(), abs=1e-6)


def test_what_it_has(moved, found):
    placed = bodyschema.place_joints(moved.touch, found, moved.positions, moved.normals, moved.solids, n_jobs=1)
    assert repr(placed) == "<Placement: 5 parts, 4 of 4 joints placed by touch>"
    assert placed.known.all() and (placed.explained > 0.99).all() and placed.notes == []
    assert np.allclose(np.linalg.det(placed.rotations), 1) and np.allclose(np.linalg.det(placed.joint_rotations), 1)
    # Limbs are 0.5 m long and 0.06 m thick, and each joint is 0.05 m before the end of a limb.
    assert np.allclose(np.sort(placed.sides, axis=1)[:, 2], 0.5, atol=0.01)
    assert np.allclose(np.abs(placed.in_child[:, 2]), 0.3, atol=0.03)
    assert len(ElementTree.fromstring(placed.urdf).findall("joint")) == 3 * len(placed.tree)


def test_sites_that_do_not_fit_what_is_felt_are_noticed(moved, found):
    mixed = np.arange(200) * 7 % 200
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always")
        placed = bodyschema.place_joints(moved.touch, found, moved.positions[mixed], moved.normals[mixed])
    assert [str(warning.message) for warning in said] == placed.notes
    assert "are rows in the order of the sensors" in placed.notes[0] and "touch does not tell" in placed.notes[-1]
    assert not placed.known.any() and np.isnan(placed.standard_error).all()


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"positions": np.zeros((199, 3))}, "positions must have a row x, y, z for each of 200 sensors"),
        ({"normals": np.zeros((200, 3))}, r"normals\[0\] has no direction"),
        ({"positions": np.full((200, 3), np.nan)}, "positions must be finite, but row 0 is not"),
        ({"frames": np.full(200, -1)}, "frames must be whole numbers of at least 0"),
        ({"found": "found"}, "found must be what bodyschema.estimate returns"),
        ({"touch": np.ones((10, 12))}, "touch has 12 sensors, but found is of 200"),
    ],
)
def test_mistakes_are_named(moved, found, change, message):
    arguments = {"touch": moved.touch, "found": found, "positions": moved.positions, "normals": moved.normals, **change}
    with pytest.raises(ValueError, match=message):
        bodyschema.place_joints(**arguments)
