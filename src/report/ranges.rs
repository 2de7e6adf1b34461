//! Draw what was reproduced of a claim against its accepted range: a small picture for each row of the report's table.

use maud::{Markup, html};

use super::claims_table::Row;
use super::numbers;
use crate::analysis::published::Unit;

/// Width of a drawing, px.
const WIDTH: f64 = 168.0;
/// Height of a drawing, px.
const HEIGHT: f64 = 36.0;
/// From the edges to the ends of the axis, px, so that a marker at an end is not cut off.
const MARGIN: f64 = 10.0;
/// Height of the axis, px from the top.
const MIDDLE: f64 = 13.0;
/// Least width of the band, px: a range may be a single number.
const LEAST: f64 = 4.0;

/// Where a value is on an axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Side {
    Inside,
    Below,
    Above,
}

/// An axis from its lowest to its highest value.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Axis {
    low: f64,
    high: f64,
}

impl Axis {
    fn new(unit: Unit, accepted: (f64, f64)) -> Self {
        /// Parts that are shown beside the accepted range.
        const BESIDE: f64 = 3.0;
        let (low, high) = match unit {
            Unit::Rate | Unit::Ari | Unit::Coordination | Unit::PValue => (0.0, 1.0),
            Unit::Dimension => (1.0, 15.0),
            Unit::Parts => ((accepted.0 - BESIDE).max(0.0), accepted.1 + BESIDE),
        };
        Self { low, high }
    }

    /// Place of a value, px from the left. What lies outside the axis is at its end.
    fn place(self, value: f64) -> (f64, Side) {
        let side = match value {
            value if value < self.low => Side::Below,
            value if value > self.high => Side::Above,
            _ => Side::Inside,
        };
        let share = (value.max(self.low).min(self.high) - self.low) / (self.high - self.low);
        (MARGIN + share * (WIDTH - 2.0 * MARGIN), side)
    }
}

/// The drawing of a row; `None` without an accepted range.
pub(crate) fn drawing(row: &Row) -> Option<Markup> {
    let (unit, accepted) = (row.unit?, row.accepted()?);
    let axis = Axis::new(unit, accepted);
    let words = words(row, accepted);
    let end = |value| numbers::range(Some((value, value)), row.unit);
    Some(html! {
        svg.range width=(WIDTH) height=(HEIGHT) viewBox={ "0 0 " (WIDTH) " " (HEIGHT) } role="img" aria-label=(words) {
            title { (words) }
            (band(axis, accepted))
            line.axis x1=(MARGIN) y1=(MIDDLE) x2=(WIDTH - MARGIN) y2=(MIDDLE) {}
            @if let Some(published) = row.published { (tick(axis.place(published).0)) }
            @if let Some(ends) = row.interval() { (interval(axis, ends)) }
            @if let Some(value) = row.value { (dot(axis.place(value))) }
            text x="1" y=(HEIGHT - 2.0) { (end(axis.low)) }
            text x=(WIDTH - 1.0) y=(HEIGHT - 2.0) text-anchor="end" { (end(axis.high)) }
        }
    })
}

/// What the drawing shows, for those who do not see it.
fn words(row: &Row, accepted: (f64, f64)) -> String {
    let mut words = vec![format!("accepted {}", numbers::range(Some(accepted), row.unit))];
    if row.published.is_some() {
        words.push(format!("published {}", numbers::value(row.published, row.unit)));
    }
    match row.value {
        Some(_) => words.push(format!("reproduced {}", row.reproduced())),
        None => words.push("no reproduced value".to_owned()),
    }
    if row.interval().is_some() {
        words.push(format!("95 % interval {}", numbers::range(row.interval(), row.unit)));
    }
    words.join(", ")
}

fn band(axis: Axis, accepted: (f64, f64)) -> Markup {
    let (left, right) = (axis.place(accepted.0).0, axis.place(accepted.1).0);
    let width = (right - left).max(LEAST);
    let left = (left + right - width) / 2.0;
    html! { rect.band x=(px(left)) y=(MIDDLE - 8.0) width=(px(width)) height="16" {} }
}

fn tick(x: f64) -> Markup {
    html! { line.published x1=(px(x)) y1=(MIDDLE - 12.0) x2=(px(x)) y2=(MIDDLE + 12.0) {} }
}

/// A line with a cap at each end, or with an arrow where the interval goes on beyond the axis.
fn interval(axis: Axis, (low, high): (f64, f64)) -> Markup {
    let ends = [axis.place(low), axis.place(high)];
    let [left, right] = ends.map(|(x, _)| px(x));
    html! {
        line.interval x1=(left) y1=(MIDDLE) x2=(right) y2=(MIDDLE) {}
        @for (x, side) in ends {
            @let back = match side { Side::Inside => 0.0, Side::Below => 4.0, Side::Above => -4.0 };
            polyline.interval points={
                (px(x + back)) "," (MIDDLE - 4.0) " " (px(x)) "," (MIDDLE) " " (px(x + back)) "," (MIDDLE + 4.0)
            } {}
        }
    }
}

/// A dot, or an open triangle that points to where the value lies beyond the axis.
fn dot((x, side): (f64, Side)) -> Markup {
    let tip = match side {
        Side::Inside => return html! { circle.value cx=(px(x)) cy=(MIDDLE) r="4.5" {} },
        Side::Below => x - 8.0,
        Side::Above => x + 8.0,
    };
    html! {
        polygon.beyond points={
            (px(x)) "," (MIDDLE - 5.5) " " (px(tip)) "," (MIDDLE) " " (px(x)) "," (MIDDLE + 5.5)
        } {}
    }
}

/// What the marks of all drawings mean.
pub(crate) fn legend() -> Markup {
    let key = |mark: Markup, words: &str| {
        html! {
            span { svg.range width="36" height="26" viewBox="0 0 36 26" aria-hidden="true" { (mark) } " " (words) }
        }
    };
    let accepted = html! { rect.band x="2" y=(MIDDLE - 8.0) width="32" height="16" {} };
    let reproduced = html! {
        line.interval x1="3" y1=(MIDDLE) x2="33" y2=(MIDDLE) {}
        line.interval x1="3" y1=(MIDDLE - 4.0) x2="3" y2=(MIDDLE + 4.0) {}
        line.interval x1="33" y1=(MIDDLE - 4.0) x2="33" y2=(MIDDLE + 4.0) {}
        (dot((18.0, Side::Inside)))
    };
    html! {
        p.legend {
            (key(accepted, "accepted range"))
            (key(tick(18.0), "published value"))
            (key(reproduced, "reproduced value, 95 % interval"))
            (key(dot((14.0, Side::Above)), "value beyond the axis"))
        }
    }
}

/// A length with one decimal at most.
fn px(length: f64) -> String {
    format!("{}", (length * 10.0).round() / 10.0)
}

#[cfg(test)]
mod tests;
