//! Choose some of many sensors or samples, spread evenly over all: stratified sampling at quasi-random places.

/// At most `most` of 0, …, n − 1, rising: one of each stretch of equal length.
///
/// The place within a stretch changes, so that nothing periodic, such as the sensors of a ring, is always met at one phase.
pub(crate) fn stratified(n: usize, most: usize) -> impl Iterator<Item = usize> {
    let count = n.min(most);
    (0..count).map(move |at| {
        let (from, to) = (at * n / count, (at + 1) * n / count);
        // Multiples of the golden ratio's fraction of 2⁶⁴ are spread evenly (a Kronecker sequence).
        let place = (at as u64).wrapping_mul(0x9E37_79B9_7F4A_7C15) >> 32;
        from + ((place * (to - from) as u64) >> 32) as usize
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_stretch_has_one_and_all_are_there_if_there_is_room() {
        assert!(stratified(7, 10).eq(0..7) && stratified(0, 5).count() == 0);
        let chosen: Vec<usize> = stratified(1000, 10).collect();
        assert!(chosen.iter().enumerate().all(|(at, place)| place / 100 == at), "{chosen:?}");
        let places: std::collections::BTreeSet<usize> = chosen.iter().map(|place| place % 100).collect();
        assert_eq!(places.len(), 10);
    }
}
