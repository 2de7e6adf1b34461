//! Render figures 6a and 6c: a body map of two dimensions.

use super::super::figure_rows::{MapPoint, MapRow};
use super::axes::{Axis, Panel, Rect, X_LABELS, around};
use super::canvas::plot_error;
use super::canvas::{INK, MarkerStyle, PlotError, Shape, WIDTH, render_svg};
use super::legend::{Key, Legend};
use super::values::{check, distinct};
use crate::settings::MAX_LISTED;

/// Radius of a sensor's marker.
pub(super) const SENSOR: f64 = 2.5;
/// Radius of a joint's marker.
pub(super) const JOINT: f64 = 5.0;

/// What the groups of a map are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Grouping {
    /// The parts that sensors sit on.
    Parts,
    /// The clusters that were estimated.
    Clusters,
}

/// A joint, as the paper draws it.
pub(super) fn joint() -> MarkerStyle {
    MarkerStyle { colour: INK, shape: Shape::Circle, hollow: true }
}

/// The groups on a map, whether its points can be drawn being checked.
pub(super) struct Groups(Vec<usize>);

impl Groups {
    /// Checks the rows of a map of so many dimensions.
    pub(super) fn of(rows: &[MapRow], dims: usize) -> Result<Self, PlotError> {
        check("coordinate", rows.iter().flat_map(|row| [row.x1, row.x2]), -1e6, 1e6)?;
        check("coordinate", rows.iter().filter_map(|row| row.x3), -1e6, 1e6)?;
        if rows.iter().any(|row| row.x3.is_some() != (dims == 3)) {
            return plot_error(format!("must have coordinates in {dims} dimensions"));
        }
        let sensors = || rows.iter().filter(|row| row.kind == MapPoint::Sensor);
        if sensors().next().is_none() {
            return plot_error("has no sensors");
        }
        if let Some(row) = sensors().find(|row| row.group.is_none()) {
            return plot_error(format!("sensor {} has no group", row.index));
        }
        Ok(Self(distinct(sensors().filter_map(|row| row.group))))
    }

    /// How a point is drawn, and how large.
    pub(super) fn style(&self, row: &MapRow) -> (MarkerStyle, f64) {
        match row.kind {
            MapPoint::Joint => (joint(), JOINT),
            MapPoint::Sensor => {
                let at = row.group.and_then(|group| self.0.binary_search(&group).ok()).unwrap_or(0);
                (MarkerStyle::of(at), SENSOR)
            }
        }
    }

    /// What the styles mean.
    pub(super) fn legend(&self, rows: &[MapRow], grouping: Grouping) -> Legend {
        let mut legend = Legend::default();
        let what = if grouping == Grouping::Parts { "part" } else { "cluster" };
        for (at, group) in self.0.iter().enumerate().take(MAX_LISTED) {
            legend.add(Key::Marker(MarkerStyle::of(at), 4.0), format!("{what} {group}"));
        }
        if let Some(more @ 1..) = self.0.len().checked_sub(MAX_LISTED) {
            legend.add(Key::Marker(MarkerStyle::of(MAX_LISTED), 4.0), format!("and {more} more"));
        }
        if rows.iter().any(|row| row.kind == MapPoint::Joint) {
            legend.add(Key::Marker(joint(), JOINT), "estimated joint");
        }
        legend
    }
}

/// Figures 6a and 6c.
pub(super) fn render(rows: &[MapRow], grouping: Grouping) -> Result<String, PlotError> {
    let groups = Groups::of(rows, 2)?;
    let legend = groups.legend(rows, grouping);
    let top = legend.height() + 4.0;
    let labels = 58.0;
    let ((left, width), (x, y)) = (
        (4.0, WIDTH - 12.0),
        (around(rows.iter().map(|row| row.x1), 0.04), around(rows.iter().map(|row| row.x2), 0.04)),
    );
    // Equal scales: distances are what a map is made of.
    let (wide, high) = (width - labels, (width - labels) * (y.end - y.start) / (x.end - x.start));
    let tallest = 560.0;
    let (x, high) = if high <= tallest {
        (x, high)
    } else {
        let (middle, half) = ((x.start + x.end) / 2.0, (y.end - y.start) / 2.0 * wide / tallest);
        (middle - half..middle + half, tallest)
    };
    let (y, high) = if high >= 120.0 {
        (y, high)
    } else {
        let (middle, half) = ((y.start + y.end) / 2.0, (x.end - x.start) / 2.0 * 120.0 / wide);
        (middle - half..middle + half, 120.0)
    };
    render_svg(top + high + X_LABELS + 4.0, |canvas| {
        legend.render(canvas)?;
        let outer = Rect { left, top, width, height: high + X_LABELS };
        let (x, y) = (Axis::new("x₁ / bit", x, 6), Axis::new("x₂ / bit", y, 6));
        let panel = Panel::render(canvas, outer, labels, &x, &y)?;
        for row in shuffled(rows) {
            let (style, radius) = groups.style(row);
            canvas.marker(panel.at(row.x1, row.x2), radius, style)?;
        }
        Ok(())
    })
}

/// Sensors in an order that mixes the groups, so that none covers another, then joints.
fn shuffled(rows: &[MapRow]) -> Vec<&MapRow> {
    let golden = |at: usize| (at as f64 * 0.618_033_988_75).fract();
    let mut order: Vec<_> = rows.iter().enumerate().map(|(at, row)| (golden(at), row)).collect();
    order.sort_by(|a, b| a.0.total_cmp(&b.0));
    let (joints, sensors): (Vec<_>, Vec<_>) =
        order.into_iter().map(|(_, row)| row).partition(|row| row.kind == MapPoint::Joint);
    sensors.into_iter().chain(joints).collect()
}
