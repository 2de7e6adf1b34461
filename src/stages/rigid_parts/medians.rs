//! Say what is typical of residuals and of cluster sizes by their medians, which outliers do not change.

/// How many times the median a residual may be.
const MEDIANS: f64 = 3.0;

/// The largest residual that is no outlier: three times the median, or `least`, whichever is more.
pub(crate) fn outlier_limit(mut residuals: Vec<f64>, least: f64) -> f64 {
    residuals.sort_by(f64::total_cmp);
    residuals.get(residuals.len() / 2).map_or(least, |median| f64::max(least, MEDIANS * median))
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
    fn outliers_change_no_limit() {
        assert_eq!(outlier_limit(vec![0.1, 9.0, 0.2], 0.01), MEDIANS * 0.2);
        assert_eq!((outlier_limit(vec![0.001], 0.01), outlier_limit(Vec::new(), 0.01)), (0.01, 0.01));
    }

    #[test]
    fn sizes_count_by_sensors() {
        assert_eq!(
            (typical_size(vec![1, 40, 1, 1, 30]), typical_size(vec![7, 7]), typical_size(Vec::new())),
            (40, 7, 0)
        );
    }
}
