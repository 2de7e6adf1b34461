//! Test counts of pairs of symbols against their definition.

use rand::RngExt;

use super::*;
use crate::numerics::rng::stream;

fn random_symbols(sensors: usize, samples: usize, levels: usize) -> Symbols {
    let mut rng = stream(5, 1, "symbols", levels);
    let values = (0..sensors * samples).map(|_| rng.random_range(0..levels as u8)).collect();
    Symbols { samples, levels, values }
}

/// Joint counts as equations 25 and 26 define them.
fn by_symbols(symbols: &Symbols, i: usize, j: usize, joint: &mut [u32]) {
    joint.fill(0);
    for t in 0..symbols.samples {
        let level = |sensor: usize| usize::from(symbols.values[sensor * symbols.samples + t]);
        joint[level(i) * symbols.levels + level(j)] += 1;
    }
}

#[test]
fn bit_planes_count_as_the_definition_does_by_any_instructions() {
    for (levels, samples) in [(2, 1), (3, 63), (4, 511), (4, 512), (5, 513), (8, 1000), (10, 1537)] {
        let symbols = random_symbols(19, samples, levels);
        let planes = BitPlanes::new(&symbols);
        let marginals = planes.marginals(&symbols);
        let (mut joint, mut expected) = (vec![0; levels * levels], vec![0; levels * levels]);
        for (i, j) in (0..19).flat_map(|i| (i..19).map(move |j| (i, j))) {
            planes.count(i / TILE * TILE, j / TILE * TILE).joint(i, j, &marginals, &mut joint);
            by_symbols(&symbols, i, j, &mut expected);
            assert_eq!(joint, expected, "N = {levels}, T = {samples}, {i}, {j}");
        }
        let planes: Vec<&[Lanes]> = planes.bits.chunks_exact(planes.length).collect();
        let four = |from: usize| std::array::from_fn(|k| planes[from + k]);
        for from in (0..planes.len()).step_by(BLOCK) {
            let block = Block { first: four(0), second: four(from) };
            assert_eq!(block.count(), block.call(), "chosen and portable instructions");
            assert_eq!(block.count(), Arch::new().dispatch(block), "without VPOPCNTDQ");
        }
    }
}
