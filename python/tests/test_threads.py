"""Threads, forks, Ctrl-C, progress and pickles."""

import copy
import multiprocessing
import pickle
import signal
import sys
import threading
import time
from pathlib import Path

import numpy as np
import pytest
from conftest import same

import bodyschema


@pytest.fixture(scope="module")
def points():
    rng = np.random.default_rng(0)
    return rng.normal(size=(200, 6)) + np.repeat(6 * rng.normal(size=(4, 6)), 50, axis=0)


def long_run(points):
    """Takes minutes."""
    return bodyschema.dpgmm_lj(points, n_chains=1000, n_sweeps=100_000)


@pytest.mark.parametrize("n_jobs", [None, 1, 3, -1, -2, -50])
def test_the_number_of_threads_changes_no_bit(moved, found, n_jobs):
    assert same(bodyschema.estimate(moved.touch, interval=moved.interval, n_jobs=n_jobs), found)


def test_the_number_of_threads_changes_no_repeat(moved):
    few = moved.touch[:300]
    found = [bodyschema.estimate(few, repeats=3, n_jobs=n_jobs) for n_jobs in [1, 2]]
    assert same(*found) and found[0].repeats == 3 and "estimated again 3 times" in str(found[0])


def test_several_python_threads_beside_each_other(moved, found):
    results = [None] * 4

    def work(at):
        results[at] = bodyschema.estimate(moved.touch, interval=moved.interval, n_jobs=2)

    threads = [threading.Thread(target=work, args=(at,)) for at in range(4)]
    [thread.start() for thread in threads]
    [thread.join() for thread in threads]
    assert all(same(result, found) for result in results)


def test_python_goes_on_meanwhile(points):
    counted, done = [0], threading.Event()

    def count():
        while not done.is_set():
            counted[0] += 1
            time.sleep(0.001)

    thread = threading.Thread(target=count)
    thread.start()
    start = time.perf_counter()
    bodyschema.dpgmm_lj(points, n_chains=4, n_sweeps=10_000, n_jobs=1)
    seconds = time.perf_counter() - start
    done.set()
    thread.join()
    assert seconds > 0.1 and counted[0] > 100 * seconds


def interrupted(work):
    """Seconds of the processor from a signal to the exception that it raises: other programs take none of these."""
    sent = []

    def handler(*_):
        sent.append(time.process_time())
        raise KeyboardInterrupt

    before = signal.signal(signal.SIGALRM, handler)
    try:
        signal.setitimer(signal.ITIMER_REAL, 0.3)
        with pytest.raises(KeyboardInterrupt):
            work()
        return time.process_time() - sent[0]
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)


def busy():
    """Names of our threads that run."""
    names = [path.read_text().strip() for path in Path("/proc/self/task").glob("*/comm")]
    return [name for name in names if name.startswith("bodyschema")]


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="threads are counted in /proc")
def test_ctrl_c_ends_every_long_computation_and_its_threads(points):
    rng = np.random.default_rng(0)
    noise = rng.random((20_000, 700), dtype=np.float32) * rng.integers(2, size=(20_000, 700), dtype=np.uint8)
    many = rng.normal(size=(6000, 10))
    symbols = rng.integers(64, size=(20_000, 1500), dtype=np.uint8)
    distances = np.abs(points[:, None] - points[None]).sum(axis=2)
    smacof = {"map": {"starts": 1000, "steps": 100_000, "tolerance": 0.0}}
    for work in [
        lambda: long_run(points),
        lambda: bodyschema.simulate(duration=2e5),
        lambda: bodyschema.estimate(noise),
        lambda: bodyschema.information_metric(symbols),
        lambda: bodyschema.body_map(distances, 5, method="smacof-random", settings=smacof),
        lambda: bodyschema._bodyschema.cluster(many, "gmm", 300, 1000, 1, 1),
        lambda: bodyschema._bodyschema.cluster(many, "k-means", 300, 1000, 1, 1),
    ]:
        assert interrupted(work) < 4.0
    deadline = time.perf_counter() + 2
    while busy() and time.perf_counter() < deadline:
        time.sleep(0.01)
    assert busy() == []


def test_a_handler_that_raises_nothing_does_not_end_anything(points):
    seen = []
    before = signal.signal(signal.SIGALRM, lambda *_: seen.append(1))
    try:
        signal.setitimer(signal.ITIMER_REAL, 0.05)
        while not seen:
            bodyschema.dpgmm_lj(points, n_chains=2, n_sweeps=200)
    finally:
        signal.signal(signal.SIGALRM, before)


def test_progress_is_told(moved, points):
    told = []
    bodyschema.estimate(moved.touch, progress=lambda done, total: told.append((done, total)))
    assert told[-1] == (3, 3) and told == sorted(told)
    told.clear()
    bodyschema.dpgmm_lj(points, n_chains=5, n_sweeps=50, progress=lambda *now: told.append(now))
    assert told[-1] == (5, 5)
    told.clear()
    bodyschema.simulate("star", duration=20, progress=lambda *now: told.append(now))
    assert told[-1] == (201, 201)


def test_what_progress_raises_ends_the_work(points):
    def stop(done, total):
        raise LookupError("enough")

    with pytest.raises(LookupError, match="enough"):
        bodyschema.dpgmm_lj(points, n_chains=1000, n_sweeps=1000, progress=stop)


def test_a_bar_is_shown_if_it_is_wanted(moved, capsys):
    pytest.importorskip("tqdm")
    bodyschema.estimate(moved.touch, progress=True)
    assert "estimate" in capsys.readouterr().err
    bodyschema.estimate(moved.touch)
    bodyschema.estimate(moved.touch, progress=False)
    assert capsys.readouterr().err == ""


def test_results_can_be_pickled_and_copied(moved, found, points):
    posterior = bodyschema.dpgmm_lj(points, n_chains=2, n_sweeps=5)
    for result in [moved, found, posterior, bodyschema.score([0, 0], [], [0, 0], [])]:
        for protocol in range(2, pickle.HIGHEST_PROTOCOL + 1):
            assert same(pickle.loads(pickle.dumps(result, protocol)), result)
        assert same(copy.deepcopy(result), result)


def child(touch, queue):
    moved = bodyschema.simulate("star", duration=5, random_state=1)
    queue.put((bodyschema.estimate(touch, interval=0.1, progress=False), moved))


@pytest.mark.filterwarnings("ignore:.*fork.*:DeprecationWarning")
@pytest.mark.parametrize("method", ["fork", "spawn"])
def test_processes_that_fork_or_not_compute_the_same(moved, found, method):
    context = multiprocessing.get_context(method)
    queue = context.Queue()
    process = context.Process(target=child, args=(moved.touch, queue))
    process.start()
    results = queue.get(timeout=300)
    process.join()
    assert process.exitcode == 0
    assert same(results[0], found) and same(results[1], bodyschema.simulate("star", duration=5, random_state=1))


def test_arrays_outlive_what_they_came_from(moved):
    # One simulation after the other frees and reuses memory; what was returned stays.
    touch = moved.touch
    before = touch.copy()
    for seed in range(3):
        bodyschema.simulate("chain-3", duration=5, random_state=seed)
    assert same(touch, before) and touch.flags.writeable
    references = sys.getrefcount(touch)
    for _ in range(5):
        bodyschema.quantise(touch)
    assert sys.getrefcount(touch) == references
