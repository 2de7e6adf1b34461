//! Where the mass of a part is and how hard it is to turn, where that is known and is not that of an even solid.

use nalgebra::Matrix3;

use super::shape::Vector3;

/// Radius of gyration, m, that a part has at least and at most: outside, the physics engine cannot compute with it.
const GYRATION: [f64; 2] = [1e-4, 1e3];
/// Share by which the two smaller principal moments may fall short of the largest one: descriptions round.
const ROUNDED: f64 = 1e-3;

/// Centre of mass and inertia of a part, in the rest pose.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Inertia {
    /// Centre of mass, m.
    pub centre: Vector3,
    /// Inertia about that centre along the axes of the common frame, kg m², by rows.
    pub tensor: [Vector3; 3],
}

impl Inertia {
    /// Why no rigid body of this mass, kg, has it; `None` if one may.
    pub fn fault(&self, mass: f64) -> Option<&'static str> {
        let tensor = Matrix3::from_fn(|row, column| self.tensor[row][column]);
        if !tensor.iter().all(|number| number.is_finite() && number.abs() <= 1e12)
            || tensor != tensor.transpose()
        {
            return Some("must be numbers up to 1e12");
        }
        let mut moments: Vector3 = tensor.symmetric_eigenvalues().into();
        moments.sort_by(f64::total_cmp);
        let [least, middle, most] = moments;
        let bounds = GYRATION.map(|radius| mass * radius * radius);
        if !(least >= bounds[0] && most <= bounds[1]) {
            return Some("must have principal moments of the mass times the square of 0.0001 to 1000 m");
        }
        // Moments are sums of squares of two coordinates each.
        (least + middle < (1.0 - ROUNDED) * most)
            .then_some("must have no principal moment above the sum of the other two, as no mass has")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_a_mass_can_have_is_an_inertia() {
        let fault = |tensor: [Vector3; 3]| Inertia { centre: [0.0; 3], tensor }.fault(2.0);
        let diagonal = |[x, y, z]: Vector3| [[x, 0.0, 0.0], [0.0, y, 0.0], [0.0, 0.0, z]];
        assert_eq!(fault(diagonal([1.0, 2.0, 3.0])), None);
        assert_eq!(fault(diagonal([1.0, 2.0, 3.002])), None);
        assert!(fault(diagonal([1.0, 2.0, 3.01])).unwrap().contains("sum of the other two"));
        for tensor in [
            diagonal([1.0, 1.0, 0.0]),
            diagonal([1.0, 1.0, -1.0]),
            diagonal([1e-8, 1e-8, 1e-8]),
            diagonal([3e6; 3]),
            // Its principal moments are 1 + 2, 1 - 2 and 1.
            [[1.0, 2.0, 0.0], [2.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        ] {
            assert!(fault(tensor).unwrap().contains("principal moments"), "{tensor:?}");
        }
        assert!(fault(diagonal([f64::NAN, 1.0, 1.0])).unwrap().contains("numbers"));
        assert!(fault([[1.0, 0.1, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]).is_some());
    }
}
