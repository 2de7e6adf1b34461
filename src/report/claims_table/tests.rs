//! Rows of claims for machines and for people, and the comparison with the published rate.

use super::*;
use crate::analysis::claims::judge;
use crate::analysis::conditions::Conditions;
use crate::analysis::measure::Evidence;
use crate::analysis::one_body::{OneBody, SingleBodies};
use crate::analysis::published::Experiment;
use crate::analysis::statistics::rate;
use crate::pipeline::Record;
use crate::stages::schema::{Model, Sampler};

/// A posterior sample of DPGMM-LJ at d = 14 and p = 0.9; `right` says whether its tree is right, if it is eligible.
fn sample(simulation: usize, chain: usize, right: Option<bool>) -> Record {
    Record {
        simulation,
        coordination: 0.9,
        dimension: 14,
        model: Model::DpgmmLj,
        chain,
        sweep: 1,
        parts: 5,
        log_posterior: Some(-(chain as f64)),
        ari: if right.is_some() { 1.0 } else { 0.9 },
        eligible: right.is_some(),
        tree_correct: right == Some(true),
    }
}

fn judged(records: Vec<Record>) -> Vec<Judged> {
    let simulations = records.iter().map(|record| record.simulation).max().unwrap_or(1);
    let conditions = Conditions::new(records, simulations, 1);
    judge(Experiment::Exp1, &Evidence { conditions, baselines: Vec::new(), reading: Sampler::Equations })
}

/// 20 eligible posterior samples of one simulation, of which the last is wrong.
pub(crate) fn nineteen_of_twenty() -> Vec<Judged> {
    judged((0..20).map(|chain| sample(1, chain, Some(chain < 19))).collect())
}

/// Without an eligible sample.
pub(crate) fn no_eligible_sample() -> Vec<Judged> {
    judged(vec![sample(1, 0, None)])
}

#[test]
fn a_row_of_all_draws_has_numbers_for_machines_and_percent_for_people() {
    let row = &rows(&nineteen_of_twenty())[0];
    assert_eq!((row.id.as_str(), row.counting), ("tree-accuracy", Counting::AllDraws));
    assert_eq!((row.unit, row.published, row.wording.as_str()), (Some(Unit::Rate), Some(0.846), "84.6 %"));
    assert_eq!((row.value, row.cells.n, row.cells.simulations), (Some(0.95), 20, 1));
    assert_eq!(row.accepted(), Some((0.746, 0.946)));
    assert_eq!(row.verdict, Some(Verdict::NotReproduced));
    let people = [
        "not reproduced",
        "Tree accuracy of DPGMM-LJ at p = 0.9, d = 14, equations interpretation",
        "84.6 %",
        "95.0 %",
        "76.4 to 99.1 %",
        "20",
        "",
        "74.6 to 94.6 %",
        "",
        "d = 14",
        "figure 11b, section 6.2 and abstract",
    ];
    assert_eq!(row.in_words(), people);
}

#[test]
fn a_row_says_how_often_single_bodies_show_the_claim() {
    let mut judged = nineteen_of_twenty();
    let share = |seen| rate(seen, 4);
    judged[0].single_bodies = Some(SingleBodies { alone: share(1), together: share(0) });
    let row = &rows(&judged)[0];
    assert_eq!((row.bodies, row.bodies_share, row.bodies_together), (Some(4), Some(0.25), Some(0.0)));
    assert_eq!(row.one_body, Some(OneBody::Possible));
    let words = &row.in_words()[8];
    assert_eq!(words, "1 of 4 (4.6 to 69.9 %); none shows all claims");
    judged[0].single_bodies = Some(SingleBodies { alone: rate(0, 0), together: rate(0, 0) });
    assert_eq!(rows(&judged)[0].in_words()[8], "");
}

#[test]
fn a_claim_that_counts_samples_is_followed_by_its_best_samples() {
    // The best sample of both simulations is that of chain 0; the simulations differ in the other.
    let records = vec![
        sample(1, 0, Some(true)),
        sample(1, 1, Some(false)),
        sample(2, 0, Some(true)),
        sample(2, 1, Some(true)),
    ];
    let rows = rows(&judged(records));
    let (all, best) = (&rows[0], &rows[1]);
    assert_eq!((all.value, all.cells.n, all.cells.simulations), (Some(0.75), 4, 2));
    assert_eq!((all.cells.lowest, all.cells.highest), (Some(0.5), Some(1.0)));

    assert_eq!((best.id.as_str(), best.counting), ("tree-accuracy", Counting::BestDraw));
    assert_eq!((best.value, best.cells.n, best.unit), (Some(1.0), 2, Some(Unit::Rate)));
    assert_eq!(
        (best.published, best.wording.as_str(), best.accepted(), best.verdict),
        (None, "", None, None)
    );
    let [verdict, claim, published, reproduced, _, n, _, accepted, ..] = best.in_words();
    assert_eq!([&verdict, &published, &reproduced, &n, &accepted], ["extension", "", "100 %", "2", ""]);
    assert!(claim.ends_with("d = 14, equations interpretation: most probable sample"), "{claim}");

    // Only claims that count posterior samples have a second row.
    let of = |id| rows.iter().filter(|row| row.id == id).count();
    assert_eq!((of("number-of-parts"), of("number-of-parts-2d")), (2, 1));
}

#[test]
fn a_claim_without_draws_says_so_and_nowhere_none() {
    let judged = no_eligible_sample();
    let rows = rows(&judged);
    let [verdict, _, _, reproduced, interval, n, spread, accepted, _, found, _] = rows[0].in_words();
    assert_eq!([&verdict, &reproduced, &interval, &n, &spread], ["not testable", "–", "", "0", ""]);
    assert_eq!((accepted.as_str(), found.as_str()), ("74.6 to 94.6 %", "no value: d = 14"));
    let by_eye = rows.iter().find(|row| row.id == "natural-movement").unwrap();
    assert_eq!((by_eye.unit, by_eye.accepted(), by_eye.in_words()[5].as_str()), (None, None, ""));

    let table = terminal_table(&rows);
    assert!(table.starts_with("verdict "), "{table}");
    assert!(table.contains("\nnot testable | tree-accuracy "), "{table}");
    assert!(table.contains("\nextension    | tree-accuracy "), "{table}");
}

#[test]
fn a_quick_run_illustrates_and_judges_nothing() {
    let rows = illustrated(rows(&nineteen_of_twenty()));
    let verdicts: Vec<&str> = rows.iter().map(Row::verdict_in_words).collect();
    assert!(verdicts.contains(&"illustration") && verdicts.contains(&"extension"), "{verdicts:?}");
    assert!(!terminal_table(&rows).contains("not reproduced"));
}

#[test]
fn a_table_is_read_back_as_it_was_written() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("claims.csv");
    for judged in [nineteen_of_twenty(), no_eligible_sample()] {
        let rows = rows(&judged);
        crate::files::tables::write_rows(&path, &rows).unwrap();
        assert_eq!(crate::files::tables::read_rows::<Row>(&path).unwrap(), rows);
    }
    let text = std::fs::read_to_string(&path).unwrap();
    let header = "id,counting,reading,figure,place,statement,unit,published,wording,value,n,low,high,simulations,lowest,\
                  highest,accepted_low,accepted_high,verdict,found,bodies,bodies_share,bodies_low,bodies_high,\
                  bodies_together,one_body";
    assert_eq!(text.lines().next(), Some(header));
}
