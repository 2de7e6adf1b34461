//! Test places on a surface, and their areas.

use super::*;

#[test]
fn places_have_the_area_and_the_volume_of_the_shape() {
    for shape in [
        Shape::Cylinder { radius: 0.1, length: 0.4 },
        Shape::Capsule { radius: 0.1, length: 0.4 },
        Shape::Sphere { radius: 0.1 },
        Shape::Box { sides: [0.1, 0.2, 0.4] },
    ] {
        let places = places(&shape);
        let radius = match shape {
            Shape::Cylinder { radius, .. } | Shape::Capsule { radius, .. } => radius,
            Shape::Sphere { .. } | Shape::Box { .. } => 0.0,
        };
        // A ring of radius r and width h has the area 2 π r h.
        let side = TAU * side(&shape).iter().map(|(_, ring)| ring).sum::<f64>();
        let area = side + places.iter().map(|(_, area)| area).sum::<f64>();
        assert!((area / shape.area() - 1.0).abs() < 1e-12, "{shape:?}: {area}");
        for axis in 0..3 {
            let sum: f64 = places.iter().map(|(spot, area)| spot.normal[axis] * area).sum();
            assert!(sum.abs() < 1e-12 * area, "{shape:?}: {sum}");
        }
        // Gauss: the integral of position · normal is three times the volume.
        let flux = |spot: &Spot| (0..3).map(|i| spot.normal[i] * spot.position[i]).sum::<f64>();
        let volume = places.iter().map(|(spot, area)| flux(spot) * area).sum::<f64>();
        let volume = (volume + side * radius) / 3.0;
        let right = match shape {
            Shape::Cylinder { radius, length } => PI * radius * radius * length,
            Shape::Capsule { radius, length } => PI * radius * radius * (length + 4.0 / 3.0 * radius),
            Shape::Sphere { radius } => 4.0 / 3.0 * PI * radius.powi(3),
            Shape::Box { sides } => sides.iter().product(),
        };
        assert!((volume / right - 1.0).abs() < 0.01, "{shape:?}: {volume} {right}");
    }
}
