//! Measure how often bodies drawn from the generative model are recovered by either sampler, against separation and
//! dimensions, as a table and a picture. Run by `reproduce/evidence.sh`; the argument is the folder to write to.

#[path = "../tests/support/synthetic.rs"]
mod synthetic;

use std::error::Error;
use std::path::Path;

use bodyschema::files::tables::write_rows;
use bodyschema::internals::statistics::mean;
use bodyschema::numerics::rng::stream;
use bodyschema::settings::{Base, Settings};
use bodyschema::stages::evaluate::score;
use bodyschema::stages::schema::{EdgeWeight, Keep, Model, Sample, Schema, infer};
use plotters::prelude::*;

const BODIES: usize = 24;
const DIMENSIONS: [usize; 4] = [2, 5, 9, 14];
const SEPARATIONS: [f64; 6] = [0.0, 1.0, 1.5, 2.0, 3.0, 4.0];

/// A condition. Rates are means over bodies, with their interval over bodies: the chains of one body are
/// not independent of each other.
#[derive(serde::Serialize)]
struct Row {
    sampler: &'static str,
    dimension: usize,
    separation: f64,
    bodies: usize,
    chains: usize,
    partition_rate: f64,
    partition_low: f64,
    partition_high: f64,
    bodies_with_partition: usize,
    tree_rate: Option<f64>,
    tree_low: Option<f64>,
    tree_high: Option<f64>,
    /// Share of bodies whose true components have the true tree as their minimum spanning tree: the most
    /// that can be expected of `tree_rate`.
    identifiable: f64,
}

/// The sampler of the paper's equations.
fn equations() -> Schema {
    let text = include_str!("../reproduce/equations.toml");
    let schema =
        Settings::paper().with(text, "reproduce/equations.toml").expect("the repository's settings").schema;
    Schema { chains: 8, sweeps: 300, edge_weight: EdgeWeight::Pairwise, ..schema }
}

/// The split–merge sampler, with the prior of the other: its own is for body maps.
fn split_merge() -> Schema {
    let schema =
        Settings::load_over(Some(Base::SPLIT_MERGE), None).expect("the repository's settings").schema;
    Schema { chains: 8, sweeps: 100, keep: Keep::Last, scale: 1.0, ..schema }
}

const SAMPLERS: [&str; 2] = ["equations", "split-merge"];

fn condition(sampler: &'static str, dimension: usize, separation: f64) -> Result<Row, Box<dyn Error>> {
    let schema = if sampler == "equations" { equations() } else { split_merge() };
    let (mut partitions, mut trees) = (Vec::new(), Vec::new());
    let mut identifiable = 0;
    for at in 0..BODIES {
        let stage = format!("synthetic d {dimension} separation {separation}");
        let body = synthetic::body(dimension, separation, &mut stream(1, 1, &stage, at));
        identifiable += usize::from(body.identifiable);
        let draws = infer(&body.map, Model::DpgmmLj, &schema, 1, at, &|| ())?;
        let judge = |draw: &Sample| score(&draw.labels, &draw.tree, &body.truth, synthetic::ELIGIBLE_ARI);
        let scores: Vec<_> = draws.iter().map(judge).collect();
        let eligible = scores.iter().filter(|score| score.eligible).count();
        let right = scores.iter().filter(|score| score.eligible && score.tree_correct).count();
        partitions.push(eligible as f64 / scores.len() as f64);
        if eligible > 0 {
            trees.push(right as f64 / eligible as f64);
        }
    }
    let (partition, tree) = (mean(&partitions), mean(&trees));
    let within = |end: f64| end.clamp(0.0, 1.0);
    let (partition_low, partition_high) = partition.interval.ok_or("more than one body")?;
    let (tree_low, tree_high) = tree.interval.unzip();
    Ok(Row {
        sampler,
        dimension,
        separation,
        bodies: BODIES,
        chains: schema.chains,
        partition_rate: partition.value.ok_or("at least one body")?,
        partition_low: within(partition_low),
        partition_high: within(partition_high),
        bodies_with_partition: trees.len(),
        tree_rate: tree.value,
        tree_low: tree_low.map(within),
        tree_high: tree_high.map(within),
        identifiable: identifiable as f64 / BODIES as f64,
    })
}

fn main() -> Result<(), Box<dyn Error>> {
    let folder = std::env::args().nth(1).ok_or("usage: recovery FOLDER")?;
    let folder = Path::new(&folder);
    let mut rows = Vec::new();
    for sampler in SAMPLERS {
        for dimension in DIMENSIONS {
            for separation in SEPARATIONS {
                rows.push(condition(sampler, dimension, separation)?);
                eprintln!("recovery: {sampler}, d = {dimension}, separation {separation} done");
            }
        }
    }
    write_rows(&folder.join("recovery.csv"), &rows)?;
    render(&folder.join("recovery.svg"), &rows)
}

fn render(path: &Path, rows: &[Row]) -> Result<(), Box<dyn Error>> {
    // Okabe & Ito's colours, and a marker size for each, so that neither alone carries the meaning.
    let colours =
        [RGBColor(0, 114, 178), RGBColor(213, 94, 0), RGBColor(0, 158, 115), RGBColor(204, 121, 167)];
    let area = SVGBackend::new(path, (900, 760)).into_drawing_area();
    area.fill(&WHITE)?;
    let panels = area.split_evenly((2, 2));
    type Value = fn(&Row) -> Option<(f64, f64, f64)>;
    let shown: [(&str, Value); 2] = [
        ("draws that find the parts (ARI of at least 0.95)", |row| {
            Some((row.partition_rate, row.partition_low, row.partition_high))
        }),
        ("of these, draws that find the tree", |row| Some((row.tree_rate?, row.tree_low?, row.tree_high?))),
    ];
    let both = SAMPLERS.iter().flat_map(|sampler| shown.map(|(title, value)| (*sampler, title, value)));
    for (panel, (sampler, title, value)) in panels.iter().zip(both) {
        let mut chart = ChartBuilder::on(panel)
            .caption(format!("{sampler}: {title}"), ("sans-serif", 16))
            .margin(10)
            .x_label_area_size(40)
            .y_label_area_size(45)
            .build_cartesian_2d(-0.1..4.1, -0.02..1.02)?;
        chart
            .configure_mesh()
            .disable_mesh()
            .x_desc("separation (1: the model itself)")
            .y_desc("rate, 95 % interval over bodies")
            .label_style(("sans-serif", 13))
            .draw()?;
        for (at, (&dimension, &colour)) in DIMENSIONS.iter().zip(&colours).enumerate() {
            let points: Vec<(f64, (f64, f64, f64))> = rows
                .iter()
                .filter(|row| row.sampler == sampler && row.dimension == dimension)
                .filter_map(|row| Some((row.separation, value(row)?)))
                .collect();
            let size = 2 + at as u32;
            chart
                .draw_series(LineSeries::new(
                    points.iter().map(|(x, (y, ..))| (*x, *y)),
                    colour.stroke_width(2),
                ))?
                .label(format!("d = {dimension}"))
                .legend(move |(x, y)| Circle::new((x + 8, y), size, colour.filled()));
            chart.draw_series(
                points.iter().map(|(x, (y, ..))| Circle::new((*x, *y), size, colour.filled())),
            )?;
            chart.draw_series(
                points.iter().map(|(x, (_, low, high))| PathElement::new([(*x, *low), (*x, *high)], colour)),
            )?;
        }
        chart
            .configure_series_labels()
            .position(SeriesLabelPosition::UpperLeft)
            .background_style(WHITE.mix(0.8))
            .label_font(("sans-serif", 13))
            .draw()?;
    }
    area.present()?;
    Ok(())
}
