//! Render figures 6b and 6d: a body map of three dimensions, seen from two sides.

use std::ops::Range;

use super::super::figure_rows::MapRow;
use super::axes::{Axis, around, plain};
use super::canvas::{
    Anchor, Canvas, FONT, GREY, INK, PALE, Place, PlotError, Rendered, WIDTH, render_svg, stroke, text_width,
};
use super::map::{Grouping, Groups};

/// Turns about the third axis of the two views, in degrees: what one hides the other shows.
const TURNS: [f64; 2] = [25.0, 65.0];
/// How far above the horizon the viewer is.
const RISE: f64 = 22.0;
/// Points from one edge of the box to the other.
const EDGE: f64 = 300.0;
const HIGH: f64 = 452.0;

/// A parallel projection of the box −½ to ½ in each dimension.
struct View {
    turn: (f64, f64),
    rise: (f64, f64),
    centre: Place,
}

impl View {
    /// Where a point is, and how near to the viewer.
    fn see(&self, [x, y, z]: [f64; 3]) -> (Place, f64) {
        let ((sin, cos), (up, flat)) = (self.turn, self.rise);
        let (right, depth) = (cos * x - sin * y, sin * x + cos * y);
        // The viewer is in front, where depth is negative.
        let place = (self.centre.0 + EDGE * right, self.centre.1 - EDGE * (flat * z + up * depth));
        (place, up * z - flat * depth)
    }

    fn place(&self, point: [f64; 3]) -> Place {
        self.see(point).0
    }
}

/// Figures 6b and 6d.
pub(super) fn render(rows: &[MapRow], grouping: Grouping) -> Result<String, PlotError> {
    let groups = Groups::of(rows, 3)?;
    let legend = groups.legend(rows, grouping);
    let top = legend.height();
    let position = |row: &MapRow| [row.x1, row.x2, row.x3.unwrap_or(0.0)];
    // A cube: equal scales in all dimensions.
    let ranges = [0, 1, 2].map(|axis| around(rows.iter().map(|row| position(row)[axis]), 0.03));
    let side = ranges.iter().map(|range| range.end - range.start).fold(0.0, f64::max);
    let cube = ranges.map(|range| {
        let middle = (range.start + range.end) / 2.0;
        middle - side / 2.0..middle + side / 2.0
    });
    let share = |axis: usize, value: f64| (value - cube[axis].start) / side - 0.5;
    render_svg(top + HIGH * TURNS.len() as f64, |canvas| {
        legend.render(canvas)?;
        for (at, turn) in TURNS.iter().enumerate() {
            let view = View {
                turn: turn.to_radians().sin_cos(),
                rise: RISE.to_radians().sin_cos(),
                centre: (WIDTH / 2.0 + 8.0, top + HIGH * (at as f64 + 0.5) - 12.0),
            };
            frame(canvas, &view, &cube)?;
            let mut seen: Vec<_> = rows
                .iter()
                .map(|row| {
                    let point = position(row);
                    (view.see([share(0, point[0]), share(1, point[1]), share(2, point[2])]), row)
                })
                .collect();
            // What is near is drawn last.
            seen.sort_by(|((_, a), _), ((_, b), _)| a.total_cmp(b));
            for ((place, near), row) in seen {
                let (style, radius) = groups.style(row);
                canvas.marker(place, radius * (1.0 + 0.25 * near), style)?;
            }
        }
        Ok(())
    })
}

/// The lower end of each dimension of the box.
const NEAR: f64 = -0.5;
/// The upper end.
const FAR: f64 = 0.5;

/// The values at the ticks of an axis, and where they are along the edge of the box, −½ to ½.
type Ticks = Vec<(f64, f64)>;

/// The three far sides of the box with their lines, and the labels of its three axes.
fn frame(canvas: &Canvas, view: &View, cube: &[Range<f64>; 3]) -> Rendered {
    let ticks = cube.clone().map(|range| {
        let side = range.end - range.start;
        let ticks = Axis::new("", range.clone(), 5).ticks;
        ticks.into_iter().map(|value| (value, (value - range.start) / side - 0.5)).collect::<Vec<_>>()
    });
    grid(canvas, view, &ticks)?;
    edges(canvas, view)?;
    labels(canvas, view, &ticks)
}

/// The lines at the ticks, on the three far sides.
fn grid(canvas: &Canvas, view: &View, ticks: &[Ticks; 3]) -> Rendered {
    let line = |from, to| canvas.line(&[view.place(from), view.place(to)], stroke(PALE, 0.6));
    // From this side the walls where x or y is greatest are at the back; the third far side is the floor.
    for &(_, at) in &ticks[0] {
        line([at, NEAR, NEAR], [at, FAR, NEAR])?;
        line([at, FAR, NEAR], [at, FAR, FAR])?;
    }
    for &(_, at) in &ticks[1] {
        line([NEAR, at, NEAR], [FAR, at, NEAR])?;
        line([FAR, at, NEAR], [FAR, at, FAR])?;
    }
    for &(_, at) in &ticks[2] {
        line([NEAR, FAR, at], [FAR, FAR, at])?;
        line([FAR, NEAR, at], [FAR, FAR, at])?;
    }
    Ok(())
}

/// The edges of the three far sides.
fn edges(canvas: &Canvas, view: &View) -> Rendered {
    let corners = [
        ([NEAR, NEAR, NEAR], [FAR, NEAR, NEAR]),
        ([NEAR, NEAR, NEAR], [NEAR, FAR, NEAR]),
        ([NEAR, FAR, NEAR], [NEAR, FAR, FAR]),
        ([FAR, NEAR, NEAR], [FAR, FAR, NEAR]),
        ([NEAR, FAR, NEAR], [FAR, FAR, NEAR]),
        ([FAR, FAR, NEAR], [FAR, FAR, FAR]),
        ([NEAR, FAR, FAR], [FAR, FAR, FAR]),
        ([FAR, NEAR, FAR], [FAR, FAR, FAR]),
        ([FAR, NEAR, NEAR], [FAR, NEAR, FAR]),
    ];
    for (from, to) in corners {
        canvas.line(&[view.place(from), view.place(to)], stroke(GREY, 0.7))?;
    }
    Ok(())
}

/// The labels of the ticks and the names of the axes.
fn labels(canvas: &Canvas, view: &View, ticks: &[Ticks; 3]) -> Rendered {
    let axes = [
        ([NEAR, NEAR, NEAR], [FAR, NEAR, NEAR], 24.0),
        ([NEAR, NEAR, NEAR], [NEAR, FAR, NEAR], 30.0),
        // Its name stands above it.
        ([NEAR, FAR, NEAR], [NEAR, FAR, FAR], 0.0),
    ];
    for ((from, to, beyond_ticks), (ticks, name)) in
        axes.into_iter().zip(ticks.iter().zip(["x₁ / bit", "x₂ / bit", ""]))
    {
        // Labels near a corner that two axes share would meet.
        for (value, at) in ticks.iter().filter(|(_, at)| at.abs() < 0.46) {
            beside(canvas, view, (from, to), (at + 0.5, 5.0), &plain(*value))?;
        }
        if !name.is_empty() {
            beside(canvas, view, (from, to), (0.5, beyond_ticks), name)?;
        }
    }
    let (x, y) = view.place([NEAR, FAR, FAR]);
    canvas.text("x₃ / bit", (x + 2.0, y - 12.0), Anchor::End, FONT, INK)
}

/// A text beside an edge, at a share of its length: on the side away from the middle of the box, and clear of what is
/// within `by` points of the edge.
fn beside(
    canvas: &Canvas,
    view: &View,
    (from, to): ([f64; 3], [f64; 3]),
    (share, by): (f64, f64),
    text: &str,
) -> Rendered {
    let (a, b) = (view.place(from), view.place(to));
    let (x, y) = (a.0 + share * (b.0 - a.0), a.1 + share * (b.1 - a.1));
    let length = (b.0 - a.0).hypot(b.1 - a.1).max(1.0);
    let (dx, dy) = ((b.1 - a.1) / length, (a.0 - b.0) / length);
    let outer = (dx * (x - view.centre.0) + dy * (y - view.centre.1)).signum();
    let extent = dx.abs() * text_width(text, FONT) / 2.0 + dy.abs() * 0.5 * FONT;
    let by = outer * (by + extent);
    canvas.text(text, (x + by * dx, y + by * dy), Anchor::Middle, FONT, INK)
}
