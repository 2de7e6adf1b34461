//! Run the study of bodies, and write its tables and its page.

use std::cmp::Reverse;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};

use rayon::prelude::*;

use super::design::{Design, StudyBody, Way};
use super::movement::{EdgeRow, Found, Movement, Row};
use super::page::{PICTURE, Page};
use crate::files::checkpoint::Checkpoints;
use crate::files::manifest::Manifest;
use crate::files::result_folder::ResultFolder;
use crate::files::tables::read_rows;
use crate::files::{FileError, prepare_folder, read_text, write_text};
use crate::report::plot;
use crate::settings::Settings;
use crate::tasks::error::ExperimentError;
use crate::tasks::progress::progress;
use crate::tasks::shard::Shard;

const ROWS: &str = "recordings.csv";
const EDGES: &str = "edges.csv";
const COPY: &str = "design.toml";
const PAGE: &str = "bodies.md";

/// Runs the study, and writes into `out`: recordings.csv, edges.csv, design.toml, manifest.json, bodies.md and
/// figures/bodies.svg.
///
/// A study that was interrupted goes on from the movements that it finished, and so does one of more movements: what each gave
/// stays in the folder checkpoints. A shard runs its own movements, and writes only their checkpoints. A run without one goes on from
/// these, runs what is missing, and writes the tables.
///
/// # Errors
/// If a body or the settings cannot be used, a movement is unstable, or a file cannot be written.
pub(crate) fn study(
    design: &Design,
    text: &str,
    path: &Path,
    shard: Option<Shard>,
    out: &Path,
) -> Result<(), ExperimentError> {
    let mut folder = ResultFolder::new(out);
    let bodies = design.read_bodies(path)?;
    let settings = design
        .ways()
        .into_iter()
        .map(|way| Ok((way, design.settings_of(way)?)))
        .collect::<Result<Vec<_>, ExperimentError>>()?;
    for (body, (_, settings)) in
        bodies.iter().flat_map(|body| settings.iter().map(move |settings| (body, settings)))
    {
        settings.check_times(body.body.agent.sites.len()).map_err(crate::settings::SettingsError::from)?;
    }
    // What a simulation gives does not depend on how many there are: a study of more goes on from what one of fewer left.
    // It depends on the bodies: a file that changes makes another study.
    let hashes: Vec<&str> = bodies.iter().map(|body| body.sha256.as_str()).collect();
    let checkpoints = Checkpoints::new(out, &(Design { movements: 0, ..design.clone() }, hashes));
    let each = design.recordings.len() as u64 + 1;
    let own = dealt(design, &bodies, &settings, shard.unwrap_or(Shard::WHOLE));
    let bar = progress(each * own.len() as u64, format!("{} simulations", own.len()));
    let failed = AtomicBool::new(false);
    let run = |movement: &Movement| -> Result<Found, ExperimentError> {
        if let Some(found) = checkpoints.recall(&movement.name()) {
            bar.inc(each);
            return Ok(found);
        }
        if failed.load(Ordering::Relaxed) {
            return Err(ExperimentError::Stage("another simulation failed".to_owned()));
        }
        let found = movement.run(&|| bar.inc(1)).map_err(|message| {
            failed.store(true, Ordering::Relaxed);
            ExperimentError::Stage(message)
        })?;
        checkpoints.keep(&movement.name(), &found)?;
        Ok(found)
    };
    let found = own.par_iter().map(|(place, movement)| Ok((*place, run(movement)?)));
    let mut found = found.collect::<Result<Vec<_>, ExperimentError>>()?;
    bar.finish_and_clear();
    if shard.is_some() {
        return Ok(());
    }
    // In the order of the tables.
    found.sort_by_key(|(place, _)| *place);
    let (mut rows, mut edges) = (Vec::new(), Vec::new());
    for (_, found) in found {
        rows.extend(found.rows);
        edges.extend(found.edges);
    }
    folder.write_rows(ROWS, &rows)?;
    folder.write_rows(EDGES, &edges)?;
    folder.write_text(COPY, text)?;
    folder.write_manifest(Manifest::of_study("bodies", design.seed))?;
    draw(&Page { design, rows: &rows, edges: &edges }, out)
}

/// The movements of a shard, each with its place in the tables: by body, then by kind and p, then by number.
fn dealt<'a>(
    design: &'a Design,
    bodies: &'a [StudyBody],
    settings: &'a [(Way<'a>, Settings)],
    shard: Shard,
) -> Vec<([usize; 3], Movement<'a>)> {
    let mut all = Vec::new();
    for number in 1..=design.movements {
        for (of_body, body) in bodies.iter().enumerate() {
            for (at, (way, settings)) in settings.iter().enumerate() {
                let movement = Movement { design, body, of_body, way: *way, settings, number };
                all.push(([of_body, at, number], movement));
            }
        }
    }
    // Those of most sensors are dealt out first, so that shards have about as much to do.
    all.sort_by_key(|(_, movement)| Reverse(movement.body.body.agent.sites.len()));
    let dealt = all.into_iter().enumerate().filter(|(at, _)| shard.has(*at));
    dealt.map(|(_, movement)| movement).collect()
}

/// Whether a folder holds a finished study of bodies.
pub(crate) fn is_study(folder: &Path) -> bool {
    [ROWS, EDGES, COPY].iter().all(|name| folder.join(name).is_file())
}

/// Makes the page and the picture of a study again, from its tables and design alone.
///
/// # Errors
/// If they are not what a study wrote, or a file cannot be written.
pub(crate) fn redraw(folder: &Path) -> Result<(), ExperimentError> {
    let path = folder.join(COPY);
    let design = Design::parse(&read_text(&path)?, &path)?;
    let rows: Vec<Row> = read_rows(&folder.join(ROWS))?;
    let edges: Vec<EdgeRow> = read_rows(&folder.join(EDGES))?;
    draw(&Page { design: &design, rows: &rows, edges: &edges }, folder)
}

/// Writes the page and the picture of a study.
fn draw(page: &Page, folder: &Path) -> Result<(), ExperimentError> {
    write_text(&folder.join(PAGE), &page.text())?;
    let (columns, lines) = page.picture();
    let picture = plot::effects::render(&columns, &lines, false);
    let picture = picture.map_err(|error| FileError::new(&folder.join(ROWS), error.0))?;
    prepare_folder(&folder.join("figures"))?;
    Ok(write_text(&folder.join(PICTURE), &picture)?)
}
