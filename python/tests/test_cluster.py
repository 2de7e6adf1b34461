"""The estimators keep scikit-learn's conventions."""

import pickle

import numpy as np
import pytest

import bodyschema

sklearn = pytest.importorskip("sklearn")

from sklearn.base import clone  # noqa: E402
from sklearn.metrics import adjusted_rand_score  # noqa: E402
from sklearn.utils.estimator_checks import parametrize_with_checks  # noqa: E402

from bodyschema.cluster import DPGMM, DPGMMLJ, GaussianMixture, KMeans, Ward  # noqa: E402

ESTIMATORS = [
    DPGMMLJ(n_chains=4, n_sweeps=40, n_jobs=1),
    DPGMM(n_chains=4, n_sweeps=40, n_jobs=1),
    KMeans(3, n_init=2, n_jobs=1),
    GaussianMixture(3, n_init=2, n_jobs=1),
    Ward(3),
]


@parametrize_with_checks(ESTIMATORS)
def test_scikit_learn_s_own_checks(estimator, check):
    check(estimator)


@pytest.fixture(scope="module")
def blobs():
    rng = np.random.default_rng(3)
    labels = np.repeat(np.arange(3), 30)
    return rng.normal(size=(90, 3)) + 9 * np.eye(3)[labels], labels


@pytest.mark.parametrize("estimator", ESTIMATORS)
def test_clusters_are_found(estimator, blobs):
    points, labels = blobs
    fitted = clone(estimator).fit(points)
    assert adjusted_rand_score(labels, fitted.labels_) > 0.95
    assert fitted.labels_[0] == 0 and fitted.n_features_in_ == 3
    assert pickle.loads(pickle.dumps(fitted)).labels_.tolist() == fitted.labels_.tolist()
    for n_jobs in [1, 3]:
        if hasattr(estimator, "n_jobs"):
            other = clone(estimator).set_params(n_jobs=n_jobs)
            assert other.fit_predict(points).tolist() == fitted.labels_.tolist()


def test_the_best_sample_is_kept(blobs):
    points, _ = blobs
    fitted = DPGMMLJ(n_chains=6, n_sweeps=30, random_state=5).fit(points)
    posterior = bodyschema.dpgmm_lj(points, n_chains=6, n_sweeps=30, random_state=5)
    assert posterior.best == posterior.log_posterior.argmax()
    assert fitted.log_posterior_ == posterior.log_posterior.max()
    assert fitted.tree_.shape == (2, 2) and fitted.joints_.shape == (2, 3)
    assert set(fitted.tree_.ravel()) == {0, 1, 2}
    raw = posterior.labels[posterior.best]
    assert raw[np.unique(fitted.labels_, return_index=True)[1]].tolist() == list(dict.fromkeys(raw.tolist()))
    assert DPGMM(n_chains=2, n_sweeps=5).fit(points).joints_.shape == (0, 3)


def test_without_scikit_learn_the_rest_works(tmp_path):
    import subprocess
    import sys

    code = (
        "import sys; sys.modules['sklearn'] = None\n"
        "import bodyschema\n"
        "bodyschema.dpgmm_lj([[0.0], [1.0], [5.0]], n_chains=1, n_sweeps=2)\n"
        "try:\n    import bodyschema.cluster\n"
        "except ImportError as error:\n    print(error)\n"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True, cwd=tmp_path)
    assert done.stdout == "bodyschema.cluster needs scikit-learn: pip install 'bodyschema[sklearn]'\n"
