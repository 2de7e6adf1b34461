//! Correlate the squared speeds of a joint as two parts feel it: canonical correlation (Hotelling 1936) of quadratic forms that
//! are nowhere negative.

use nalgebra::{DMatrix, DVector};

/// Iterations in which forms are made nowhere negative, and regressed on each other.
const ITERATIONS: usize = 6;

/// The quadratic forms of one part's motion.
pub(super) struct QuadraticForms {
    /// Which two components of the motion each monomial is the product of, the second not before the first.
    pairs: Vec<(usize, usize)>,
    /// The size of each component of the motion.
    scales: Vec<f64>,
    /// Sums over samples of the products of two monomials, with a ridge.
    moments: DMatrix<f64>,
    /// The lower Cholesky factor of the moments.
    factor: DMatrix<f64>,
}

impl QuadraticForms {
    /// From the moments of these monomials; `None` if the part feels nothing.
    pub(super) fn new(pairs: Vec<(usize, usize)>, mut moments: DMatrix<f64>, ridge: f64) -> Option<Self> {
        let rank = pairs.iter().map(|pair| pair.1 + 1).max().unwrap_or(0);
        let mut scales = vec![0.0; rank];
        for (at, (i, _)) in pairs.iter().enumerate().filter(|(_, (i, j))| i == j) {
            scales[*i] = moments[(at, at)].max(0.0).sqrt().sqrt();
        }
        let factor = factor_with_ridge(&mut moments, ridge)?;
        Some(Self { pairs, scales, moments, factor })
    }

    /// The nearest positive semidefinite form: nearest by its coefficients, with each component of the motion in the unit of its
    /// size.
    fn semidefinite(&self, form: &DVector<f64>) -> DVector<f64> {
        let n = self.scales.len();
        let mut matrix = DMatrix::zeros(n, n);
        for (&(i, j), coefficient) in self.pairs.iter().zip(form.iter()) {
            let share = if i == j { *coefficient } else { 0.5 * coefficient };
            matrix[(i, j)] = share * self.scales[i] * self.scales[j];
            matrix[(j, i)] = matrix[(i, j)];
        }
        let mut eigen = matrix.symmetric_eigen();
        eigen.eigenvalues.apply(|value| *value = value.max(0.0));
        let matrix = eigen.recompose();
        let coefficient = |(i, j): (usize, usize)| {
            let scale = self.scales[i] * self.scales[j];
            let twice = if i == j { 1.0 } else { 2.0 };
            if scale > 0.0 { twice * matrix[(i, j)] / scale } else { 0.0 }
        };
        DVector::from_iterator(form.len(), self.pairs.iter().copied().map(coefficient))
    }

    /// The root of the sum of squares of a form over samples.
    fn norm(&self, form: &DVector<f64>) -> f64 {
        (form.transpose() * &self.moments * form)[(0, 0)].max(0.0).sqrt()
    }

    /// The regression on the monomials of what has these products with them.
    fn regressed(&self, products: &DVector<f64>) -> DVector<f64> {
        let half = self.factor.solve_lower_triangular(products).expect("a factor is regular");
        self.factor.tr_solve_lower_triangular(&half).expect("a factor is regular")
    }

    /// Whether the trace of a form is negative.
    fn is_negative(&self, form: &DVector<f64>) -> bool {
        let own = self.pairs.iter().zip(form.iter()).filter(|((i, j), _)| i == j);
        own.map(|((i, _), coefficient)| coefficient * self.scales[*i].powi(2)).sum::<f64>() < 0.0
    }
}

/// What the quadratic forms of two motions have in common.
#[derive(Default)]
pub(super) struct Common {
    /// The largest cosine over samples between a form of one motion and one of the other, both positive semidefinite, as the square of a
    /// speed is; 0 to 1. A lower bound.
    pub correlation: f64,
    /// The canonical correlations of any forms, without a constant; 0 to 1, the largest first.
    pub canonical: Vec<f64>,
}

/// What the quadratic forms of two motions have in common; nothing where a part feels nothing.
///
/// `products` are sums over samples of the products of the monomials of both. The start is the first canonical correlation,
/// without a constant, for a form is 0 at rest. Then each form is made semidefinite and regressed on the other, and the best
/// iteration counts.
pub(super) fn common(
    first: &Option<QuadraticForms>,
    second: &Option<QuadraticForms>,
    products: &DMatrix<f64>,
) -> Common {
    let (Some(first), Some(second)) = (first, second) else { return Common::default() };
    let whole = whitened(&first.factor, &second.factor, products);
    let svd = whole.svd(true, true);
    let (Some(u), Some(v)) = (&svd.u, &svd.v_t) else { return Common::default() };
    let at = svd.singular_values.imax();
    let mut b =
        second.factor.tr_solve_lower_triangular(&u.column(at).into_owned()).expect("a factor is regular");
    let mut a = first.factor.tr_solve_lower_triangular(&v.row(at).transpose()).expect("a factor is regular");
    if first.is_negative(&a) {
        (a, b) = (-a, -b);
    }
    let mut best = 0.0;
    for _ in 0..ITERATIONS {
        let (own, other) = (first.semidefinite(&a), second.semidefinite(&b));
        let norms = first.norm(&own) * second.norm(&other);
        if norms <= 0.0 {
            break;
        }
        let with_other = products * &other;
        best = f64::max(best, own.dot(&with_other) / norms);
        (a, b) = (first.regressed(&with_other), second.regressed(&products.tr_mul(&own)));
    }
    let canonical = svd.singular_values.iter().map(|value| value.clamp(0.0, 1.0)).collect();
    Common { correlation: best.clamp(0.0, 1.0), canonical }
}

/// Adds a share of the mean of the diagonal to it. Out: the lower Cholesky factor; `None` if that is singular, or there is nothing.
pub(super) fn factor_with_ridge(moments: &mut DMatrix<f64>, share: f64) -> Option<DMatrix<f64>> {
    let n = moments.nrows();
    let ridge = share * moments.trace() / n.max(1) as f64;
    (0..n).for_each(|at| moments[(at, at)] += ridge);
    if n == 0 { None } else { Some(moments.clone().cholesky()?.unpack()) }
}

/// Products of two variables, first × second, in units in which the moments of each are the identity: second × first. In: the Cholesky
/// factors of these moments.
pub(super) fn whitened(first: &DMatrix<f64>, second: &DMatrix<f64>, products: &DMatrix<f64>) -> DMatrix<f64> {
    let half = first.solve_lower_triangular(products).expect("a factor is regular");
    second.solve_lower_triangular(&half.transpose()).expect("a factor is regular")
}
