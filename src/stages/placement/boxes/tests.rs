//! Test the box around the sensors of a part.

use super::*;

#[test]
fn a_box_holds_its_points_and_lies_along_them() {
    let rotation = Rotation3::from_euler_angles(0.3, -0.7, 1.9);
    let steps = [-1.0, -0.2, 0.4, 1.0];
    let points: Vec<Vector3<f64>> = steps
        .iter()
        .flat_map(|x| steps.iter().map(move |y| Vector3::new(0.5 * x, 0.1 * y, 0.0)))
        .map(|point| rotation * point + Vector3::new(1.0, 2.0, 3.0))
        .collect();
    let found = OrientedBox::around(&points);
    let mut sides: Vec<f64> = found.sides.iter().copied().collect();
    sides.sort_by(f64::total_cmp);
    let expected = [THIN, 0.2, 1.0];
    assert!(sides.iter().zip(expected).all(|(side, expected)| (side - expected).abs() < 1e-9), "{sides:?}");
    assert!((found.centre - Vector3::new(1.0, 2.0, 3.0)).norm() < 1e-9);
    assert!((found.rotation.matrix().determinant() - 1.0).abs() < 1e-9);
    for point in &points {
        let inside = found.rotation.inverse() * (point - found.centre);
        assert!(inside.iter().zip(found.sides.iter()).all(|(at, side)| at.abs() <= side / 2.0 + 1e-9));
    }
    assert_eq!(found.points().count(), 15);
    assert!(found.points().next().is_some_and(|first| (first - found.centre).norm() < 1e-9));
    assert!(points.iter().all(|point| found.distance(point) < 1e-9));
    let beyond = found.centre + found.rotation * (found.sides / 2.0 + Vector3::new(3.0, 4.0, 0.0));
    assert!((found.distance(&beyond) - 5.0).abs() < 1e-9);
    assert_eq!(OrientedBox::around(&points[..1]).sides, Vector3::repeat(THIN));
}
