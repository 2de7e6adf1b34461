//! Sum numbers that are given by their logarithms.

/// log Σ e^x; −∞ of nothing.
pub fn log_sum(logs: impl Iterator<Item = f64> + Clone) -> f64 {
    let largest = logs.clone().fold(f64::NEG_INFINITY, f64::max);
    if largest == f64::NEG_INFINITY {
        return largest;
    }
    largest + logs.map(|log| (log - largest).exp()).sum::<f64>().ln()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn large_and_small_logarithms_neither_overflow_nor_vanish() {
        assert!((log_sum([1000.0, 1000.0].into_iter()) - (1000.0 + 2f64.ln())).abs() < 1e-12);
        assert!((log_sum([-1000.0, -1001.0].into_iter()) - (-1000.0 + (-1f64).exp().ln_1p())).abs() < 1e-12);
        assert_eq!(log_sum([f64::NEG_INFINITY, -5.0].into_iter()), -5.0);
        assert_eq!(log_sum(std::iter::empty()), f64::NEG_INFINITY);
    }
}
