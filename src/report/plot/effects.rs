//! Render what each of some conditions gives, such as values of one setting: a line for each, a panel for each result.

use std::ops::Range;

use plotters::style::{RGBColor, WHITE};

use super::axes::{Axis, Panel, Rect, X_BARE, around};
use super::canvas::{
    Anchor, BAND, BLUE, Canvas, FONT, GREY, INK, MarkerStyle, Place, PlotError, Rendered, SMALL, Shape,
    VERMILLION, WIDTH, render_svg, stroke, text_width,
};
use super::values::check;

/// A value with its 95 % interval; `None` where there is none.
pub type Cell = Option<(f64, Option<(f64, f64)>)>;

/// A line of the picture.
#[derive(Debug, Clone, PartialEq)]
pub struct Line {
    /// What stands on its left.
    pub label: String,
    /// One for each panel.
    pub cells: Vec<Cell>,
}

/// A panel of the picture.
#[derive(Debug, Clone, PartialEq)]
pub struct Column {
    /// What it shows.
    pub title: String,
    /// Whether it is a share, so that its axis goes from 0 to 1.
    pub share: bool,
    /// The published value, if there is one.
    pub published: Option<f64>,
    /// The range that counts as reproduced, if it is drawn.
    pub accepted: Option<(f64, f64)>,
}

const LINE: f64 = 19.0;
const LABELS: f64 = 176.0;
const GAP: f64 = 12.0;
/// Where a label is broken.
const BREAK: &str = ", ";

/// Where the lines of the picture are, from top to bottom.
struct Layout {
    /// The label of each line, in pieces below each other.
    labels: Vec<Vec<String>>,
    /// Height of each line.
    heights: Vec<f64>,
    /// Width of a panel with its gap.
    wide: f64,
}

/// Where the panels begin, below their titles.
const TOP: f64 = 40.0;

impl Layout {
    fn new(columns: usize, lines: &[Line]) -> Self {
        let labels: Vec<Vec<String>> = lines.iter().map(|line| broken(&line.label)).collect();
        let heights = labels.iter().map(|label| LINE + 14.0 * (label.len() - 1) as f64).collect();
        Self { labels, heights, wide: (WIDTH - LABELS - 8.0) / columns as f64 }
    }

    /// Height of the panels.
    fn inside(&self) -> f64 {
        self.heights.iter().sum::<f64>() + 8.0
    }

    /// Height of the middle of a line.
    fn middle(&self, row: usize) -> f64 {
        TOP + 4.0 + self.heights[..row].iter().sum::<f64>() + self.heights[row] / 2.0
    }

    /// Left edge of a panel.
    fn left(&self, at: usize) -> f64 {
        LABELS + at as f64 * self.wide + GAP / 2.0
    }

    /// Middle of a panel between its left and right edges.
    fn centre(&self, at: usize) -> f64 {
        self.left(at) + (self.wide - GAP) / 2.0
    }
}

/// Renders the picture. With `default`, the first line is what the others are compared with, and in another colour.
///
/// # Errors
/// If a value cannot be placed.
pub fn render(columns: &[Column], lines: &[Line], default: bool) -> Result<String, PlotError> {
    let finite = lines.iter().flat_map(|line| line.cells.iter().flatten()).map(|(value, _)| *value);
    check("value", finite, -1e6, 1e6)?;
    let layout = Layout::new(columns.len(), lines);
    render_svg(TOP + layout.inside() + X_BARE + 4.0, |canvas| {
        render_labels(canvas, &layout, default)?;
        for (at, column) in columns.iter().enumerate() {
            let cells: Vec<Cell> = lines.iter().map(|line| line.cells.get(at).copied().flatten()).collect();
            let panel = render_panel(canvas, &layout, at, column, &cells)?;
            render_references(canvas, &panel, column, if default { cells[0] } else { None })?;
            for (row, cell) in cells.iter().enumerate() {
                let colour = if default && row == 0 { VERMILLION } else { BLUE };
                render_cell(canvas, &panel, (layout.centre(at), layout.middle(row)), cell, colour)?;
            }
        }
        Rendered::Ok(())
    })
}

/// The labels on the left, that of the default in another colour.
fn render_labels(canvas: &Canvas, layout: &Layout, default: bool) -> Rendered {
    for (row, label) in layout.labels.iter().enumerate() {
        let colour = if default && row == 0 { VERMILLION } else { INK };
        for (at, text) in label.iter().enumerate() {
            let y = layout.middle(row) + 14.0 * (at as f64 - (label.len() - 1) as f64 / 2.0);
            canvas.text(text, (LABELS - 4.0, y), Anchor::End, SMALL, colour)?;
        }
    }
    Ok(())
}

/// The axes of a panel and its title.
fn render_panel(
    canvas: &Canvas,
    layout: &Layout,
    at: usize,
    column: &Column,
    cells: &[Cell],
) -> Result<Panel, PlotError> {
    let range = if column.share {
        -0.04..1.04
    } else {
        whole(ends(cells).chain(column.accepted.into_iter().flat_map(|(low, high)| [low, high])))
    };
    // Room for two labels: the ends of the scale, or the whole numbers next to them.
    let mut ticks = vec![range.start.ceil(), range.end.floor()];
    ticks.retain(|tick| range.contains(tick));
    ticks.dedup();
    let axis = Axis { ticks, ..Axis::new("", range.clone(), 2) };
    let bare = Axis { ticks: Vec::new(), ..Axis::new("", 0.0..1.0, 2) };
    let (width, height) = (layout.wide - GAP, layout.inside() + X_BARE);
    let outer = Rect { left: layout.left(at), top: TOP, width, height };
    let panel = Panel::render(canvas, outer, 0.0, &axis, &bare)?;
    for (row, text) in column.title.split('\n').enumerate() {
        let place = (layout.centre(at), 10.0 + 15.0 * row as f64);
        canvas.text(text, place, Anchor::Middle, FONT, INK)?;
    }
    Ok(panel)
}

/// The vertical lines of a panel: the published value, and that of the default.
fn render_references(canvas: &Canvas, panel: &Panel, column: &Column, default: Cell) -> Rendered {
    let vertical = |value: f64| {
        let x = panel.at(value, 0.0).0;
        ((x, panel.inner.top), (x, panel.inner.top + panel.inner.height))
    };
    if let Some((low, high)) = column.accepted {
        // A range may be a single number.
        let (left, right) = (vertical(low).0.0 - 1.5, vertical(high).0.0 + 1.5);
        let Rect { top, height, .. } = panel.inner;
        canvas.bar((left, top), (right, top + height), BAND)?;
    }
    if let Some(published) = column.published {
        let (from, to) = vertical(published);
        canvas.dashes(from, to, stroke(GREY, 1.4))?;
    }
    if let Some((default, _)) = default {
        let (from, to) = vertical(default);
        canvas.line(&[from, to], stroke(VERMILLION, 0.8))?;
    }
    Ok(())
}

/// A value with its interval, at the height `y`; a note in the middle of the panel if there is no value.
fn render_cell(
    canvas: &Canvas,
    panel: &Panel,
    (centre, y): Place,
    cell: &Cell,
    colour: RGBColor,
) -> Rendered {
    let Some((value, interval)) = cell else {
        return canvas.text("no value", (centre, y), Anchor::Middle, SMALL, GREY);
    };
    let x = |value: f64| panel.at(value, 0.0).0;
    if let Some((low, high)) = interval {
        canvas.line(&[(x(*low), y), (x(*high), y)], stroke(colour, 1.6))?;
    }
    let style = MarkerStyle { colour, shape: Shape::Circle, hollow: false };
    canvas.marker((x(*value), y), 4.2, MarkerStyle { colour: WHITE, ..style })?;
    canvas.marker((x(*value), y), 3.6, style)
}

/// Whole numbers around all values, and some room.
fn whole(values: impl Iterator<Item = f64>) -> Range<f64> {
    let range = around(values, 0.0);
    if range.start.is_finite() { range.start.floor() - 0.2..range.end.ceil() + 0.2 } else { -0.2..1.2 }
}

/// All values and ends of intervals.
fn ends(cells: &[Cell]) -> impl Iterator<Item = f64> + '_ {
    cells.iter().flatten().flat_map(|(value, interval)| {
        let (low, high) = interval.unzip();
        [Some(*value), low, high].into_iter().flatten()
    })
}

/// A label in as many lines as it needs.
fn broken(label: &str) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for piece in label.split(BREAK) {
        match lines.last_mut() {
            Some(line) if text_width(&format!("{line}{BREAK}{piece}"), SMALL) < LABELS - 10.0 => {
                line.push_str(BREAK);
                line.push_str(piece);
            }
            _ => lines.push(piece.to_owned()),
        }
    }
    lines
}
