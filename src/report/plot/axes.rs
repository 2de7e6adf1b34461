//! Render axes, and place data between them.

use std::ops::Range;

use plotters::coord::ranged1d::{DefaultFormatting, KeyPointHint, Ranged};
use plotters::prelude::*;

use super::canvas::{
    Anchor, Canvas, FONT, GREY, INK, PALE, Place, PlotError, Rendered, fine, font, points, stroke,
};

/// Height that the labels and the name of a horizontal axis take.
pub(super) const X_LABELS: f64 = 38.0;
/// The same of an axis without a name.
pub(super) const X_BARE: f64 = 21.0;

/// One axis.
#[derive(Clone)]
pub(super) struct Axis<'a> {
    /// Data from one end to the other.
    pub range: Range<f64>,
    /// Where lines and labels are.
    pub ticks: Vec<f64>,
    /// Its name and unit; may be empty.
    pub name: &'a str,
    /// The label of a tick.
    pub label: fn(f64) -> String,
}

impl<'a> Axis<'a> {
    /// An axis over `range` with about `count` ticks at round values.
    pub(super) fn new(name: &'a str, range: Range<f64>, count: usize) -> Self {
        Self { ticks: ticks(&range, count), range, name, label: plain }
    }
}

/// Round values in a range, about `count` of them.
fn ticks(range: &Range<f64>, count: usize) -> Vec<f64> {
    let raw = (range.end - range.start) / count as f64;
    let power = 10f64.powf(raw.log10().floor());
    let step = [1.0, 2.0, 5.0, 10.0].map(|times| times * power).into_iter().find(|step| *step >= 0.7 * raw);
    let step = step.unwrap_or(raw);
    let (first, last) = ((range.start / step - 1e-9).ceil(), (range.end / step + 1e-9).floor());
    (0..=(last - first).max(0.0) as usize).map(|at| (first + at as f64) * step).collect()
}

/// A number with no more digits than it needs, and a true minus sign.
pub(super) fn plain(value: f64) -> String {
    let rounded = (value * 1e6).round() / 1e6 + 0.0;
    rounded.to_string().replace('-', "\u{2212}")
}

/// A share as a percentage.
pub(super) fn percent(value: f64) -> String {
    format!("{} %", plain((value * 100.0).round()))
}

/// Ticks at the given values, leaving out those whose labels would collide: `room` is how far apart labels
/// must be.
pub(super) fn sparse(values: &[f64], room: f64) -> Vec<f64> {
    let mut kept: Vec<f64> = Vec::new();
    for &value in values {
        if kept.last().is_none_or(|last| value - last >= room * (1.0 - 1e-9)) {
            kept.push(value);
        }
    }
    kept
}

/// Range of values, widened on both sides by a share of itself; never empty.
pub(super) fn around(values: impl IntoIterator<Item = f64>, margin: f64) -> Range<f64> {
    let (low, high) = values
        .into_iter()
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)));
    let room = if high > low { margin * (high - low) } else { 0.5 };
    low - room..high + room
}

/// A rectangle of a picture, in points.
#[derive(Debug, Clone, Copy)]
pub(super) struct Rect {
    /// Left edge.
    pub left: f64,
    /// Upper edge.
    pub top: f64,
    /// Width.
    pub width: f64,
    /// Height.
    pub height: f64,
}

/// Panels under each other, each with room for a title above it; only the last one has a name on its horizontal axis.
pub(super) struct Stack {
    /// Upper edge of the first panel's title.
    pub top: f64,
    /// Height of a title.
    pub title: f64,
    /// Height of a panel, without the name of its horizontal axis.
    pub each: f64,
    /// Width of a panel.
    pub width: f64,
    /// Number of panels.
    pub count: usize,
}

impl Stack {
    /// Height of the picture that ends below the last panel.
    pub(super) fn height(&self) -> f64 {
        self.top + self.count as f64 * (self.title + self.each) + X_LABELS - X_BARE + 4.0
    }

    /// Whether a panel is the last one.
    pub(super) fn is_last(&self, at: usize) -> bool {
        at + 1 == self.count
    }

    /// The rectangle of a panel and its axes.
    pub(super) fn panel(&self, at: usize) -> Rect {
        Rect {
            left: 4.0,
            top: self.top + at as f64 * (self.title + self.each) + self.title,
            width: self.width,
            height: self.each + if self.is_last(at) { X_LABELS - X_BARE } else { 0.0 },
        }
    }
}

/// A range with its ticks, as plotters asks for.
struct Ticked(Range<f64>, Vec<f64>);

impl Ranged for Ticked {
    type FormatOption = DefaultFormatting;
    type ValueType = f64;

    fn map(&self, value: &f64, (first, last): (i32, i32)) -> i32 {
        let share = ((value - self.0.start) / (self.0.end - self.0.start)).clamp(0.0, 1.0);
        first + (share * f64::from(last - first)).round() as i32
    }

    fn key_points<Hint: KeyPointHint>(&self, hint: Hint) -> Vec<f64> {
        // Lines between ticks would be clutter.
        if hint.weight().allow_light_points() { Vec::new() } else { self.1.clone() }
    }

    fn range(&self) -> Range<f64> {
        self.0.clone()
    }
}

/// Axes on a picture.
pub(super) struct Panel {
    /// The area between the axes.
    pub inner: Rect,
    x: Range<f64>,
    y: Range<f64>,
}

impl Panel {
    /// Draws axes into `outer`: the vertical one's labels take `y_labels` points on the left.
    pub(super) fn render(
        canvas: &Canvas,
        outer: Rect,
        y_labels: f64,
        x: &Axis,
        y: &Axis,
    ) -> Result<Self, PlotError> {
        let area = canvas
            .area
            .clone()
            .shrink((fine(outer.left), fine(outer.top)), (fine(outer.width), fine(outer.height)));
        let mut chart = ChartBuilder::on(&area)
            .x_label_area_size(fine(if x.name.is_empty() { X_BARE } else { X_LABELS }))
            .y_label_area_size(fine(y_labels))
            .build_cartesian_2d(
                Ticked(x.range.clone(), x.ticks.clone()),
                Ticked(y.range.clone(), y.ticks.clone()),
            )?;
        chart
            .configure_mesh()
            .bold_line_style(stroke(PALE, 0.6))
            .axis_style(stroke(GREY, 0.8))
            .set_all_tick_mark_size(fine(2.5))
            .label_style(font(FONT))
            .axis_desc_style(font(FONT))
            .x_label_formatter(&|value| (x.label)(*value))
            .y_label_formatter(&|value| (y.label)(*value))
            .x_desc(x.name)
            .y_desc(y.name)
            .draw()?;
        let (columns, rows) = chart.plotting_area().get_pixel_range();
        let inner = Rect {
            left: points(columns.start),
            top: points(rows.start),
            width: points(columns.end - columns.start),
            height: points(rows.end - rows.start),
        };
        Ok(Self { inner, x: x.range.clone(), y: y.range.clone() })
    }

    /// Where a point of the data is; at the edge if it lies beyond.
    pub(super) fn at(&self, x: f64, y: f64) -> Place {
        let share = |value: f64, range: &Range<f64>| {
            ((value - range.start) / (range.end - range.start)).clamp(0.0, 1.0)
        };
        (
            self.inner.left + share(x, &self.x) * self.inner.width,
            self.inner.top + (1.0 - share(y, &self.y)) * self.inner.height,
        )
    }

    /// A horizontal line of reference.
    pub(super) fn reference(&self, canvas: &Canvas, y: f64) -> Rendered {
        canvas.dashes(self.at(self.x.start, y), self.at(self.x.end, y), stroke(GREY, 1.2))
    }

    /// A title above the axes.
    pub(super) fn title(&self, canvas: &Canvas, text: &str) -> Rendered {
        let at = (self.inner.left + self.inner.width / 2.0, self.inner.top - 9.0);
        canvas.text(text, at, Anchor::Middle, FONT, INK)
    }
}
