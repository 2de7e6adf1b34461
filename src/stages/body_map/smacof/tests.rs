//! Test what majorisation promises, with broken twins that do not keep it.

use rand::RngExt;

use super::super::classical::ClassicalScaling;
use super::*;
use crate::numerics::rng::stream;

const FITS: [Fit; 2] = [Fit::Metric, Fit::Nonmetric];

fn distances(n: usize, between: impl Fn(usize, usize) -> f64) -> Distances {
    Distances { sensors: n, values: (0..n * n).map(|at| between(at / n, at % n)).collect() }
}

/// City-block distances between points on a coarse grid: not Euclidean, with ties and with points that coincide.
fn city_block(n: usize) -> Distances {
    let mut rng = stream(1, 1, "city block", 0);
    let points: Vec<f64> = (0..n * 6).map(|_| f64::from(rng.random_range(0..4))).collect();
    let pairs = |i: usize, j: usize| points[6 * i..][..6].iter().zip(&points[6 * j..][..6]);
    distances(n, |i, j| pairs(i, j).map(|(a, b)| (a - b).abs()).sum())
}

fn classical(distances: &Distances, dims: usize) -> BodyMap {
    ClassicalScaling::new(distances, dims).unwrap().coordinates(dims).unwrap()
}

#[test]
fn no_step_raises_the_stress() {
    let distances = city_block(40);
    // The largest rise of raw stress or stress-1 in a step, of which each is as long as it should be or longer.
    let largest_rise = |fit, times: f64| {
        let mut state = Majorisation::new(&distances, classical(&distances, 3), fit);
        let rise = |_| {
            let old = state.map.coordinates.clone();
            let before = [state.raw_stress(), state.stress()];
            state.step();
            let coordinates = &mut state.map.coordinates;
            coordinates.iter_mut().zip(&old).for_each(|(new, old)| *new = old + times * (*new - old));
            state.within = euclidean(&state.map);
            if let Some(monotone) = &mut state.monotone {
                monotone.fit(&state.within);
            }
            let after = [state.raw_stress(), state.stress()];
            (0..2).map(|k| (after[k] - before[k]) / before[k]).fold(f64::NEG_INFINITY, f64::max)
        };
        (0..200).map(rise).fold(f64::NEG_INFINITY, f64::max)
    };
    for fit in FITS {
        assert!(largest_rise(fit, 1.0) < 1e-12, "{fit:?}: {:e}", largest_rise(fit, 1.0));
        assert!(largest_rise(fit, 3.0) > 1e-3, "{fit:?}: steps that are too long are seen");
    }
}

/// With numbers of points that fill the tiles and that do not.
#[test]
fn steps_that_compute_each_pair_once_are_those_of_majorisation() {
    // Whole and partly filled blocks of 8 points, and of rows and chunks of coordinates; more blocks than one thread moves.
    for (n, dims) in [(5, 2), (8, 3), (9, 1), (20, 6), (20, 7), (20, 8), (40, 3), (67, 9), (530, 2)] {
        let distances = city_block(n);
        let mut rng = stream(1, 1, "start", n);
        let start = BodyMap { dims, coordinates: (0..n * dims).map(|_| rng.random()).collect() };
        let mut found = Guttman::new(&distances, &start);
        let mut expected = Majorisation::new(&distances, start, Fit::Metric);
        for _ in 0..20 {
            let stress = expected.raw_stress();
            assert!((found.step() / stress - 1.0).abs() < 1e-12, "{n} points");
            expected.step();
            let off = found.map().coordinates.into_iter().zip(&expected.map().coordinates);
            assert!(off.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max) < 1e-11, "{n} points");
        }
    }
}

#[test]
fn stress_is_less_than_the_classical_map_s_and_hardly_changes_any_more() {
    let distances = city_block(40);
    for fit in FITS {
        let (map, found) = smacof(&distances, classical(&distances, 3), fit);
        assert!(found.stress < 0.9 * found.start, "{fit:?}: {found:?}");
        assert!(found.dimension == 3 && map.dims == 3 && map.points() == 40);
        let mut state = Majorisation::new(&distances, map, fit);
        if found.steps < MAX_STEPS && fit == Fit::Metric {
            assert!((state.stress() - found.stress).abs() < 1e-12);
            let before = state.raw_stress();
            state.step();
            assert!(before - state.raw_stress() <= TOLERANCE * before);
        }
    }
}

#[test]
fn a_planted_configuration_stays_where_it_is() {
    let mut rng = stream(1, 1, "planted", 0);
    let planted = BodyMap { dims: 3, coordinates: (0..90).map(|_| rng.random_range(-1.0..1.0)).collect() };
    let distances = Distances { sensors: 30, values: euclidean(&planted) };
    let start = classical(&distances, 3);
    let moved = |distances: &Distances, fit| {
        let (map, found) = smacof(distances, start.clone(), fit);
        let ways = map.coordinates.iter().zip(&start.coordinates).map(|(new, old)| (new - old).abs());
        (ways.fold(0.0, f64::max), found)
    };
    for fit in FITS {
        let (way, found) = moved(&distances, fit);
        assert!(way < 1e-12 && found.stress < 1e-12 && found.start < 1e-12, "{fit:?}: {way:e}, {found:?}");
    }
    let mut other = distances.clone();
    (other.values[1], other.values[30]) = (3.0, 3.0);
    for fit in FITS {
        assert!(moved(&other, fit).0 > 1e-3, "{fit:?}: another distance is seen");
    }
}

#[test]
fn only_the_order_of_distances_decides_a_nonmetric_map() {
    let first = city_block(30);
    let start = classical(&first, 2);
    for rising in [|d: f64| d.powi(3), |d: f64| (d / 10.0).exp_m1(), |d: f64| 1e3 * d] {
        let values = first.values.iter().map(|d| rising(*d)).collect();
        let second = Distances { sensors: 30, values };
        let both = |fit| [&first, &second].map(|distances| smacof(distances, start.clone(), fit));
        let [one, other] = both(Fit::Nonmetric);
        assert_eq!(one, other);
        let [one, other] = both(Fit::Metric);
        assert!(one != other, "metric scaling sees more than the order");
    }
}

#[test]
fn a_nonmetric_map_keeps_the_scale_of_the_map_it_starts_from() {
    let distances = city_block(40);
    let start = classical(&distances, 3);
    let sum_of_squares = |matrix: &[f64]| sum_over_pairs(matrix, matrix, 40, |a, b| a * b);
    let squares = |map: &BodyMap| sum_of_squares(&euclidean(map));
    let mut state = Majorisation::new(&distances, start.clone(), Fit::Nonmetric);
    for _ in 0..100 {
        state.step();
        assert!((sum_of_squares(state.disparities()) / squares(&start) - 1.0).abs() < 1e-12);
    }
    let ratio = squares(state.map()) / squares(&start);
    assert!((0.9..=1.0).contains(&ratio), "{ratio}");
}

#[test]
fn the_number_of_threads_changes_no_bit() {
    let distances = city_block(150);
    let start = classical(&distances, 4);
    for fit in FITS {
        let on = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| smacof(&distances, start.clone(), fit))
        };
        let one = on(1);
        assert!(one.1.steps > 5);
        assert_eq!(one, on(3));
    }
}

#[test]
fn equal_distances_and_points_that_coincide_give_numbers() {
    let simplex = |n| distances(n, |i, j| f64::from(u8::from(i != j)));
    // Three places of several points each; and a start that puts apart points in one place.
    let places = distances(9, |i, j| (i % 3).abs_diff(j % 3) as f64);
    let together = BodyMap { dims: 1, coordinates: (0..9).map(|i| f64::from(i / 3)).collect() };
    let cases = [
        (simplex(2), classical(&simplex(2), 1)),
        (simplex(12), classical(&simplex(12), 3)),
        (places.clone(), classical(&places, 1)),
        (places, together),
        (distances(3, |_, _| 0.0), BodyMap { dims: 2, coordinates: vec![0.0, 1.0, 2.0, 0.0, 0.0, 3.0] }),
    ];
    for (at, (distances, start)) in cases.into_iter().enumerate() {
        for fit in FITS {
            let (map, found) = smacof(&distances, start.clone(), fit);
            assert!(map.coordinates.iter().all(|x| x.is_finite()), "{at}, {fit:?}");
            assert!(found.stress.is_finite() && found.stress <= found.start, "{at}, {fit:?}: {found:?}");
        }
    }
    // All pairs are tied, so that any map agrees with their order, and none has to move.
    let start = classical(&simplex(12), 3);
    assert_eq!(smacof(&simplex(12), start, Fit::Nonmetric).1.stress, 0.0);
}

#[test]
fn tied_pairs_may_have_any_disparities() {
    // On a line at 0, 1, 3, 7: pairs 01, 02 and 12 are tied, and so are 03, 13 and 23.
    let tied = distances(4, |i, j| if i == j { 0.0 } else { f64::from(u8::from(i.max(j) == 3)) + 1.0 });
    let line = BodyMap { dims: 1, coordinates: vec![0.0, 1.0, 3.0, 7.0] };
    let state = Majorisation::new(&tied, line.clone(), Fit::Nonmetric);
    assert_eq!((state.stress(), state.disparities()), (0.0, &euclidean(&line)[..]));
    // The other way round, the first three pairs should be farther than the others: all are at the mean.
    let reversed = distances(4, |i, j| if i == j { 0.0 } else { 2.0 - f64::from(u8::from(i.max(j) == 3)) });
    let state = Majorisation::new(&reversed, line, Fit::Nonmetric);
    // 4, 6, 7 before 1, 2, 3, of mean 23/6, and Σ d² = 115.
    let expected = ((115.0 - 6.0 * (23.0_f64 / 6.0).powi(2)) / 115.0).sqrt();
    assert!((state.stress() - expected).abs() < 1e-12);
}
