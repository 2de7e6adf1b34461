//! Render figure 5: joint angles over time, a panel for each p.

use std::f64::consts::PI;

use super::super::figure_rows::AngleRow;
use super::axes::{Axis, Panel, Stack, around, plain};
use super::canvas::{
    Canvas, INK, MarkerStyle, PALETTE, Place, PlotError, Rendered, SHAPES, WIDTH, render_svg, stroke,
};
use super::legend::{Key, Legend};
use super::values::{check, few};

/// Markers on a line.
const MARKERS: f64 = 7.0;

/// Figure 5.
pub(super) fn render(rows: &[AngleRow]) -> Result<String, PlotError> {
    check("p", rows.iter().map(|row| row.coordination), 0.0, 1.0)?;
    check("time", rows.iter().map(|row| row.time_s), 0.0, 1e9)?;
    // A little room: the table is rounded.
    check("angle", rows.iter().flat_map(|row| [row.angle1_rad, row.angle2_rad]), -3.15, 3.15)?;
    let coordinations = few("p", rows.iter().map(|row| row.coordination))?;
    let joints = few("joint", rows.iter().map(|row| row.joint))?;

    let mut legend = Legend::default();
    for (at, joint) in joints.iter().enumerate() {
        legend.add(Key::Marker(style(at), 3.6), format!("joint {joint}"));
    }
    legend.add(Key::Break, "");
    legend.add(Key::Line(INK, 1.6), "first angle");
    legend.add(Key::Line(INK, 0.6), "second angle (thin)");
    let (top, count) = (legend.height(), coordinations.len());
    let stack = Stack { top, title: 19.0, each: 96.0, width: WIDTH - 20.0, count };
    let times = around(rows.iter().map(|row| row.time_s), 0.01);
    render_svg(stack.height(), |canvas| {
        legend.render(canvas)?;
        for (at, p) in coordinations.iter().enumerate() {
            let x = Axis::new(if stack.is_last(at) { "time / s" } else { "" }, times.clone(), 6);
            let y = Axis {
                ticks: vec![-PI, 0.0, PI],
                label: |angle| if angle == 0.0 { "0".into() } else { format!("{}\u{3c0}", sign(angle)) },
                ..Axis::new("angle / rad", -1.1 * PI..1.1 * PI, 3)
            };
            let panel = Panel::render(canvas, stack.panel(at), 46.0, &x, &y)?;
            panel.title(canvas, &format!("p = {}", plain(*p)))?;
            for (number, joint) in joints.iter().enumerate() {
                let mine: Vec<&AngleRow> =
                    rows.iter().filter(|row| row.coordination == *p && row.joint == *joint).collect();
                one(canvas, &panel, &mine, number, joints.len())?;
            }
        }
        Ok(())
    })
}

fn style(joint: usize) -> MarkerStyle {
    MarkerStyle {
        colour: PALETTE[[0, 3, 6, 2, 1, 4, 5][joint % 7]],
        shape: SHAPES[joint % SHAPES.len()],
        hollow: false,
    }
}

fn sign(angle: f64) -> &'static str {
    if angle < 0.0 { "\u{2212}" } else { "" }
}

/// Both angles of one joint.
fn one(canvas: &Canvas, panel: &Panel, rows: &[&AngleRow], joint: usize, joints: usize) -> Rendered {
    let style = style(joint);
    type Angle = fn(&AngleRow) -> f64;
    let angles: [(Angle, f64); 2] = [(|row| row.angle2_rad, 0.5), (|row| row.angle1_rad, 1.2)];
    for (angle, width) in angles {
        // An angle that passes π comes back at −π: the shorter way between two samples is then off the panel.
        let runs = rows.chunk_by(|a, b| (angle(a) - angle(b)).abs() <= PI);
        for run in runs.filter(|run| run.len() > 1) {
            let line: Vec<Place> = run.iter().map(|row| panel.at(row.time_s, angle(row))).collect();
            canvas.line(&line, stroke(style.colour, width))?;
        }
    }
    // Beside those of the other joints.
    let step = rows.len() as f64 / MARKERS;
    let first = step * (joint as f64 + 0.5) / joints as f64;
    for at in 0..MARKERS as usize {
        if let Some(row) = rows.get((first + at as f64 * step) as usize) {
            canvas.marker(panel.at(row.time_s, row.angle1_rad), 3.0, style)?;
        }
    }
    Ok(())
}
