//! Bodies that nothing was chosen on: in what share of chains the parts are exactly the true ones, after how long.

use std::error::Error;
use std::path::Path;
use std::time::Instant;

use bodyschema::files::tables::write_rows;
use bodyschema::internals::markdown::{row, rule};
use bodyschema::internals::statistics::{Estimate, mean, wilson};
use bodyschema::internals::{Posterior, consensus};
use bodyschema::pipeline::{MappedBody, map_sensed, simulate_and_sense};
use bodyschema::stages::body_map::MapOf;
use bodyschema::stages::evaluate::{adjusted_rand_index, parts, score};
use bodyschema::stages::schema::{Keep, Model, Schema, infer};

use super::{no_fluid, split_merge};

/// Of the movements; nothing else has it.
const SEED: u64 = 7_100_000;
const BODIES: usize = 20;
const DIMENSIONS: [usize; 7] = [4, 5, 6, 7, 9, 11, 14];
/// Sweeps after which chains are asked.
const SWEEPS: [usize; 4] = [25, 50, 100, 200];

/// What a chain of a body says after some sweeps: the consensus of the later half of its draws.
#[derive(serde::Serialize)]
struct ChainRow {
    body: usize,
    dimension: usize,
    chain: usize,
    sweeps: usize,
    parts: usize,
    ari: f64,
    exact: bool,
    /// Share of these draws that are exactly the truth.
    exact_draws: f64,
}

/// What all chains of a body say together.
#[derive(serde::Serialize)]
struct PosteriorRow {
    body: usize,
    dimension: usize,
    parts: usize,
    ari: f64,
    exact: bool,
    tree_right: bool,
    tree_probability: f64,
    worst_r_hat: Option<f64>,
    least_ess: Option<f64>,
    mixed: bool,
}

/// A dimension.
struct Condition {
    dimension: usize,
    chains: Vec<ChainRow>,
    posteriors: Vec<PosteriorRow>,
    seconds_per_sweep: f64,
}

/// Runs the study, writes its tables, and returns its section of the page.
pub(crate) fn study(folder: &Path) -> Result<String, Box<dyn Error>> {
    let mut settings = no_fluid();
    (settings.schema, settings.experiment.seed, settings.map.of) = (split_merge(), SEED, MapOf::Distances);
    let mut conditions: Vec<Condition> = DIMENSIONS
        .map(|dimension| Condition {
            dimension,
            chains: Vec::new(),
            posteriors: Vec::new(),
            seconds_per_sweep: f64::INFINITY,
        })
        .into();
    for body in 1..=BODIES {
        let felt = simulate_and_sense(&settings, body, &|| ())?;
        let mapped = map_sensed(&felt, &settings, body, &DIMENSIONS)?.body;
        for condition in &mut conditions {
            infer_all(&mapped, body, &settings.schema, condition)?;
        }
        eprintln!("mixing: body {body} of {BODIES} done");
    }
    let chains = conditions.iter().flat_map(|condition| &condition.chains);
    write_rows(&folder.join("bodies-chains.csv"), chains)?;
    let posteriors = conditions.iter().flat_map(|condition| &condition.posteriors);
    write_rows(&folder.join("bodies-posterior.csv"), posteriors)?;
    Ok(page(&conditions, settings.schema.chains))
}

/// Runs the chains of one body in one dimension.
fn infer_all(
    body: &MappedBody,
    number: usize,
    schema: &Schema,
    condition: &mut Condition,
) -> Result<(), Box<dyn Error>> {
    let map = body.maps.as_ref().ok_or("a body that moves has a map")?.in_dims(condition.dimension);
    let last = SWEEPS[SWEEPS.len() - 1];
    let settings = Schema { sweeps: last, keep: Keep::All, burn_in: 0, ..schema.clone() };
    let draws = infer(&map, Model::DpgmmLj, &settings, SEED, number, &|| ())?;
    for (own, sweeps) in
        draws.chunk_by(|a, b| a.chain == b.chain).flat_map(|own| SWEEPS.map(|sweeps| (own, sweeps)))
    {
        let kept: Vec<&[usize]> = own[sweeps / 2..sweeps].iter().map(|draw| draw.labels.as_slice()).collect();
        let ari = |labels: &[usize]| adjusted_rand_index(labels, &body.truth.labels);
        let answer = consensus(&kept).labels;
        condition.chains.push(ChainRow {
            body: number,
            dimension: condition.dimension,
            chain: own[0].chain,
            sweeps,
            parts: parts(&answer),
            ari: ari(&answer),
            exact: ari(&answer) == 1.0,
            exact_draws: kept.iter().filter(|labels| ari(labels) == 1.0).count() as f64 / kept.len() as f64,
        });
    }
    let kept: Vec<_> = draws.into_iter().filter(|draw| draw.sweep > last / 2).collect();
    let posterior = Posterior::of(&map, Model::DpgmmLj, &kept, &settings, SEED, number)?;
    let summary = posterior.summary();
    let score = score(&summary.labels, &summary.tree, &body.truth, 1.0);
    let mixing = || posterior.mixing.iter().map(|(_, mixing)| mixing);
    condition.posteriors.push(PosteriorRow {
        body: number,
        dimension: condition.dimension,
        parts: parts(&posterior.consensus.labels),
        ari: score.ari,
        exact: score.eligible,
        tree_right: score.tree_correct,
        tree_probability: posterior.tree.as_ref().map_or(1.0, |tree| tree.probability),
        worst_r_hat: mixing().filter_map(|mixing| mixing.r_hat).reduce(f64::max),
        least_ess: mixing().filter_map(|mixing| mixing.ess).reduce(f64::min),
        mixed: posterior.unmixed().is_none(),
    });
    if number == 1 {
        // One chain, on a thread of its own.
        let settings = Schema { chains: 1, sweeps: 100, keep: Keep::Last, ..schema.clone() };
        let before = Instant::now();
        infer(&map, Model::DpgmmLj, &settings, SEED, number, &|| ())?;
        condition.seconds_per_sweep = before.elapsed().as_secs_f64() / settings.sweeps as f64;
    }
    Ok(())
}

fn page(conditions: &[Condition], chains: usize) -> String {
    let mut lines = vec![
        "## Simulations that nothing was chosen on\n".to_owned(),
        format!(
            "{BODIES} simulations of a former default ([no-fluid.toml](reproduce/no-fluid.toml); seed {SEED}), with maps of the \
             distances and {chains} chains each. Chains start from one part, from k-means, and from labels at random. The \
             estimate of a chain is the consensus of the later half of its samples. The table has the share of chains with \
             all sensors on their true parts, after so many sweeps. Intervals are Wilson's of {BODIES} trials, the \
             simulations. [All chains](bodies-chains.csv).\n"
        ),
    ];
    let sweeps = SWEEPS.map(|sweeps| format!("{sweeps} sweeps"));
    lines.push(row(["d".to_owned(), "ms a sweep".to_owned(), "sweeps in a second".to_owned()]
        .into_iter()
        .chain(sweeps)));
    lines.push(rule(3 + SWEEPS.len()));
    lines.extend(conditions.iter().map(|condition| {
        let seconds = condition.seconds_per_sweep;
        let head = [
            condition.dimension.to_string(),
            format!("{:.2}", 1e3 * seconds),
            format!("{:.0}", 1.0 / seconds),
        ];
        row(head.into_iter().chain(SWEEPS.map(|sweeps| percent(&condition.exact_after(sweeps)))))
    }));
    lines.push(format!(
        "\nThe estimates of all chains of a simulation together, from sweep {} on. Mixed: `infer` would not warn. The \
         probability is that of the most probable tree, right or wrong, on average over the simulations whose consensus is \
         exact. A sweep was timed on simulation 1. [All simulations](bodies-posterior.csv).\n",
        SWEEPS[SWEEPS.len() - 1] / 2 + 1
    ));
    lines.push(row([
        "d",
        "consensus exact",
        "mean ARI",
        "tree right, of those",
        "mean probability of the likeliest tree",
        "mixed",
    ]));
    lines.push(rule(6));
    lines.extend(conditions.iter().map(Condition::posterior_row));
    lines.join("\n") + "\n"
}

impl Condition {
    /// The share of chains whose answer is the truth after some sweeps.
    fn exact_after(&self, sweeps: usize) -> Estimate {
        let of_body = |body: usize| {
            let own: Vec<_> =
                self.chains.iter().filter(|row| row.body == body && row.sweeps == sweeps).collect();
            own.iter().filter(|row| row.exact).count() as f64 / own.len() as f64
        };
        let share = (1..=BODIES).map(of_body).sum::<f64>() / BODIES as f64;
        // As if the chains of a body were all right or all wrong, which is the widest. At the ends it has a width, too.
        let interval = Some(wilson(share * BODIES as f64, BODIES as f64));
        Estimate { value: Some(share), n: BODIES, interval, ..Estimate::default() }
    }

    fn posterior_row(&self) -> String {
        let exact: Vec<_> = self.posteriors.iter().filter(|row| row.exact).collect();
        let right = exact.iter().filter(|row| row.tree_right).count();
        let aris: Vec<f64> = self.posteriors.iter().map(|row| row.ari).collect();
        let probabilities: Vec<f64> = exact.iter().map(|row| row.tree_probability).collect();
        row([
            self.dimension.to_string(),
            format!("{} of {BODIES}", exact.len()),
            mean(&aris).value.map_or("–".to_owned(), |ari| format!("{ari:.3}")),
            format!("{right} of {}", exact.len()),
            mean(&probabilities).value.map_or("–".to_owned(), |p| format!("{:.0} %", 100.0 * p)),
            format!("{} of {BODIES}", self.posteriors.iter().filter(|row| row.mixed).count()),
        ])
    }
}

/// A share in percent, with its interval within 0 and 1.
fn percent(share: &Estimate) -> String {
    let percent = |x: f64| format!("{:.1}", 100.0 * x.clamp(0.0, 1.0));
    let value = share.value.map_or("–".to_owned(), |value| percent(value) + " %");
    share
        .interval
        .map_or(value.clone(), |(low, high)| format!("{value} ({} to {})", percent(low), percent(high)))
}
