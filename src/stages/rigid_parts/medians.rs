//! Say what is typical by the median, which outliers do not change.

/// The median, of an even number the upper one; 0 of none.
pub(crate) fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(0.0)
}

/// The size of the cluster that the median sensor is in: the median of sizes, each counted once for each of its sensors.
pub(crate) fn typical_size(mut sizes: Vec<usize>) -> usize {
    sizes.sort_unstable();
    let half = sizes.iter().sum::<usize>().div_ceil(2);
    let mut below = 0;
    let reaches = |size: &usize| {
        below += size;
        below >= half
    };
    sizes.into_iter().find(reaches).unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_count_by_sensors() {
        assert_eq!(
            (typical_size(vec![1, 40, 1, 1, 30]), typical_size(vec![7, 7]), typical_size(Vec::new())),
            (40, 7, 0)
        );
    }
}
