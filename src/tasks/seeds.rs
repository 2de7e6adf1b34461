//! Tell seeds that were used to choose settings from those that are held out.

/// Seeds by which settings were chosen or studied.
const USED: [u64; 7] = [1, 3, 4, 5, 6, 7, 8];

/// Whether neither a search for the default nor the study of its settings has used a master seed.
pub fn is_held_out(seed: u64) -> bool {
    !USED.contains(&seed)
}
