#!/usr/bin/env python3
"""Makes fuzz/seeds/, small inputs that the fuzzer starts from; needs NumPy."""
import base64
import io
import json
import pathlib

import numpy as np

SEEDS = pathlib.Path(__file__).parent / "seeds"


def put(target, name, content):
    path = SEEDS / target / name
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(content)


def npy(array, version=None):
    file = io.BytesIO()
    np.lib.format.write_array(file, np.asanyarray(array), version)
    return file.getvalue()


rng = np.random.default_rng(1)
pressures = rng.exponential(size=(12, 4)) * rng.integers(0, 2, (12, 4))
points = rng.normal(size=(8, 2))
distances = np.linalg.norm(points[:, None] - points, axis=2)
for name, dtype in [("f4", "<f4"), ("f8-big", ">f8"), ("f2", "<f2"), ("i2-big", ">i2"), ("u1", "u1"), ("u8", "<u8"),
                    ("i1", "i1"), ("bool", "?"), ("complex", "<c8"), ("text", "<U3")]:
    put("npy", name, npy(pressures.astype(dtype)))
put("npy", "fortran", npy(np.asfortranarray(pressures.astype("f4"))))
put("npy", "distances", npy(distances))
put("npy", "body-map", npy(points))
put("npy", "one", npy([[0.5]]))
put("npy", "empty", npy(np.zeros((0, 3))))
put("npy", "vector", npy(points[0]))
put("npy", "cube", npy(np.zeros((2, 2, 2))))
put("npy", "record", npy(np.zeros(2, [("a", "<f4"), ("b", "<i2", 3)])))
put("npy", "version-2", npy(points, (2, 0)))
put("npy", "version-3", npy(points, (3, 0)))
put("npy", "nan", npy([[0.0, np.nan], [np.inf, -1.0]]))
put("npy", "truncated", npy(points)[:-7])
header = b"{'descr': '<f8', 'fortran_order': False, 'shape': %s, }\n"
for name, shape in [("promising", b"(99999999, 9)"), ("huge", b"(18446744073709551615, 2)"), ("nested", b"[" * 60)]:
    text = header % shape
    put("npy", name, b"\x93NUMPY\x01\x00" + len(text).to_bytes(2, "little") + text)
put("npy", "long-header", b"\x93NUMPY\x02\x00\xff\xff\xff\xff{")

felt = rng.exponential(size=(24, 14)) * rng.integers(0, 2, (24, 14))
felt[0] = range(1, 15)
timed = np.column_stack([0.1 * np.arange(24), felt])


def table(rows, separator, decimal=".", head=""):
    cells = [separator.join(f"{number:.3f}".replace(".", decimal) for number in row) for row in rows]
    return "\n".join([head] * bool(head) + cells)


def npz(save, **arrays):
    file = io.BytesIO()
    save(file, **arrays)
    return file.getvalue()


names = ",".join(["time"] + [f"s{at}" for at in range(14)])
for name, content in [
    ("npy", npy(timed)), ("npy-big", npy(np.asfortranarray(timed.astype(">f4")))), ("npz", npz(np.savez, a=timed)),
    ("npz-packed", npz(np.savez_compressed, a=felt)), ("npz-two", npz(np.savez, a=felt, b=timed)),
    ("comma", table(timed, ",", ".", names).encode()), ("blank", table(felt, " ").encode()),
    ("german", table(timed, ";", ",", names.replace(",", ";")).encode("utf-16")),
    ("tab", table(timed, "\t", ",", "# " + names.replace(",", "\t")).encode()),
    ("date", b"%time,a\n12:00:01,3\n12:00:02,\n"), ("quotes", b'"1,5","2"\r\n"3","4,5"\r\n'),
]:
    put("touch", name, b"\0" + content)

# Twelve sensors, one series after the other: on two parts that move apart, and noise.
speeds = np.concatenate([rng.normal(size=(6, 3)) @ rng.normal(size=(3, 40)) for part in range(2)])
put("recording", "parts", b"\0" + (np.maximum(speeds, 0) ** 2).astype("<f4").tobytes())
put("recording", "signed", b"\0" + speeds.astype("<f4").tobytes())
put("recording", "gaps", b"\0" + np.where(rng.random(speeds.shape) < 0.1, np.nan, speeds).astype("<f4").tobytes())
put("recording", "more", b"\x08" + rng.exponential(size=(20, 24)).astype("<f4").tobytes())

LABELS, TREE = b"sensor,part\n0,0\n1,0\n2,1\n3,1\n", b"child,parent\n1,0\n"
for name, tables in [("good", LABELS + b"\0" + TREE), ("cycle", LABELS + b"\0" + TREE + b"0,1\n"),
                     ("twin", LABELS + b"3,0\n\0" + TREE), ("loop", LABELS + b"\0child,parent\n0,0\n"),
                     ("none", b"sensor,part\n\0"), ("quoted", b'"sensor","part"\r\n"0","0"\r\n\0' + TREE)]:
    put("tables", name, b"\x03" + tables)
put("tables", "one", b"\0sensor,part\n0,7\n\0child,parent\n")

for name, text in [
    ("movement", "[motion]\ncoordination = 0\nstiffness = 1e6\nerror = \"shortest\"\n[skin]\naround = 3\ncaps = 2\n"),
    ("times", "[physics]\nstep = 0.001\nduration = 60\n[sense]\ninterval = 0.05\nfluid_density = 1.2\n"),
    ("body", "[agent]\nmorphology = \"y\"\npart_length = 1e-3\npart_radius = 0.01\ngap = 0\ndensity = 1e6\n"),
    ("mixture", "schema = { components = 3, extra_freedom = -0.99, scale = 1e-6, edge_weight = \"collapsed\" }\n"),
    ("draws", "[schema]\nkeep = \"all\"\nburn_in = 1\nsweeps = 3\n[quantise]\nscheme = \"pooled\"\nlevels = 256\n"),
    ("lists", "[experiment]\ndimensions = [1, 3]\ncoordinations = [nan]\nseed = -1\n[baselines]\nclusters = [2, 2]\n"),
]:
    put("settings", name, text.encode())

MAP = "kind,index,group,x1,x2{}\nsensor,0,0,0.1,0.2{}\nsensor,1,3,-0.4,0.2{}\njoint,0,,0,0.1{}\n"
CURVE = ("method,clusters,counting,coordination,dimension,value,n,low,high,simulations,lowest,highest\n"
         "{0},{1},all-draws,0.9,2,0.5,3,0.1,,2,0.4,0.6\n{0},{1},best-draw,0.95,5,,0,,,0,,\n")
PARTS = "dimension,counting,parts,count,n,mean,low,high\n2,all-draws,5,3,3,5,4.5,\n2,best-draw,6,1,1,6,,\n"
BOXES = ("dimension,n,lowest,whisker_low,lower_quartile,median,upper_quartile,whisker_high,highest\n"
         "2,9,-0.1,0,0.2,0.4,0.6,1,1\n")
AGENT = "part,kind,x_m,y_m,z_m\n0,proximal-end,0,0,0\n0,distal-end,0.5,0,0\n0,sensor,0.2,0.03,0\n0,joint,-0.1,0,0\n"
ANGLES = "coordination,time_s,joint,angle1_rad,angle2_rad\n0.9,0,1,3.1,0\n0.9,0.2,1,-3.1,0.1\n1,0.4,2,0,0\n"
CLAIMS = ("id,figure,place,statement,published,reproduced,n,low,high,simulations,lowest,highest,accepted,verdict,found\n"
          "a,10b,section 5,said,84.6 %,0.9,9,0.8,1,2,,,0.7..0.9,reproduced,d = 14\n")
MANIFEST = '{"experiment": "exp1", "headline": ["a"], "settings": {"skin": {"caps": 2}}, "outputs": [{"file": "a"}]}'
DRAWS = "chain,parts,log_posterior,ari,eligible,tree_correct\n0,5,{0},1.0,true,{1}\n1,5,-3.5,1.0,true,true\n"
LISTED = '{"settings": {}, "seed": 1, "experiment": "exp1", "outputs": [{"file": "../a", "sha256": "0"}]}'
for name, files in [("close", (DRAWS.format(-2.5, "true"), DRAWS.format(-2.5000001, "true"), LISTED)),
                    ("other", (DRAWS.format(-2.5, "true"), DRAWS.format(-9, "false"), MANIFEST)),
                    ("columns", ("a,b\n1,2\n", "a,c\n1,2\n", "{}")), ("empty", ("", "a\n1\n", "[]")), ("lines", ('"a\nb",c\n1,2\n', "a,c\n1,2\n", "{}"))]:
    put("verify", name, "\0".join(files).encode())

two, three = MAP.format("", "", "", ""), MAP.format(",x3", ",0.3", ",-0.3", ",0")
tables = [AGENT, ANGLES, two, three, two, three, PARTS, CURVE.format("ward", 3), CURVE.format("dpgmm", ""), BOXES,
          *[CURVE.format("dpgmm-lj", "")] * 4, CLAIMS + "\0" + MANIFEST]
for number, table in enumerate(tables):
    put("plot", f"{number:02}", bytes([number]) + table.encode())

ROOT = SEEDS.parent.parent
for robot in sorted((ROOT / "tests/data/import").glob("*.*")):
    put("body", robot.name, b"\0" + robot.read_bytes())
for body in ("star", "human"):
    put("body", body, b"\1" + (ROOT / f"bodies/{body}.toml").read_bytes())
for movement in sorted((ROOT / "tests/data/movement").glob("*.bvh")):
    head, frames = movement.read_text().split("MOTION")
    few = "\n".join(frames.splitlines()[3:7])
    for kind in (0, 3, 5):
        put("bvh", f"{movement.stem}-{kind}", bytes([kind]) + f"{head}MOTION\nFrames: 4\nFrame Time: 0.02\n{few}\n".encode())
JOINT = "JOINT a\n{\nOFFSET 1 0 0\nCHANNELS 6 Xposition Yposition Zposition Xrotation Yrotation Zrotation\n"
put("bvh", "travel", b"\1HIERARCHY\nROOT a\n{\nOFFSET 0 0 0\nCHANNELS 1 Zrotation\n" + JOINT.encode() +
    b"End Site\n{\nOFFSET 1 1 0\n}\n}\n}\nMOTION\nFrames: 3\nFrame Time: .1\n0 1 0 0 0 0 0\n9 1.5 0 0 9 0 0\n20 2 0 0 20 0 5\n")
put("bvh", "rubbish", b"\0HIERARCHY\nROOT \xff\x1b{\nOFFSET nan 0 0\nCHANNELS 7 Wrotation\nEnd Site{}}}\nMOTION\nFrames: 99999999999\nFrame Time: 0\n")

CORNERS, FACES = [[0, 0, 0], [1, 0, 0], [0, 2, 0], [0, 0, 3]], [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]
words = lambda rows: " ".join(str(number) for row in rows for number in row)
facets = "".join(f"facet normal 0 0 0 outer loop {''.join(f'vertex {words([CORNERS[at]])} ' for at in face)}endloop endfacet\n" for face in FACES)
put("mesh", "stl-text", b"\0solid t\n" + facets.encode() + b"endsolid t\n")
triangles = np.array([[[0, 0, 0], *(CORNERS[at] for at in face)] for face in FACES], "<f4").reshape(4, 12)
put("mesh", "stl", bytes([0] * 81) + (4).to_bytes(4, "little") + b"".join(row.tobytes() + b"\0\0" for row in triangles))
put("mesh", "obj", b"\1" + "".join(f"v {words([corner])}\n" for corner in CORNERS).encode() +
    "".join(f"f {words([[at + 1 for at in face]])}\n" for face in FACES).encode() + b"f 1/1/1 2//2 3 4\nf -1 -2 -3\n")
put("mesh", "msh", b"\3" + np.array([4, 0, 0, 4], "<u4").tobytes() + np.array(CORNERS, "<f4").tobytes() + np.array(FACES, "<u4").tobytes())
places, order = np.array(CORNERS, "<f4").tobytes(), np.array(FACES, "<u2").tobytes()
gltf = lambda buffer: json.dumps({
    "nodes": [{"children": [1]}, {"mesh": 0, "scale": [1, 2, 1], "rotation": [0, 0, 1, 0]}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}, {"attributes": {"POSITION": 0}, "mode": 5}]}],
    "accessors": [{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"},
                  {"bufferView": 0, "byteOffset": 48, "componentType": 5123, "count": 12, "type": "SCALAR"}],
    "bufferViews": [{"buffer": 0, "byteLength": 72}],
    "buffers": [buffer]}).encode()
put("mesh", "gltf", b"\4" + gltf({"uri": "data:;base64," + base64.b64encode(places + order).decode()}))
chunk = lambda kind, content: len(content).to_bytes(4, "little") + kind + content
chunks = chunk(b"JSON", gltf({})) + chunk(b"BIN\0", places + order)
put("mesh", "glb", b"\5glTF" + (2).to_bytes(4, "little") + (12 + len(chunks)).to_bytes(4, "little") + chunks)
put("mesh", "dae", f"""\2<COLLADA><asset><unit meter="0.5"/></asset><library_geometries><geometry id="g"><mesh>
<source id="p"><float_array>{words(CORNERS)}</float_array></source><vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles><input semantic="VERTEX" source="#v" offset="0"/><p>{words(FACES[:2])}</p></triangles>
<polylist><input semantic="VERTEX" source="#v" offset="1"/><vcount>4</vcount><p>9 0 9 1 9 2 9 3</p></polylist></mesh></geometry>
</library_geometries><library_visual_scenes><visual_scene id="s"><node><rotate>0 0 1 90</rotate><translate>1 2 3</translate>
<instance_geometry url="#g"/></node></visual_scene></library_visual_scenes><scene><instance_visual_scene url="#s"/></scene></COLLADA>""".encode())
