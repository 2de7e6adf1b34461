//! Test the sentence and the table of the headline.

use super::super::claims_table::tests::{nineteen_of_twenty, no_eligible_sample};
use super::super::claims_table::{illustrated, rows};
use super::*;

#[test]
fn the_sentence_has_rate_interval_and_verdict_and_the_table_the_differences() {
    let rows = rows(&nineteen_of_twenty());
    let headline = Headline::of(&rows).unwrap();
    assert_eq!(
        headline.sentence,
        "95.0 % of 20 eligible samples at p = 0.9 and d = 14 recover the true tree (95 % interval over the chains of one \
         simulation: 76.4 to 99.1 %); the paper reports 84.6 %. This lies outside the accepted range, 74.6 to 94.6 %: \
         not reproduced."
    );
    let table = headline.in_terminal();
    for line in [
        "\npublished                                   84.6 %\n",
        "\nverdict                                     not reproduced\n",
        "\ndifference, if the published rate is 11/13  +10.4 points (",
    ] {
        assert!(table.contains(line), "{table} lacks {line}");
    }
    assert!(headline.in_markdown().contains("\n| reproduced | 95.0 % |\n"), "{}", headline.in_markdown());
    // A quick run judges nothing.
    let quick = Headline::of(&illustrated(rows)).unwrap();
    assert!(quick.sentence.ends_with("the paper reports 84.6 %."), "{}", quick.sentence);
    assert!(!quick.in_terminal().contains("reproduced\n"), "{}", quick.in_terminal());
}

#[test]
fn without_an_eligible_sample_nothing_is_judged() {
    let headline = Headline::of(&rows(&no_eligible_sample())).unwrap();
    assert!(headline.sentence.starts_with("There is no eligible sample at p = 0.9"), "{headline:?}");
    assert_eq!(Headline::of(&[]), None);

    let page = claims_page("What was run.", &rows(&no_eligible_sample()));
    assert!(page.starts_with("**There is no eligible sample at p = 0.9"), "{page}");
    assert!(page.contains("\n\nWhat was run.\n\n| verdict | claim | published | reproduced |"), "{page}");
    assert!(!page.contains("| none |"), "{page}");
}
