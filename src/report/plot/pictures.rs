//! Find the table of each figure in a folder, and write a picture beside it.

use std::path::Path;

use serde::de::DeserializeOwned;

use super::canvas::PlotError;
use super::{agent, angles, bars, curves, map, space};
use crate::analysis::published::{Mark, figures};
use crate::files::tables::read_rows;
use crate::files::{FileError, write_text};

/// A figure that was drawn.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Picture {
    /// Name of the figure.
    pub name: String,
    /// The picture, as SVG.
    pub svg: String,
}

/// A table and the value that its picture marks, if any, to the picture as SVG.
type Draw = fn(&Path, Option<&Mark>) -> Result<String, FileError>;

/// Figures by name, in their order.
const FIGURES: [(&str, Draw); 14] = [
    ("fig04-agent", |csv, _| picture(csv, agent::render)),
    ("fig05-angles", |csv, _| picture(csv, angles::render)),
    ("fig06a-map-2d", |csv, _| picture(csv, |rows| map::render(rows, map::Grouping::Parts))),
    ("fig06b-map-3d", |csv, _| picture(csv, |rows| space::render(rows, map::Grouping::Parts))),
    ("fig06c-clusters-2d", |csv, _| picture(csv, |rows| map::render(rows, map::Grouping::Clusters))),
    ("fig06d-clusters-3d", |csv, _| picture(csv, |rows| space::render(rows, map::Grouping::Clusters))),
    ("fig07-parts", |csv, mark| picture(csv, |rows| bars::parts(rows, mark))),
    ("fig08a-ari-baselines", |csv, mark| picture(csv, |rows| curves::baselines(rows, mark))),
    ("fig08b-ari", |csv, mark| picture(csv, |rows| curves::render(rows, &curves::ARI_BY_DIMENSION, mark))),
    ("fig09-ari-box", |csv, _| picture(csv, bars::boxes)),
    ("fig10a-tree-baseline", |csv, mark| {
        picture(csv, |rows| curves::render(rows, &curves::TREE_BY_DIMENSION, mark))
    }),
    ("fig10b-tree", |csv, mark| picture(csv, |rows| curves::render(rows, &curves::TREE_BY_DIMENSION, mark))),
    ("fig11a-ari", |csv, mark| picture(csv, |rows| curves::render(rows, &curves::ARI_BY_COORDINATION, mark))),
    ("fig11b-tree", |csv, mark| {
        picture(csv, |rows| curves::render(rows, &curves::TREE_BY_COORDINATION, mark))
    }),
];

/// Writes NAME.svg for every figure NAME whose NAME.csv is in `folder`, and returns what it wrote.
///
/// # Errors
/// If a table is not that of its figure, or a picture cannot be written. Each picture appears whole or not at all.
pub fn render(folder: &Path) -> Result<Vec<Picture>, FileError> {
    let published = figures();
    let mut written = Vec::new();
    for (name, draw) in FIGURES {
        let csv = folder.join(format!("{name}.csv"));
        if csv.exists() {
            let mark =
                published.iter().find(|figure| figure.name == name).and_then(|figure| figure.mark.as_ref());
            let svg = draw(&csv, mark)?;
            write_text(&folder.join(format!("{name}.svg")), &svg)?;
            written.push(Picture { name: name.to_owned(), svg });
        }
    }
    Ok(written)
}

fn picture<T: DeserializeOwned>(
    csv: &Path,
    render: impl FnOnce(&[T]) -> Result<String, PlotError>,
) -> Result<String, FileError> {
    let rows = read_rows(csv)?;
    if rows.is_empty() {
        return Err(FileError::new(csv, "has no rows"));
    }
    render(&rows).map_err(|PlotError(message)| FileError::new(csv, message))
}

#[cfg(test)]
mod tests;
