use rand::RngExt;

use super::*;
use crate::numerics::rng::stream;

fn random_symbols(sensors: usize, samples: usize, levels: usize) -> Symbols {
    let mut rng = stream(5, 1, "symbols", levels);
    let mut values: Vec<u8> =
        (0..sensors * samples).map(|_| rng.random_range(0..=(levels - 1) as u8)).collect();
    // Sensor 1 mostly copies sensor 0, and the last never changes.
    for t in 0..samples {
        if t % 7 != 0 {
            values[samples + t] = values[t];
        }
        values[(sensors - 1) * samples + t] = 1;
    }
    Symbols { samples, levels, values }
}

/// Joint counts of two sensors as equations 25 and 26 define them.
fn count(symbols: &Symbols, i: usize, j: usize, joint: &mut [u32]) {
    for (&x, &y) in symbols.of(i).iter().zip(symbols.of(j)) {
        joint[usize::from(x) * symbols.levels + usize::from(y)] += 1;
    }
}

/// Equations 23 and 24 as they are written.
fn by_definition(symbols: &Symbols, i: usize, j: usize) -> f64 {
    let (n, total) = (symbols.levels, symbols.samples as f64);
    let mut joint = vec![0; n * n];
    count(symbols, i, j, &mut joint);
    let p = |x: usize, y: usize| f64::from(joint[x * n + y]) / total;
    let mut sum = 0.0;
    for x in 0..n {
        for y in 0..n {
            if p(x, y) > 0.0 {
                let px: f64 = (0..n).map(|y| p(x, y)).sum();
                let py: f64 = (0..n).map(|x| p(x, y)).sum();
                sum -= p(x, y) * (p(x, y) / px).log2() + p(x, y) * (p(x, y) / py).log2();
            }
        }
    }
    sum
}

#[test]
fn agrees_with_the_definition_however_it_counts() {
    for (levels, samples) in
        [(2, 63), (4, 64), (5, 1000), (10, 129), (11, 500), (16, 9000), (40, 500), (256, 300), (3, 1)]
    {
        let symbols = random_symbols(19, samples, levels);
        let distances = information_metric(&symbols);
        assert_eq!(by(&Counting::Planes(BitPlanes::new(&symbols)), &symbols), distances);
        assert_eq!(by(&Counting::Stretches(Stretches::new(&symbols)), &symbols), distances);
        if levels <= runs::MAX_LEVELS {
            assert_eq!(by(&Counting::Runs(Runs::new(&symbols)), &symbols), distances);
        }
        for i in 0..19 {
            assert_eq!(distances.get(i, i), 0.0);
            for j in 0..19 {
                let expected = by_definition(&symbols, i, j);
                assert!((distances.get(i, j) - expected).abs() < 1e-12, "N = {levels}, {i}, {j}");
                assert_eq!(distances.get(i, j), distances.get(j, i));
            }
        }
    }
}

#[test]
fn symbols_that_rarely_change_are_counted_by_their_runs() {
    let mut symbols = random_symbols(19, 6400, 40);
    assert!(matches!(Counting::fastest(&symbols), Counting::Stretches(_)));
    let slow = |(at, _): (usize, &u8)| symbols.values[at - at % 64];
    symbols.values = symbols.values.iter().enumerate().map(slow).collect();
    symbols.levels = 8;
    symbols.values.iter_mut().for_each(|symbol| *symbol %= 8);
    assert!(matches!(Counting::fastest(&symbols), Counting::Runs(_)));
    symbols.levels = 2;
    symbols.values.iter_mut().for_each(|symbol| *symbol %= 2);
    assert!(matches!(Counting::fastest(&symbols), Counting::Planes(_)));
}

#[test]
fn known_joint_distributions() {
    // Two fair independent bits: H(X|Y) = H(Y|X) = 1 bit. A bit and its negation: 0. A bit and a
    // constant: 1 bit.
    let values = [[0, 0, 1, 1], [0, 1, 0, 1], [1, 1, 0, 0], [0, 0, 0, 0]].concat();
    let distances = information_metric(&Symbols { samples: 4, levels: 2, values });
    assert_eq!(distances.values[..4], [0.0, 2.0, 0.0, 1.0]);
}

#[test]
fn the_triangle_inequality_holds() {
    let distances = information_metric(&random_symbols(12, 200, 4));
    for (x, y, z) in (0..12).flat_map(|x| (0..12).flat_map(move |y| (0..12).map(move |z| (x, y, z)))) {
        assert!(distances.get(x, z) <= distances.get(x, y) + distances.get(y, z) + 1e-12);
    }
}
