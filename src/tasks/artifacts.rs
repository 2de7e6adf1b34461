//! Write the truth, the maps and the distances of a body as results, and take them up again after an interruption.

use std::path::Path;

use serde::{Deserialize, Serialize};

use crate::files::checkpoint::Checkpoints;
use crate::files::{FileError, npy, sha256, tables};
use crate::pipeline::{MapQuality, Mapped, MappedBody};
use crate::settings::Settings;
use crate::stages::body_map::BodyMaps;

/// What is known of a body whose files are results.
#[derive(Debug, Clone)]
pub(crate) struct Artifacts {
    /// How well its sensors could be mapped.
    pub facts: MapQuality,
    /// Its files, within the folder of results.
    pub files: Vec<String>,
}

/// Where the files of one body are.
pub(super) struct ArtifactFiles<'a> {
    /// The folder of results.
    pub out: &'a Path,
    /// Finished work.
    pub checkpoints: &'a Checkpoints,
    /// The folder of the body in that of the results, and its name among the checkpoints.
    pub name: &'a str,
}

/// Finished body maps: their files are the result, and a checkpoint keeps the hashes.
#[derive(Serialize, Deserialize)]
struct MappedFiles {
    facts: MapQuality,
    files: Vec<(String, String)>,
}

impl ArtifactFiles<'_> {
    /// Writes the files, and a checkpoint with their hashes.
    ///
    /// # Errors
    /// If one cannot be written.
    pub(super) fn write(
        &self,
        mapped: Mapped,
        with_distances: bool,
    ) -> Result<(MappedBody, Artifacts), FileError> {
        let Mapped { body, distances, facts } = mapped;
        let folder = self.out.join(self.name);
        let mut names = vec!["labels.csv".to_owned(), "tree.csv".to_owned()];
        tables::write_truth(&folder.join(&names[0]), &folder.join(&names[1]), &body.truth)?;
        if with_distances {
            npy::write_distances(&folder.join("distance.npy"), &distances)?;
            names.push("distance.npy".to_owned());
        }
        for (name, map) in body.maps.iter().flat_map(BodyMaps::files) {
            npy::write_body_map(&folder.join(&name), map)?;
            names.push(name);
        }
        let hashed = |name: String| Ok((name.clone(), sha256(&folder.join(name))?));
        let files = names.into_iter().map(hashed).collect::<Result<_, FileError>>()?;
        let finished = MappedFiles { facts, files };
        self.checkpoints.keep(&format!("{}/body", self.name), &finished)?;
        Ok((body, self.kept(finished)))
    }

    /// The body that an earlier run with these settings wrote, if its files are still what they were.
    pub(super) fn recall(&self, settings: &Settings) -> Option<(MappedBody, Artifacts)> {
        let finished: MappedFiles = self.checkpoints.recall(&format!("{}/body", self.name))?;
        let folder = self.out.join(self.name);
        for (name, hash) in &finished.files {
            let path = folder.join(name);
            if sha256(&path).ok().as_ref() != Some(hash) {
                eprintln!("bodyschema: {}: has changed or is missing; it is computed again", path.display());
                return None;
            }
        }
        let maps = finished.files.iter().filter(|(name, _)| name.starts_with("body-map"));
        // A map that is there and cannot be read is not one that we wrote.
        let maps: Option<Vec<_>> =
            maps.map(|(name, _)| npy::read_body_map(&folder.join(name)).ok()).collect();
        let maps = BodyMaps::of(settings.map.method, maps?);
        let (labels, tree) = (folder.join("labels.csv"), folder.join("tree.csv"));
        let truth = tables::read_truth(&labels, &tree, settings.sensors()).ok()?;
        let resolution = finished.facts.resolution;
        Some((MappedBody { truth, maps, resolution }, self.kept(finished)))
    }

    fn kept(&self, MappedFiles { facts, files }: MappedFiles) -> Artifacts {
        let files = files.into_iter().map(|(name, _)| format!("{}/{name}", self.name)).collect();
        Artifacts { facts, files }
    }
}
