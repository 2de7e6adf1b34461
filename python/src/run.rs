//! Run a computation on threads of its own, while Python's thread waits without the GIL, shows progress and listens for Ctrl-C.

use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::time::Duration;

use bodyschema::numerics::interrupt;
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};

/// How often Python's thread looks up.
const PATIENCE: Duration = Duration::from_millis(50);
/// How long it waits for an interrupted computation to end, which takes an iteration; longer, and the computation is left behind.
const FAREWELL: Duration = Duration::from_secs(5);
/// Stack of each thread, in bytes: that of a program's main thread, on which the command line computes.
const STACK: usize = 8 << 20;

/// Threads for one call. A pool for all calls would not survive a fork.
pub(crate) struct Threads {
    pool: ThreadPool,
    flag: Arc<AtomicBool>,
}

/// Steps that are done.
#[derive(Clone)]
pub(crate) struct Steps(Arc<AtomicUsize>);

impl Steps {
    /// Counts a step.
    pub(crate) fn tick(&self) {
        self.0.fetch_add(1, Ordering::Relaxed);
        interrupt::check();
    }
}

impl Threads {
    /// Starts so many threads; 0: as many as the command line.
    pub(crate) fn start(jobs: usize) -> PyResult<Self> {
        let flag = Arc::new(AtomicBool::new(false));
        let watched = Arc::clone(&flag);
        let pool = ThreadPoolBuilder::new()
            .num_threads(jobs)
            .stack_size(STACK)
            .thread_name(|at| format!("bodyschema-{at}"))
            .start_handler(move |_| interrupt::watch(Arc::clone(&watched)))
            .build()
            .map_err(|error| PyRuntimeError::new_err(format!("cannot start {jobs} threads: {error}")))?;
        Ok(Self { pool, flag })
    }

    /// Runs what borrows from Python's arrays and takes no longer than a copy, without the GIL.
    pub(crate) fn copy<R: Send>(&self, py: Python<'_>, work: impl FnOnce() -> R + Send) -> PyResult<R> {
        py.detach(|| self.pool.install(|| catch_unwind(AssertUnwindSafe(work))))
            .map_err(|payload| failed(&*payload))
    }

    /// Runs `work`, without the GIL. Meanwhile `progress` is called with the number of steps that are done.
    ///
    /// # Errors
    /// What a signal handler raises, such as `KeyboardInterrupt`, and what `progress` raises: either ends the work.
    pub(crate) fn run<R: Send + 'static>(
        &self,
        py: Python<'_>,
        progress: Option<&Bound<'_, PyAny>>,
        work: impl FnOnce(&Steps) -> R + Send + 'static,
    ) -> PyResult<R> {
        let steps = Steps(Arc::new(AtomicUsize::new(0)));
        let (sender, mut receiver) = channel();
        let own = steps.clone();
        self.pool.spawn(move || {
            // Nobody waits for the result of what was left behind.
            let _ = sender.send(catch_unwind(AssertUnwindSafe(|| work(&own))));
        });
        let mut shown = 0;
        loop {
            let answer;
            (answer, receiver) = py.detach(move || wait(receiver, PATIENCE));
            let done = steps.0.load(Ordering::Relaxed);
            let told = match progress.filter(|_| done > shown) {
                Some(progress) => progress.call1((done,)).map(|_| ()),
                None => Ok(()),
            };
            shown = done;
            match (told.and_then(|()| py.check_signals()), answer) {
                (Err(error), answer) => {
                    self.flag.store(true, Ordering::Relaxed);
                    if answer.is_err_and(|error| error == RecvTimeoutError::Timeout) {
                        let _ = py.detach(move || wait(receiver, FAREWELL));
                    }
                    return Err(error);
                }
                (Ok(()), Ok(result)) => return result.map_err(|payload| failed(&*payload)),
                (Ok(()), Err(RecvTimeoutError::Timeout)) => (),
                (Ok(()), Err(RecvTimeoutError::Disconnected)) => return Err(failed(&"its thread ended")),
            }
        }
    }
}

/// Waits for a result, and gives back what it comes from.
fn wait<R>(receiver: Receiver<R>, patience: Duration) -> (Result<R, RecvTimeoutError>, Receiver<R>) {
    (receiver.recv_timeout(patience), receiver)
}

/// The exception of a mistake of ours.
fn failed(payload: &(dyn Any + Send)) -> PyErr {
    let message = payload
        .downcast_ref::<String>()
        .map(String::as_str)
        .or_else(|| payload.downcast_ref::<&str>().copied())
        .unwrap_or("unknown");
    PyRuntimeError::new_err(format!("bodyschema has a mistake, please report it: {message}"))
}
