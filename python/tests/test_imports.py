"""What reproduce/imports.py counts as a robot, and how it weighs one."""

import pathlib
import sys

import pytest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "reproduce"))

import imports  # noqa: E402


def test_robots_have_two_joints_and_scenes_do_not_count_twice(tmp_path):
    leg = '<body><joint/><geom size="1"/>'
    for name, text in {
        "legs.xml": f"<mujoco><worldbody>{leg}{leg}</body></body></worldbody></mujoco>",
        "leg.xml": f"<mujoco><default><default><joint/></default><joint/><joint/></default><worldbody>{leg}</body></worldbody></mujoco>",
        "free.xml": f'<mujoco><worldbody><body><joint type="free"/>{leg}</body></body></worldbody></mujoco>',
        "scene.xml": '<mujoco><include file="legs.xml"/><worldbody/></mujoco>',
        "part.xml": f"<mujocoinclude>{leg}{leg}</body></body></mujocoinclude>",
        "whole.xml": '<mujoco><worldbody><include file="part.xml"/></worldbody></mujoco>',
        "arm.urdf": '<robot><joint name="a" type="revolute"/><joint name="b" type="prismatic"/></robot>',
        "still.urdf": '<robot><joint name="a" type="revolute"/><joint name="b" type="fixed"/><!-- type="revolute" --></robot>',
    }.items():
        (tmp_path / name).write_text(text)
    found = lambda kind: {file.name: joints for file, joints in imports.robots(tmp_path, kind)}
    assert found("mjcf") == {"legs.xml": 2, "whole.xml": 2}
    assert found("urdf") == {"arm.urdf": 2}


def test_masses_are_compared_where_all_that_is_fixed_together_names_one(tmp_path):
    file = tmp_path / "arm.urdf"
    weight = '<inertial><mass value="2"/></inertial>'
    link = lambda name, inside="": f'<link name="{name}">{inside}</link>'
    fixed = '<joint type="fixed"><parent link="a"/><child link="b"/></joint>'
    file.write_text(f"<robot>{link('a', weight + '<visual/>')}{link('b', weight)}{link('c')}</robot>")
    assert imports.mass_of_urdf(file) == 4
    shaped = link("a", weight + "<visual/>") + link("b", "<visual/>")
    file.write_text(f"<robot>{shaped}</robot>")
    assert imports.mass_of_urdf(file) is None
    # A loop of fixed joints ends, too.
    for joints in (fixed, fixed + fixed.replace('"a"', '"x"').replace('"b"', '"a"').replace('"x"', '"b"')):
        file.write_text(f"<robot>{shaped}{joints}</robot>")
        assert imports.mass_of_urdf(file) == 2


def test_volumes_of_parts():
    assert imports.volume({"shape": "box", "size": [1, 2, 3]}) == 6
    ball = imports.volume({"shape": "sphere", "radius": 0.5})
    tube = {"radius": 0.5, "from": [0, 0, 0], "to": [0, 0, 2]}
    assert ball == pytest.approx(0.5236, abs=1e-4)
    assert imports.volume({"shape": "cylinder", **tube}) == pytest.approx(1.5708, abs=1e-4)
    assert imports.volume({"shape": "capsule", **tube}) == pytest.approx(1.5708 + ball, abs=1e-4)
