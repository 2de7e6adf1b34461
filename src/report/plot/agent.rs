//! Render figure 4: the whole body, and one part close up.

use std::f64::consts::PI;

use plotters::style::{Color, RGBColor};

use super::super::figure_rows::{AgentPoint, AgentRow};
use super::axes::{Axis, Panel, Rect, X_LABELS, around};
use super::canvas::plot_error;
use super::canvas::{
    Anchor, Canvas, FONT, GREY, INK, MarkerStyle, PALETTE, Place, PlotError, Rendered, Shape, WIDTH,
    render_svg, stroke,
};
use super::legend::{Key, Legend};
use super::values::{check, few};

type Vector = nalgebra::Vector3<f64>;

/// A cylinder, as far as points tell.
struct Cylinder {
    number: usize,
    proximal: Vector,
    distal: Vector,
    /// Distance of the outermost sensor from the axis, m.
    radius: f64,
    sensors: Vec<Vector>,
}

fn position(row: &AgentRow) -> Vector {
    Vector::new(row.x_m, row.y_m, row.z_m)
}

impl Cylinder {
    fn of(rows: &[AgentRow], number: usize) -> Result<Self, PlotError> {
        let of = |kind| rows.iter().filter(move |row| row.part == number && row.kind == kind).map(position);
        let (Some(proximal), Some(distal)) =
            (of(AgentPoint::ProximalEnd).next(), of(AgentPoint::DistalEnd).next())
        else {
            return plot_error(format!("part {number} lacks an end"));
        };
        let mut part =
            Self { number, proximal, distal, radius: 0.0, sensors: of(AgentPoint::Sensor).collect() };
        if part.length() < 1e-6 {
            return plot_error(format!("part {number} has no length"));
        }
        let far = |sensor: &Vector| {
            let (along, off) = part.seen(sensor);
            along.abs().max(off.norm()) > 20.0 * part.length()
        };
        if part.sensors.is_empty() || part.sensors.iter().any(far) {
            return plot_error(format!("part {number} has no sensor, or one that is not on it"));
        }
        part.radius = part.sensors.iter().map(|sensor| part.seen(sensor).1.norm()).fold(0.0, f64::max);
        Ok(part)
    }

    fn length(&self) -> f64 {
        (self.distal - self.proximal).norm()
    }

    fn axis(&self) -> Vector {
        (self.distal - self.proximal) / self.length()
    }

    /// Where a point is along the axis, from its middle, and how it lies off the axis.
    fn seen(&self, point: &Vector) -> (f64, Vector) {
        let from = point - (self.proximal + self.distal) / 2.0;
        let along = from.dot(&self.axis());
        (along, from - along * self.axis())
    }
}

/// How far the cylinder close up is turned towards the viewer, degrees.
const TURN: f64 = 30.0;
const TITLE: f64 = 24.0;

fn joint() -> MarkerStyle {
    MarkerStyle { colour: INK, shape: Shape::Circle, hollow: true }
}

fn sensor(part: usize) -> MarkerStyle {
    MarkerStyle { colour: PALETTE[part % PALETTE.len()], shape: Shape::Circle, hollow: false }
}

fn far_sensor(part: usize) -> MarkerStyle {
    let RGBColor(red, green, blue) = sensor(part).colour;
    let pale = |level: u8| 255 - (255 - level) / 3;
    MarkerStyle { colour: RGBColor(pale(red), pale(green), pale(blue)), ..sensor(part) }
}

/// Figure 4.
pub(super) fn render(rows: &[AgentRow]) -> Result<String, PlotError> {
    check("position", rows.iter().flat_map(|row| [row.x_m, row.y_m, row.z_m]), -1e6, 1e6)?;
    let numbers = few("part", rows.iter().map(|row| row.part))?;
    let parts = numbers.iter().map(|&number| Cylinder::of(rows, number)).collect::<Result<Vec<_>, _>>()?;
    let joints: Vec<Vector> = rows.iter().filter(|row| row.kind == AgentPoint::Joint).map(position).collect();
    let first = parts[0].number;
    let legend = legend(first);

    let top = legend.height();
    let widest = WIDTH - 12.0;
    let labels = 46.0;
    // Equal scales, and room for the names of parts beside them.
    let x = around(rows.iter().map(|row| row.x_m), 0.03);
    let scale = (widest - labels) / (x.end - x.start);
    let y = around(rows.iter().map(|row| row.y_m), 0.0);
    let y = y.start - 18.0 / scale..y.end + 34.0 / scale;
    let tallest = 420.0;
    let shrink = (tallest / ((y.end - y.start) * scale)).min(1.0);
    let (scale, width) = (scale * shrink, labels + shrink * (widest - labels));
    let high = (y.end - y.start) * scale;
    let close_up = top + TITLE + high + X_LABELS + TITLE;
    let part = &parts[0];
    let (sine, cosine) = TURN.to_radians().sin_cos();
    let near_scale = (WIDTH - 50.0) / (part.length() * cosine + 2.0 * part.radius * sine);
    let near_scale = near_scale.min(110.0 / part.radius.max(1e-9));
    let near_high = 2.0 * part.radius * near_scale;

    render_svg(close_up + near_high + 52.0, |canvas| {
        legend.render(canvas)?;
        canvas.text("(a) rest pose, seen along z", (8.0, top + 11.0), Anchor::Start, FONT, INK)?;
        let outer =
            Rect { left: 4.0 + (widest - width) / 2.0, top: top + TITLE, width, height: high + X_LABELS };
        let (x, y) = (Axis::new("x / m", x, 6), Axis::new("y / m", y.clone(), (high / 30.0) as usize + 1));
        let panel = Panel::render(canvas, outer, labels, &x, &y)?;
        for part in &parts {
            whole(canvas, &panel, part)?;
        }
        for joint_at in &joints {
            canvas.marker(panel.at(joint_at.x, joint_at.y), 4.5, joint())?;
        }
        let title = format!("(b) part {first} close up, seen {TURN}° off its side");
        canvas.text(&title, (8.0, close_up - 12.0), Anchor::Start, FONT, INK)?;
        let centre = (WIDTH / 2.0, close_up + 8.0 + near_high / 2.0);
        cylinder(canvas, part, centre, near_scale)?;
        scale_bar(canvas, (WIDTH / 2.0, close_up + near_high + 30.0), near_scale, part.length() / 5.0)
    })
}

/// The legend, with the sensors of part `first` as keys.
fn legend(first: usize) -> Legend {
    let mut legend = Legend::default();
    legend.add(Key::Marker(sensor(first), 2.4), "sensor");
    legend.add(Key::Marker(far_sensor(first), 2.4), "sensor on the far side");
    legend.add(Key::Marker(joint(), 4.5), "joint");
    legend
}

/// A part in the plane of x and y.
fn whole(canvas: &Canvas, panel: &Panel, part: &Cylinder) -> Rendered {
    let colour = sensor(part.number).colour;
    let axis = part.axis();
    let side = Vector::new(-axis.y, axis.x, 0.0) * part.radius;
    let place = |point: Vector| panel.at(point.x, point.y);
    let corners = [
        place(part.proximal + side),
        place(part.distal + side),
        place(part.distal - side),
        place(part.proximal - side),
    ];
    canvas.fill(&corners, colour.mix(0.15))?;
    let closed = [corners[0], corners[1], corners[2], corners[3], corners[0]];
    canvas.line(&closed, stroke(colour, 0.8))?;
    for sensor_at in &part.sensors {
        canvas.marker(place(*sensor_at), 1.0, sensor(part.number))?;
    }
    // Beside the middle of the part: above it, or on its right if it is upright or slanted.
    let (x, y) = place((part.proximal + part.distal) / 2.0);
    let (across, down) = (corners[0].0 - corners[3].0, corners[0].1 - corners[3].1);
    let width = across.hypot(down).max(1e-9);
    let text = format!("part {}", part.number);
    if across.abs() < 0.3 * width {
        return canvas.text(&text, (x, y - width / 2.0 - 11.0), Anchor::Middle, FONT, INK);
    }
    let away = (width / 2.0 + 9.0) * across.signum() / width;
    canvas.text(&text, (x + away * across, y + away * down), Anchor::Start, FONT, INK)
}

/// A part seen from its side, turned a little so that its rings are ellipses.
fn cylinder(canvas: &Canvas, part: &Cylinder, centre: Place, scale: f64) -> Rendered {
    let axis = part.axis();
    let vertical = if axis.z.abs() < 0.9 { Vector::z() } else { Vector::y() };
    let up = (vertical - vertical.dot(&axis) * axis).normalize();
    let front = axis.cross(&up);
    let (sine, cosine) = TURN.to_radians().sin_cos();
    let place = |along: f64, height: f64, depth: f64| {
        (centre.0 + scale * (along * cosine + depth * sine), centre.1 - scale * height)
    };
    let half = part.length() / 2.0;
    let ellipse = |along: f64| -> Vec<Place> {
        let turns = (0..=48).map(|at| PI * f64::from(at) / 24.0);
        turns.map(|turn| place(along, part.radius * turn.cos(), part.radius * turn.sin())).collect()
    };
    for end in [-half, half] {
        canvas.line(&ellipse(end), stroke(GREY, 0.8))?;
    }
    for edge in [-part.radius, part.radius] {
        canvas.line(&[place(-half, edge, 0.0), place(half, edge, 0.0)], stroke(GREY, 0.8))?;
    }
    canvas.dashes(place(-half, 0.0, 0.0), place(half, 0.0, 0.0), stroke(GREY, 0.6))?;
    let (mut near, mut far) = (Vec::new(), Vec::new());
    for sensor_at in &part.sensors {
        let (along, off) = part.seen(sensor_at);
        let depth = off.dot(&front);
        // Sensors inside the radius are on an end: the viewer sees the proximal one.
        let on_end = off.norm() < 0.99 * part.radius;
        let visible = if on_end { along < 0.0 } else { depth > -1e-9 };
        if visible { &mut near } else { &mut far }.push(place(along, off.dot(&up), depth));
    }
    for (places, style) in [(far, far_sensor(part.number)), (near, sensor(part.number))] {
        for at in places {
            canvas.marker(at, 2.4, style)?;
        }
    }
    Ok(())
}

/// A bar of a round length of at most `most` metres, with its label.
fn scale_bar(canvas: &Canvas, (x, y): Place, scale: f64, most: f64) -> Rendered {
    let length = 10f64.powf(most.max(1e-6).log10().floor());
    let half = length * scale / 2.0;
    canvas.line(&[(x - half, y), (x + half, y)], stroke(INK, 1.6))?;
    for end in [x - half, x + half] {
        canvas.line(&[(end, y - 4.0), (end, y + 4.0)], stroke(INK, 1.6))?;
    }
    let text = format!("{} m", super::axes::plain(length));
    canvas.text(&text, (x + half + 8.0, y), Anchor::Start, FONT, INK)
}
