//! Places on a surface that stand for all of it, with their areas: products of even rules, which keep the symmetry of the shape.
//! The side of a cylinder is rings instead, because the push on a ring has a closed form.

use std::f64::consts::{PI, TAU};

use crate::stages::agent::{Shape, Spot, Vector3};

/// Places around a ring, rings along a cylinder, on its end and on half a ball, and places along an edge of a box.
const AROUND: usize = 12;
const ALONG: usize = 16;
const ENDS: usize = 2;
const ROUND: usize = 6;
const ACROSS: usize = 8;

/// Places that stand for the surface, but for the [side] of a cylinder, with their areas, m².
pub(super) fn places(shape: &Shape) -> Vec<(Spot, f64)> {
    match *shape {
        Shape::Cylinder { radius, length } => around(&ends(radius, length)),
        Shape::Capsule { radius, length } => around(&ball(radius, length)),
        Shape::Sphere { radius } => around(&ball(radius, 0.0)),
        Shape::Box { sides } => faces(sides),
    }
}

/// Rings that stand for the side of a cylinder: the height of each along the axis, m, and its radius times its width, m².
pub(super) fn side(shape: &Shape) -> Vec<(f64, f64)> {
    match *shape {
        Shape::Cylinder { radius, length } | Shape::Capsule { radius, length } => {
            let height = |at: usize| ((at as f64 + 0.5) / ALONG as f64 - 0.5) * length;
            (0..ALONG).map(|at| (height(at), radius * length / ALONG as f64)).collect()
        }
        Shape::Sphere { .. } | Shape::Box { .. } => Vec::new(),
    }
}

/// Places around the axis that share an area.
struct Ring {
    /// Distance from the axis, m.
    off: f64,
    height: f64,
    /// Of the normal, along the axis.
    up: f64,
    area: f64,
}

/// The ends of a cylinder, in rings of equal area.
fn ends(radius: f64, length: f64) -> Vec<Ring> {
    let end = |up: f64| {
        (0..ENDS).map(move |at| Ring {
            off: radius * ((at as f64 + 0.5) / ENDS as f64).sqrt(),
            height: up * length / 2.0,
            up,
            area: PI * radius * radius / ENDS as f64,
        })
    };
    [-1.0, 1.0].into_iter().flat_map(end).collect()
}

/// Two half balls so far apart, in rings of equal height, which have equal areas (Archimedes).
fn ball(radius: f64, apart: f64) -> Vec<Ring> {
    let ring = |(side, at): (f64, usize)| {
        let up = side * (at as f64 + 0.5) / ROUND as f64;
        Ring {
            off: radius * (1.0 - up * up).sqrt(),
            height: radius * up + side * apart / 2.0,
            up,
            area: TAU * radius * radius / ROUND as f64,
        }
    };
    [-1.0, 1.0].into_iter().flat_map(|side| (0..ROUND).map(move |at| (side, at))).map(ring).collect()
}

fn around(rings: &[Ring]) -> Vec<(Spot, f64)> {
    let places = |ring: &Ring| {
        let &Ring { off, height, up, area } = ring;
        let out = (1.0 - up * up).max(0.0).sqrt();
        (0..AROUND)
            .map(move |at| {
                let (sine, cosine) = (TAU * at as f64 / AROUND as f64).sin_cos();
                let position = [off * cosine, off * sine, height];
                (Spot { position, normal: [out * cosine, out * sine, up] }, area / AROUND as f64)
            })
            .collect::<Vec<_>>()
    };
    rings.iter().flat_map(places).collect()
}

fn faces(sides: Vector3) -> Vec<(Spot, f64)> {
    let place = |at: usize| (at as f64 + 0.5) / ACROSS as f64 - 0.5;
    let mut spots = Vec::new();
    for (axis, way) in (0..3).flat_map(|axis| [(axis, -1.0), (axis, 1.0)]) {
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        for (row, column) in (0..ACROSS).flat_map(|row| (0..ACROSS).map(move |column| (row, column))) {
            let (mut position, mut normal) = ([0.0; 3], [0.0; 3]);
            (position[axis], normal[axis]) = (way * sides[axis] / 2.0, way);
            (position[u], position[v]) = (place(row) * sides[u], place(column) * sides[v]);
            spots.push((Spot { position, normal }, sides[u] * sides[v] / (ACROSS * ACROSS) as f64));
        }
    }
    spots
}

#[cfg(test)]
mod tests;
