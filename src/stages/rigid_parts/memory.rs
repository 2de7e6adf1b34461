//! Remember what was computed from the same numbers before.
//!
//! The search comes back to the same sensors: a move that failed is tried again when other clusters have changed, and what it compares
//! with often has not. The key is a hash of all that a result depends on. So what is remembered is what would be computed again, to
//! the bit. (Of a million keys, two are the same by chance in one of 10⁷ cases.)

use std::collections::HashMap;
use std::hash::{BuildHasher, Hasher};
use std::sync::{Arc, Mutex};

use faer::Mat;
use foldhash::quality::FixedState;

/// Results of a generation. The last generation and the one before are kept: some 70 MB for motions of rank six at 1,500 samples. It
/// changes no result.
const GENERATION: usize = 500;

/// Results by their keys. Clones share them.
pub(super) struct Memory<T>(Arc<Mutex<Generations<T>>>);

/// The results of a generation, by their keys.
type Generation<T> = HashMap<u64, Arc<T>>;

/// The generation that is filled, and the one before.
struct Generations<T> {
    now: Generation<T>,
    before: Generation<T>,
}

impl<T> Memory<T> {
    /// The result with this key, if it is among the last ones that were added or asked for.
    pub(super) fn get(&self, key: u64) -> Option<Arc<T>> {
        self.with(|own| {
            if let Some(found) = own.now.get(&key) {
                return Some(found.clone());
            }
            let found = own.before.remove(&key)?;
            own.add(key, found.clone());
            Some(found)
        })
    }

    pub(super) fn add(&self, key: u64, result: T) {
        self.with(|own| own.add(key, Arc::new(result)));
    }

    fn with<R>(&self, work: impl FnOnce(&mut Generations<T>) -> R) -> R {
        work(&mut self.0.lock().expect("nothing panics here"))
    }
}

impl<T> Generations<T> {
    fn add(&mut self, key: u64, result: Arc<T>) {
        if self.now.len() >= GENERATION {
            self.before = std::mem::take(&mut self.now);
        }
        self.now.insert(key, result);
    }
}

impl<T> Default for Memory<T> {
    fn default() -> Self {
        Self(Arc::new(Mutex::new(Generations { now: HashMap::new(), before: HashMap::new() })))
    }
}

impl<T> Clone for Memory<T> {
    fn clone(&self) -> Self {
        Self(self.0.clone())
    }
}

/// A key made of these numbers and matrices.
pub(super) fn key(numbers: &[f64], matrices: &[&Mat<f64>]) -> u64 {
    // A hash that does not withstand an attacker, and takes a quarter of the time of one that does.
    let mut hasher = FixedState::default().build_hasher();
    let mut write = |numbers: &[f64]| {
        hasher.write_usize(numbers.len());
        hasher.write(pulp::bytemuck::cast_slice(numbers));
    };
    write(numbers);
    for matrix in matrices {
        (0..matrix.ncols()).for_each(|column| write(matrix.col_as_slice(column)));
    }
    hasher.finish()
}

#[cfg(test)]
mod tests;
