//! Render a specification curve: all estimates of a claim by size, with their intervals, and beneath them the choices that
//! they come from (Simonsohn, Simmons and Nelson 2020).

use plotters::style::RGBColor;

use super::axes::{Axis, Panel, Rect, X_BARE, around, percent, plain};
use super::canvas::{
    Anchor, BAND, BLUE, Canvas, FONT, GREY, INK, PALE, PlotError, Rendered, SMALL, WIDTH, render_svg, stroke,
};
use super::values::check;
use crate::analysis::published::Unit;

/// An estimate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Point {
    /// Its value.
    pub value: f64,
    /// Its 95 % interval, where there is one.
    pub interval: Option<(f64, f64)>,
}

/// What was chosen of a factor.
#[derive(Debug, Clone, PartialEq)]
pub struct Choices {
    /// The factor.
    pub factor: String,
    /// Its options.
    pub options: Vec<String>,
    /// The option of each estimate, in the order of the points.
    pub chosen: Vec<usize>,
}

/// A specification curve.
#[derive(Debug, Clone, PartialEq)]
pub struct Curve {
    /// What is estimated.
    pub title: String,
    /// Its unit.
    pub unit: Option<Unit>,
    /// The published value, if there is one.
    pub published: Option<f64>,
    /// The range that counts as reproduced.
    pub accepted: (f64, f64),
    /// All estimates, by rising value.
    pub points: Vec<Point>,
    /// The choices.
    pub choices: Vec<Choices>,
}

/// Where the panels begin: room for the labels of options.
const LEFT: f64 = 176.0;
/// Height of the curve's panel.
const HIGH: f64 = 190.0;
const TOP: f64 = 26.0;
/// Height of an option's row.
const ROW: f64 = 13.0;
/// Columns that estimates are put together in beneath the curve.
const COLUMNS: usize = 44;

/// Renders the picture.
///
/// # Errors
/// If a value cannot be placed.
pub fn render(curve: &Curve) -> Result<String, PlotError> {
    check("value", curve.points.iter().map(|point| point.value), -1e6, 1e6)?;
    let rows: usize = curve.choices.iter().map(|one| one.options.len() + 1).sum();
    let below = TOP + HIGH + X_BARE;
    render_svg(below + rows as f64 * ROW + 8.0, |canvas| {
        let title = format!("{}, {} specifications", curve.title, curve.points.len());
        canvas.text(&title, (LEFT, 10.0), Anchor::Start, FONT, INK)?;
        if curve.points.is_empty() {
            return canvas.text("no sample", (LEFT, TOP + 20.0), Anchor::Start, SMALL, GREY);
        }
        render_points(canvas, curve)?;
        let mut top = below;
        for choices in &curve.choices {
            top = render_choices(canvas, choices, top)?;
        }
        Rendered::Ok(())
    })
}

fn render_points(canvas: &Canvas, curve: &Curve) -> Rendered {
    let count = curve.points.len() as f64;
    let share = matches!(curve.unit, Some(Unit::Rate | Unit::Ari | Unit::Coordination));
    let ends = [curve.accepted.0, curve.accepted.1];
    let values = curve.points.iter().map(|point| point.value).chain(ends).chain(curve.published);
    let range = if share { -0.02..1.02 } else { around(values, 0.05) };
    let label = if curve.unit == Some(Unit::Rate) { percent } else { plain };
    let y = Axis { label, ..Axis::new("", range, 5) };
    let x = Axis { ticks: Vec::new(), ..Axis::new("", 0.0..count, 1) };
    let labels = 46.0;
    let outer =
        Rect { left: LEFT - labels, top: TOP, width: WIDTH - LEFT - 8.0 + labels, height: HIGH + X_BARE };
    let panel = Panel::render(canvas, outer, labels, &x, &y)?;
    let height = |value: f64| panel.at(0.0, value).1;
    let (left, right) = (panel.inner.left, panel.inner.left + panel.inner.width);
    canvas.bar((left, height(curve.accepted.1) - 1.0), (right, height(curve.accepted.0) + 1.0), BAND)?;
    for (at, point) in curve.points.iter().enumerate() {
        let middle = at as f64 + 0.5;
        if let Some((low, high)) = point.interval {
            canvas.line(&[panel.at(middle, low), panel.at(middle, high)], stroke(PALE, 0.6))?;
        }
    }
    if let Some(published) = curve.published {
        canvas.dashes((left, height(published)), (right, height(published)), stroke(GREY, 1.4))?;
    }
    let places: Vec<_> =
        curve.points.iter().enumerate().map(|(at, point)| panel.at(at as f64 + 0.5, point.value)).collect();
    canvas.line(&places, stroke(BLUE, 2.0))
}

/// A row for each option: the darker, the larger its share among the estimates above it. Returns where the next begins.
fn render_choices(canvas: &Canvas, choices: &Choices, top: f64) -> Result<f64, PlotError> {
    let width = (WIDTH - LEFT - 8.0) / COLUMNS as f64;
    canvas.text(&choices.factor, (LEFT - 6.0, top + ROW / 2.0), Anchor::End, SMALL, GREY)?;
    let count = choices.chosen.len();
    for (option, name) in choices.options.iter().enumerate() {
        let row = top + (option + 1) as f64 * ROW;
        canvas.text(name, (LEFT - 6.0, row + ROW / 2.0), Anchor::End, SMALL, INK)?;
        for column in 0..COLUMNS {
            let own = &choices.chosen[column * count / COLUMNS..(column + 1) * count / COLUMNS];
            let share = own.iter().filter(|one| **one == option).count() as f64 / own.len().max(1) as f64;
            if share > 0.0 {
                let left = LEFT + column as f64 * width;
                canvas.bar((left, row + 1.0), (left + width, row + ROW - 1.0), shade(share))?;
            }
        }
    }
    Ok(top + (choices.options.len() + 1) as f64 * ROW)
}

/// From white to blue.
fn shade(share: f64) -> RGBColor {
    let RGBColor(red, green, blue) = BLUE;
    let mix = |level: u8| (255.0 - share * (255.0 - f64::from(level))).round() as u8;
    RGBColor(mix(red), mix(green), mix(blue))
}
