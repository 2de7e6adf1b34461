use super::super::memory::Memory;
use super::*;
use crate::stages::parameters::Parameters;

#[test]
fn samples_are_parted_by_speed() {
    // Speeds of the second and third sensor: 2, 12, 1, 3. The first is not asked for.
    let values = Mat::from_fn(4, 3, |t, sensor| if sensor == 0 { 9.0 } else { [2.0, 4.0, 1.0, 3.0][t] });
    let roots = Roots { values, thresholds: vec![0.1, 0.2, 0.3, 0.4], signed: false };
    let completed = Mat::from_fn(4, 3, |t, sensor| (10 * t + sensor) as f64);
    let felt = Felt {
        roots,
        completed,
        sizes: vec![1.0, 3.0, 1.0, 1.0],
        tolerance: 1e-3,
        iterations: [1, 2],
        parameters: Parameters::default(),
        memory: Memory::default(),
    };
    let [slow, fast] = halves(&felt, &[1, 2]);
    assert_eq!(slow.roots.values, Mat::from_fn(2, 2, |t, _| [2.0, 1.0][t]));
    assert_eq!(slow.roots.thresholds, [0.1, 0.3]);
    assert_eq!(slow.completed, Mat::from_fn(2, 2, |t, sensor| (20 * t + sensor + 1) as f64));
    assert_eq!((slow.sizes, slow.tolerance), (vec![1.0; 2], 1e-3));
    assert_eq!(fast.roots.values, Mat::from_fn(2, 2, |t, _| [4.0, 3.0][t]));
}
