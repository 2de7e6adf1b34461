//! The mass of rigid bodies as a description names it: where it is, and how hard it is to turn.

use nalgebra::{Isometry3, Matrix3, Vector3 as Column};

use super::rounding::rounded;
use crate::files::body::InertiaEntry;
use crate::stages::agent::Inertia;

/// A mass in the common frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Mass {
    /// kg.
    pub mass: f64,
    /// Its centre, m.
    pub centre: Column<f64>,
    /// Inertia about that centre, kg m².
    pub tensor: Matrix3<f64>,
}

impl Mass {
    /// The mass of which a description says so much, with the tensor in this frame about its origin. None if it says nothing of it:
    /// a mass or an inertia of 0.
    pub(super) fn new(mass: f64, tensor: Matrix3<f64>, frame: &Isometry3<f64>) -> Option<Self> {
        let axes = frame.rotation.to_rotation_matrix();
        let tensor = axes.matrix() * tensor * axes.matrix().transpose();
        (mass > 0.0 && tensor != Matrix3::zeros()).then_some(Self {
            mass,
            centre: frame.translation.vector,
            tensor: (tensor + tensor.transpose()) / 2.0,
        })
    }

    /// The same matter, denser by this factor.
    pub(super) fn times(self, factor: f64) -> Self {
        Self { mass: factor * self.mass, tensor: factor * self.tensor, ..self }
    }

    /// All of them as one rigid body (Huygens and Steiner).
    pub(super) fn together(all: &[Self]) -> Self {
        let mass: f64 = all.iter().map(|own| own.mass).sum();
        let centre = all.iter().map(|own| own.mass * own.centre).sum::<Column<f64>>() / mass;
        let about_centre = |own: &Self| {
            let off = own.centre - centre;
            own.tensor
                + own.mass * (Matrix3::from_diagonal_element(off.norm_squared()) - off * off.transpose())
        };
        Self { mass, centre, tensor: all.iter().map(about_centre).sum() }
    }

    /// Whether a part may have a share of it: a rigid body can have it, and it is near.
    pub(super) fn is_sound(&self) -> bool {
        self.share(1.0).fault(self.mass).is_none() && self.centre.iter().all(|x| x.abs() <= 1e3)
    }

    /// A share of it that is spread as the whole is.
    pub(super) fn share(&self, share: f64) -> Inertia {
        // Rounding must not make it lopsided, and twelve digits of the largest number are enough of each.
        let whole = (self.tensor + self.tensor.transpose()) * (share / 2.0);
        let digits = (12.0 - whole.amax().log10().floor()).clamp(0.0, 300.0) as usize;
        let number = |number: f64| format!("{number:.digits$}").parse().unwrap_or(number) + 0.0;
        let tensor = [0, 1, 2].map(|row| [0, 1, 2].map(|column| number(whole[(row, column)])));
        Inertia { centre: rounded(self.centre), tensor }
    }
}

/// An inertia as a body file has it.
pub(super) fn entry(inertia: Inertia) -> InertiaEntry {
    let Inertia { centre, tensor: [[xx, xy, xz], [_, yy, yz], [_, _, zz]] } = inertia;
    let products = [xy, xz, yz];
    InertiaEntry {
        centre: Some(centre),
        moments: [xx, yy, zz],
        products: (products != [0.0; 3]).then_some(products),
    }
}
