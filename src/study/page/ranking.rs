//! The section of the ranking: configurations by their score.

use super::super::ranking::{Ranking, scored};
use super::super::results::{ClaimRow, Results};
use crate::analysis::claims::Verdict;
use crate::report::markdown::{number, row, rule};

/// Configurations that are shown.
const SHOWN: usize = 100;

/// The best configurations, with their value of each scored claim.
pub(super) fn section(results: &Results, ranking: &Ranking) -> Vec<String> {
    let scored = scored(&results.design);
    let names = scored.iter().map(|(_, judged)| judged.id.as_str());
    let mut lines = vec![
        "\n## Ranking\n".to_owned(),
        "The score is the weighted share of reproduced claims, with partial credit for values close to their accepted range. The \
         design has the weights. Bold: within the accepted range. *Unresolved*: the movement is too fast for the time step (joint \
         anchors separate by more than 1 cm, or a part rotates by more than a tenth of a revolution in a step); such a configuration \
         never wins. All: [ranking.csv](ranking.csv).\n"
            .to_owned(),
    ];
    let header: Vec<&str> = ["configuration", "score"].into_iter().chain(names).chain(["settings"]).collect();
    lines.extend([row(&header), rule(header.len())]);
    for ranked in ranking.rows.iter().take(SHOWN) {
        let place = results.configurations.iter().position(|one| one.number == ranked.configuration);
        let place = place.expect("it is one of them");
        let own = &results.configurations[place];
        let failed = match own.failed {
            0 if own.resolved => String::new(),
            0 => format!("; unresolved: {:.0} mm, {:.2} revolutions", 1e3 * own.anchor_separation, own.turn),
            failed => format!("; {failed} simulations failed: {}", own.failure),
        };
        let claims = results.claims_of(place);
        let mut cells = vec![ranked.name.clone(), format!("{:.3}", ranked.score)];
        cells.extend(scored.iter().map(|&(at, _)| value(&claims[at])));
        cells.push(format!("{}{failed}", ranked.settings));
        lines.push(row(cells));
    }
    lines
}

/// A configuration's value of a claim.
fn value(claim: &ClaimRow) -> String {
    let value = claim.value.map_or("none".to_owned(), |value| number(Some(value)));
    if claim.verdict == Verdict::Reproduced { format!("**{value}**") } else { value }
}
