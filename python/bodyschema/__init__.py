"""Find a body's rigid parts, the part of each tactile sensor, and the tree of joints, from touch alone.

Three lines for one's own recording, a row for each sample and a column for each sensor::

    import bodyschema
    found = bodyschema.estimate("recording.csv")  # or an array
    print(found)

The other functions are the stages of Mimura, Hagiwara, Taniguchi and Inamura, "Bayesian Body Schema Estimation using Tactile
Information obtained through Coordinated Random Movements", Advanced Robotics 31, 2017: `simulate`, `quantise`, `information_metric`,
`body_map`, `dpgmm_lj` and `score`. The module `bodyschema.cluster` has the clusterings as estimators of scikit-learn.

The numbers are those of the command line `bodyschema`, bit for bit: the same input and seed give the same result, on any number of
threads.
"""

from importlib.metadata import PackageNotFoundError, version as _version

from ._bodies import BodyWarning, import_body
from ._bodyschema import BODIES, REVISION, SEED
from ._estimate import Estimate, Fit, estimate
from ._joints import Joints, estimate_tree
from ._reading import RecordingWarning, read_touch
from ._placement import Placement, place_joints
from ._schema import Posterior, dpgmm, dpgmm_lj
from ._simulate import Simulation, simulate
from ._stages import Score, body_map, information_metric, quantise, score

try:
    __version__ = _version("bodyschema")
except PackageNotFoundError:  # used from its source folder
    __version__ = "unknown"

__all__ = [
    "BODIES",
    "BodyWarning",
    "Estimate",
    "Fit",
    "Joints",
    "Placement",
    "Posterior",
    "REVISION",
    "RecordingWarning",
    "SEED",
    "Score",
    "Simulation",
    "body_map",
    "dpgmm",
    "dpgmm_lj",
    "estimate",
    "estimate_tree",
    "import_body",
    "information_metric",
    "place_joints",
    "quantise",
    "read_touch",
    "score",
    "simulate",
]
