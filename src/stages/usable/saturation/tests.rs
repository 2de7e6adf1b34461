//! Test which values count as saturated, and which do not.

use super::*;

/// What a sensor feels of a movement.
fn touch() -> Vec<f32> {
    let speed = |t: f32| (0.05 * t).sin() + (0.031 * t).sin();
    (0..2000).map(|t: u16| speed(f32::from(t)).max(0.0).powi(2)).collect()
}

fn removed(series: &[f32]) -> (Vec<usize>, usize) {
    let mut own = series.to_vec();
    let count = remove(&mut own);
    assert!(own.iter().zip(series).all(|(own, before)| own.is_nan() || own == before));
    ((0..own.len()).filter(|t| own[*t].is_nan()).collect(), count)
}

#[test]
fn what_is_cut_at_the_end_of_a_range_is_missing() {
    let whole = touch();
    for sign in [1.0, -1.0] {
        let cut: Vec<f32> = whole.iter().map(|pressure| sign * pressure.min(2.5)).collect();
        let above: Vec<usize> = (0..whole.len()).filter(|t| whole[*t] >= 2.5).collect();
        assert!(above.len() > 50);
        assert_eq!(removed(&cut), (above.clone(), above.len()));
    }
    // Both ends of a sensor with a sign, in whole numbers.
    let signed: Vec<f32> =
        (0..2000).map(|t: u16| (600.0 * (0.05 * f32::from(t)).sin()).round().clamp(-512.0, 511.0)).collect();
    let ends = signed.iter().filter(|value| [-512.0, 511.0].contains(*value)).count();
    assert_eq!(removed(&signed).1, ends);
}

#[test]
fn what_is_not_cut_stays() {
    let whole = touch();
    let rounded: Vec<f32> = whole.iter().map(|pressure| (20.0 * pressure).round()).collect();
    let coarse: Vec<f32> = whole.iter().map(|pressure| (3.0 * pressure).floor()).collect();
    let levels: Vec<f32> = whole.iter().map(|pressure| pressure.round()).collect();
    let offset: Vec<f32> = whole.iter().map(|pressure| pressure - 0.3).collect();
    let holes: Vec<f32> =
        whole.iter().enumerate().map(|(t, own)| if t % 3 == 0 { f32::NAN } else { *own }).collect();
    for series in
        [whole, rounded, coarse, levels, offset, holes, vec![0.0; 9], vec![5.0; 9], vec![f32::NAN; 9]]
    {
        let mut own = series.clone();
        assert_eq!(remove(&mut own), 0, "{:?}", &series[..9]);
    }
}
