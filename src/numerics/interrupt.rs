//! Let whoever waits for a long computation end it, such as a person who presses Ctrl-C.
//!
//! A thread may [watch] a flag. Long computations [check] it at each iteration. Once it is set, they unwind the stack with
//! [`Interrupted`] as payload and without a message; whoever set the flag catches that by [`std::panic::catch_unwind`]. All threads
//! that compute must watch, those of a pool, too (`start_handler` of [`rayon::ThreadPoolBuilder`]). A thread that watches no flag is
//! never interrupted, and no result depends on any of this.

use std::cell::RefCell;
use std::panic::resume_unwind;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

thread_local! {
    static FLAG: RefCell<Option<Arc<AtomicBool>>> = const { RefCell::new(None) };
}

/// What a computation that was interrupted unwinds with.
#[derive(Debug)]
pub struct Interrupted;

/// Lets this thread watch a flag, instead of any that it watched before.
pub fn watch(flag: Arc<AtomicBool>) {
    FLAG.with(|own| *own.borrow_mut() = Some(flag));
}

/// Ends the computation, by unwinding, if the flag that this thread watches is set.
pub fn check() {
    let is_set = FLAG.with(|own| own.borrow().as_ref().is_some_and(|flag| flag.load(Ordering::Relaxed)));
    if is_set {
        resume_unwind(Box::new(Interrupted));
    }
}

#[cfg(test)]
mod tests {
    use std::panic::catch_unwind;
    use std::thread;

    use super::*;

    #[test]
    fn only_a_thread_that_watches_a_flag_that_is_set_is_interrupted() {
        let interrupted = |flag: Option<bool>| {
            let work = move || {
                flag.into_iter().for_each(|flag| watch(Arc::new(AtomicBool::new(flag))));
                catch_unwind(check).is_err_and(|payload| payload.is::<Interrupted>())
            };
            thread::spawn(work).join().unwrap()
        };
        assert!(interrupted(Some(true)) && !interrupted(Some(false)) && !interrupted(None));
    }
}
