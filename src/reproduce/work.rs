//! The long parts of an experiment, each done once: body maps, chains and clusterings, with checkpoints.

use std::time::{Instant, SystemTime};

use indicatif::ProgressBar;
use serde::{Deserialize, Serialize};
use serde_json::json;

use super::{ReproduceError, Run};
use crate::body_maps::BodyMaps;
use crate::pipeline::{self, BaselineRecord, Body, Facts, Inference, Record};
use crate::progress::progress;
use crate::record::checkpoint::Checkpoints;
use crate::record::{npy, sha256, tables};
use crate::schema::{Model, Sample};
use crate::settings::Settings;

/// What an experiment has found so far, and where it keeps it.
pub struct Work<'a> {
    run: &'a Run<'a>,
    pub checkpoints: Checkpoints,
    /// Draws, by condition and simulation.
    pub records: Vec<Record>,
    pub baselines: Vec<BaselineRecord>,
    /// What the manifest says of each body.
    pub bodies: Vec<serde_json::Value>,
    /// Files of the run, from its folder.
    pub outputs: Vec<String>,
    pub begun: (SystemTime, Instant),
}

/// Finished body maps: their files are the result, of which a checkpoint keeps the hashes.
#[derive(Serialize, Deserialize)]
struct MappedFiles {
    facts: Facts,
    files: Vec<(String, String)>,
}

impl<'a> Work<'a> {
    /// Nothing done so far.
    pub fn new(run: &'a Run) -> Self {
        Self {
            run,
            checkpoints: Checkpoints::new(run.out, &(run.experiment, run.settings)),
            records: Vec::new(),
            baselines: Vec::new(),
            bodies: Vec::new(),
            outputs: Vec::new(),
            begun: (SystemTime::now(), Instant::now()),
        }
    }

    /// A bar over the chains of so many conditions.
    pub fn chains(&self, place: &str, conditions: usize) -> ProgressBar {
        let chains = conditions * self.run.settings.schema.chains;
        progress(chains as u64, format!("{place}: chains of the body schema"))
    }

    /// Stages 1 to 5 of one simulation, whose files go to the folder `place` of the run.
    pub fn map_body(
        &mut self,
        settings: &Settings,
        simulation: usize,
        place: &str,
        with_distances: bool,
    ) -> Result<Body, ReproduceError> {
        let part = format!("{place}/body");
        let mapped = match self.recall_body(&part, place) {
            Some(finished) => finished,
            None => {
                let bar = progress(settings.samples() as u64 + 1, format!("{place}: body map"));
                let felt = pipeline::feel(settings, simulation, &bar)?;
                let mapped = pipeline::map_felt(&felt, settings, self.run.dimensions())?;
                bar.finish_and_clear();
                let folder = self.run.out.join(place);
                let mut names = vec!["labels.csv".to_owned(), "tree.csv".to_owned()];
                tables::write_truth(&folder.join(&names[0]), &folder.join(&names[1]), &mapped.body.truth)?;
                if with_distances {
                    npy::write_distances(&folder.join("distance.npy"), &mapped.distances)?;
                    names.push("distance.npy".to_owned());
                }
                for (name, map) in mapped.body.maps.iter().flat_map(BodyMaps::files) {
                    npy::write_body_map(&folder.join(&name), map)?;
                    names.push(name);
                }
                let mut files = Vec::new();
                for name in names {
                    let hash = sha256(&folder.join(&name))?;
                    files.push((name, hash));
                }
                let finished = MappedFiles { facts: mapped.facts, files };
                self.checkpoints.keep(&part, &finished)?;
                (mapped.body, finished)
            }
        };
        let (body, MappedFiles { facts, files }) = mapped;
        self.outputs.extend(files.into_iter().map(|(name, _)| format!("{place}/{name}")));
        self.bodies.push(json!({
            "coordination": settings.motion.coordination,
            "simulation": simulation,
            "facts": facts,
        }));
        Ok(body)
    }

    /// Body maps that an earlier run finished, if their files are still what they were.
    fn recall_body(&self, part: &str, place: &str) -> Option<(Body, MappedFiles)> {
        let finished: MappedFiles = self.checkpoints.recall(part)?;
        let folder = self.run.out.join(place);
        for (name, hash) in &finished.files {
            let path = folder.join(name);
            if sha256(&path).ok().as_ref() != Some(hash) {
                eprintln!(
                    "bodyschema: {}: has changed or is missing; this part is done again",
                    path.display()
                );
                return None;
            }
        }
        let maps = finished.files.iter().filter(|(name, _)| name.starts_with("body-map"));
        // A map that is there and cannot be read is no map of ours.
        let maps: Option<Vec<_>> =
            maps.map(|(name, _)| npy::read_body_map(&folder.join(name)).ok()).collect();
        let maps = BodyMaps::of(self.run.settings.map.method, maps?);
        let sensors = self.run.sensors();
        let truth = tables::read_truth(&folder.join("labels.csv"), &folder.join("tree.csv"), sensors).ok()?;
        Some((Body { truth, maps }, finished))
    }

    /// Stages 6 and 7 of one condition. Returns the draw of highest log posterior.
    pub fn infer(
        &mut self,
        settings: &Settings,
        body: &Body,
        (dimension, model): (usize, Model),
        simulation: usize,
        place: &str,
        bar: &ProgressBar,
    ) -> Result<Sample, ReproduceError> {
        let part = format!("{place}/{}-{dimension}", model.name());
        let inference: Inference = match self.checkpoints.recall(&part) {
            Some(finished) => {
                bar.inc(settings.schema.chains as u64);
                finished
            }
            None => {
                let found = pipeline::infer_and_score(body, dimension, model, settings, simulation, bar)?;
                self.checkpoints.keep(&part, &found)?;
                found
            }
        };
        self.records.extend(inference.records);
        Ok(inference.best)
    }

    /// The clusterings that are told the number of clusters, at one dimension.
    pub fn cluster(
        &mut self,
        settings: &Settings,
        body: &Body,
        dimension: usize,
        simulation: usize,
        place: &str,
    ) -> Result<(), ReproduceError> {
        let part = format!("{place}/baselines-{dimension}");
        let found = match self.checkpoints.recall(&part) {
            Some(finished) => finished,
            None => {
                let found = pipeline::cluster_and_score(body, dimension, settings, simulation);
                self.checkpoints.keep(&part, &found)?;
                found
            }
        };
        self.baselines.extend::<Vec<BaselineRecord>>(found);
        Ok(())
    }
}
