use super::*;

const SHAPES: [Shape; 4] = [
    Shape::Cylinder { radius: 0.1, length: 0.4 },
    Shape::Capsule { radius: 0.1, length: 0.4 },
    Shape::Sphere { radius: 0.1 },
    Shape::Box { sides: [0.1, 0.2, 0.4] },
];

/// The sum over places of the normal, and of position times normal, each place with its share of the area. By Gauss's
/// theorem these are 0 and three times the volume.
fn sums(shape: Shape, spots: &[Spot]) -> (f64, f64) {
    let share = shape.area() / spots.len() as f64;
    let normal = [0, 1, 2].map(|i| spots.iter().map(|spot| spot.normal[i] * share).sum::<f64>());
    let flux = |spot: &Spot| (0..3).map(|i| spot.normal[i] * spot.position[i]).sum::<f64>();
    (normal.iter().map(|x| x * x).sum::<f64>().sqrt(), spots.iter().map(|spot| flux(spot) * share).sum())
}

fn volume(shape: Shape) -> f64 {
    match shape {
        Shape::Cylinder { radius, length } => PI * radius * radius * length,
        Shape::Capsule { radius, length } => PI * radius * radius * (length + 4.0 / 3.0 * radius),
        Shape::Sphere { radius } => 4.0 / 3.0 * PI * radius.powi(3),
        Shape::Box { sides } => sides.iter().product(),
    }
}

#[test]
fn places_share_the_surface_evenly() {
    for shape in SHAPES {
        let spots = shape.spread(2000);
        assert_eq!(spots.len(), 2000);
        let (normal, flux) = sums(shape, &spots);
        assert!(normal < 0.003 * shape.area(), "{shape:?}: {normal}");
        assert!((flux / (3.0 * volume(shape)) - 1.0).abs() < 0.003, "{shape:?}: {flux}");
        // The broken twin: places on one half only.
        let half: Vec<Spot> = spots.into_iter().filter(|spot| spot.position[2] < 0.0).collect();
        assert!(sums(shape, &half).0 > 0.1 * shape.area(), "{shape:?}");
    }
}

#[test]
fn no_two_places_are_much_nearer_than_others() {
    for shape in SHAPES {
        for count in [40, 168] {
            let spots = shape.spread(count);
            let apart = |a: &Spot, b: &Spot| {
                (0..3).map(|i| (a.position[i] - b.position[i]).powi(2)).sum::<f64>().sqrt()
            };
            let nearest = spots
                .iter()
                .enumerate()
                .flat_map(|(at, a)| spots.iter().skip(at + 1).map(move |b| apart(a, b)));
            let pitch = (shape.area() / count as f64).sqrt();
            let nearest = nearest.fold(f64::INFINITY, f64::min);
            assert!(nearest > 0.5 * pitch, "{shape:?}, {count}: {nearest} of {pitch}");
        }
    }
}

#[test]
fn normals_have_length_one_and_few_places_are_no_mistake() {
    for shape in SHAPES {
        for count in 0..8 {
            let spots = shape.spread(count);
            assert_eq!(spots.len(), count, "{shape:?}");
            for Spot { normal, .. } in spots {
                assert!((normal.iter().map(|x| x * x).sum::<f64>() - 1.0).abs() < 1e-12, "{shape:?}");
            }
        }
    }
}
