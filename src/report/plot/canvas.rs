//! Render lines, markers and text as an SVG picture.
//!
//! Pictures are as wide as a column of text; a point is a CSS pixel at that width.

use std::fmt::Display;

use plotters::coord::Shift;
use plotters::drawing::DrawingAreaErrorKind;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

/// Width of every picture.
pub(super) const WIDTH: f64 = 520.0;
/// Size of labels: legible where the picture is shrunk to the width of a phone.
pub(super) const FONT: f64 = 13.0;
/// Size of small print.
pub(super) const SMALL: f64 = 12.0;
/// The backend draws on whole units, so there are several to a point.
const FINE: f64 = 4.0;

/// What is drawn.
pub(super) const INK: RGBColor = RGBColor(0, 0, 0);
/// Axes, lines of reference and what is far away.
pub(super) const GREY: RGBColor = RGBColor(110, 110, 110);
/// An accepted range: pale green, so that lines and markers stand out.
pub(super) const BAND: RGBColor = RGBColor(217, 240, 226);
/// Lines that only guide the eye.
pub(super) const PALE: RGBColor = RGBColor(222, 222, 222);

/// Okabe and Ito's colours, which the colour-blind tell apart; none too pale for a line.
pub(super) const PALETTE: [RGBColor; 7] = [
    BLUE,
    RGBColor(230, 159, 0),
    RGBColor(0, 158, 115),
    VERMILLION,
    RGBColor(86, 180, 233),
    RGBColor(204, 121, 167),
    INK,
];
/// The first of [`PALETTE`].
pub(super) const BLUE: RGBColor = RGBColor(0, 114, 178);
/// What stands out most from it.
pub(super) const VERMILLION: RGBColor = RGBColor(213, 94, 0);

/// Shapes of markers, so that colour is never alone. Their number has no factor in common with that of the
/// colours: the pairs repeat late.
pub(super) const SHAPES: [Shape; 6] =
    [Shape::Circle, Shape::Square, Shape::Triangle, Shape::Diamond, Shape::Plus, Shape::Wedge];

/// Why a picture cannot be drawn, in one line.
#[derive(Debug)]
pub struct PlotError(pub String);

impl<E: std::error::Error + Send + Sync> From<DrawingAreaErrorKind<E>> for PlotError {
    fn from(error: DrawingAreaErrorKind<E>) -> Self {
        Self(format!("cannot be drawn: {error}"))
    }
}

/// Fails with what a table is wrong in.
pub(super) fn plot_error<T>(message: impl Display) -> Result<T, PlotError> {
    Err(PlotError(message.to_string()))
}

/// Outcome of drawing something.
pub(super) type Rendered = Result<(), PlotError>;

/// A place on the picture, in points from its upper left corner.
pub(super) type Place = (f64, f64);

/// Shape of a marker.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Shape {
    /// A disc.
    Circle,
    /// A square on its side.
    Square,
    /// A triangle that points up.
    Triangle,
    /// A square on its corner.
    Diamond,
    /// An upright cross.
    Plus,
    /// A triangle that points down.
    Wedge,
    /// A slanted cross, of lines.
    Cross,
}

/// The marker style of a series: colour, shape, and whether it is hollow.
#[derive(Debug, Clone, Copy)]
pub(super) struct MarkerStyle {
    /// Colour of markers and lines.
    pub colour: RGBColor,
    /// Shape of markers.
    pub shape: Shape,
    /// Whether markers are an outline on white.
    pub hollow: bool,
}

impl MarkerStyle {
    /// The style of series number `at`.
    pub(super) fn of(at: usize) -> Self {
        Self { colour: PALETTE[at % PALETTE.len()], shape: SHAPES[at % SHAPES.len()], hollow: false }
    }
}

/// Where a text stands at its place: it ends, is centred or starts there.
#[derive(Debug, Clone, Copy)]
pub(super) enum Anchor {
    /// Its start.
    Start,
    /// Its middle.
    Middle,
    /// Its end.
    End,
}

/// A picture that is being drawn.
pub(super) struct Canvas<'a> {
    /// The whole area, for axes.
    pub area: DrawingArea<SVGBackend<'a>, Shift>,
}

/// Points in the backend's units.
pub(super) fn fine(points: f64) -> i32 {
    (points * FINE).round() as i32
}

/// A place in the backend's units.
fn fine_place(place: Place) -> (i32, i32) {
    (fine(place.0), fine(place.1))
}

/// Units of the backend in points.
pub(super) fn points(units: i32) -> f64 {
    f64::from(units) / FINE
}

/// A font of `size` points. The backend takes a size of a line, which is 1.24 times that of the font.
pub(super) fn font(size: f64) -> TextStyle<'static> {
    ("sans-serif", size * 1.24 * FINE).into_font().color(&INK)
}

/// A line of `width` points.
pub(super) fn stroke(colour: impl Color, width: f64) -> ShapeStyle {
    colour.stroke_width(fine(width).max(1) as u32)
}

/// About how wide a text is; fonts differ, and this is for one wider than most.
pub(super) fn text_width(text: &str, size: f64) -> f64 {
    let em = |letter: char| match letter {
        ' ' | '.' | ',' | 'i' | 'j' | 'l' | 't' | 'f' | 'r' | '(' | ')' => 0.37,
        'm' | 'w' | 'M' | 'W' | '%' => 0.92,
        letter if letter.is_uppercase() => 0.73,
        _ => 0.62,
    };
    text.chars().map(em).sum::<f64>() * size
}

/// The SVG of a picture of some height.
pub(super) fn render_svg(height: f64, render: impl FnOnce(&Canvas) -> Rendered) -> Result<String, PlotError> {
    let size = (fine(WIDTH) as u32, fine(height) as u32);
    let mut svg = String::new();
    {
        let canvas = Canvas { area: SVGBackend::with_string(&mut svg, size).into_drawing_area() };
        canvas.area.fill(&WHITE)?;
        render(&canvas)?;
        canvas.area.present()?;
    }
    let units = format!("<svg width=\"{}\" height=\"{}\"", size.0, size.1);
    let shown = format!("<svg width=\"{}\" height=\"{}\"", WIDTH, points(size.1 as i32));
    Ok(svg.replacen(&units, &shown, 1))
}

impl Canvas<'_> {
    /// A text whose middle is at the height of its place.
    pub(super) fn text(
        &self,
        text: &str,
        at: Place,
        anchor: Anchor,
        size: f64,
        colour: RGBColor,
    ) -> Rendered {
        let side = match anchor {
            Anchor::Start => HPos::Left,
            Anchor::Middle => HPos::Center,
            Anchor::End => HPos::Right,
        };
        let style = font(size).color(&colour).pos(Pos::new(side, VPos::Center));
        Ok(self.area.draw(&Text::new(text.to_owned(), fine_place(at), style))?)
    }

    /// A text that is read upwards, centred at its place.
    pub(super) fn upwards(&self, text: &str, at: Place, size: f64) -> Rendered {
        let centre = Pos::new(HPos::Center, VPos::Center);
        let style = font(size).transform(FontTransform::Rotate270).pos(centre);
        Ok(self.area.draw(&Text::new(text.to_owned(), fine_place(at), style))?)
    }

    /// A line through places; those in line with their neighbours are left out.
    pub(super) fn line(&self, places: &[Place], style: ShapeStyle) -> Rendered {
        let mut kept: Vec<(i32, i32)> = Vec::new();
        for place in places.iter().map(|&place| fine_place(place)) {
            if let [.., a, b] = kept[..] {
                let (first, second) = ((b.0 - a.0, b.1 - a.1), (place.0 - b.0, place.1 - b.1));
                let (cross, along) =
                    (first.0 * second.1 - first.1 * second.0, first.0 * second.0 + first.1 * second.1);
                if cross == 0 && along >= 0 {
                    kept.pop();
                }
            }
            kept.push(place);
        }
        Ok(self.area.draw(&PathElement::new(kept, style))?)
    }

    /// A dashed straight line.
    pub(super) fn dashes(&self, from: Place, to: Place, style: ShapeStyle) -> Rendered {
        let length = (to.0 - from.0).hypot(to.1 - from.1);
        let along = |way: f64| {
            let share = (way / length).min(1.0);
            (from.0 + share * (to.0 - from.0), from.1 + share * (to.1 - from.1))
        };
        let (dash, gap) = (5.0, 4.0);
        for at in 0..(length / (dash + gap)).ceil() as usize {
            let start = at as f64 * (dash + gap);
            self.line(&[along(start), along(start + dash)], style)?;
        }
        Ok(())
    }

    /// A filled polygon.
    pub(super) fn fill(&self, corners: &[Place], colour: impl Color) -> Rendered {
        let corners: Vec<_> = corners.iter().map(|&place| fine_place(place)).collect();
        Ok(self.area.draw(&Polygon::new(corners, colour.filled()))?)
    }

    /// A filled rectangle between opposite corners, at least a hair wide and high.
    pub(super) fn bar(&self, (x0, y0): Place, (x1, y1): Place, colour: impl Color) -> Rendered {
        let widen = |a: f64, b: f64| {
            if (b - a).abs() < 1.5 { ((a + b) / 2.0 - 0.75, (a + b) / 2.0 + 0.75) } else { (a, b) }
        };
        let ((x0, x1), (y0, y1)) = (widen(x0, x1), widen(y0, y1));
        self.fill(&[(x0, y0), (x1, y0), (x1, y1), (x0, y1)], colour)
    }

    /// A marker of about `radius` points.
    pub(super) fn marker(&self, (x, y): Place, radius: f64, style: MarkerStyle) -> Rendered {
        let line = stroke(style.colour, if style.hollow { 1.4 } else { 1.6 });
        let around = |corners: &[Place]| -> Vec<Place> {
            corners.iter().map(|(dx, dy)| (x + radius * dx, y + radius * dy)).collect()
        };
        let corners = match style.shape {
            Shape::Circle => {
                let disc = |style| Circle::new(fine_place((x, y)), fine(radius), style);
                if !style.hollow {
                    return Ok(self.area.draw(&disc(style.colour.filled()))?);
                }
                self.area.draw(&disc(WHITE.filled()))?;
                return Ok(self.area.draw(&disc(line))?);
            }
            Shape::Cross => {
                self.line(&around(&[(-0.8, -0.8), (0.8, 0.8)]), line)?;
                return self.line(&around(&[(-0.8, 0.8), (0.8, -0.8)]), line);
            }
            Shape::Square => around(&[(-0.88, -0.88), (0.88, -0.88), (0.88, 0.88), (-0.88, 0.88)]),
            Shape::Triangle => around(&[(0.0, -1.2), (1.1, 0.8), (-1.1, 0.8)]),
            Shape::Wedge => around(&[(0.0, 1.2), (1.1, -0.8), (-1.1, -0.8)]),
            Shape::Diamond => around(&[(0.0, -1.25), (1.25, 0.0), (0.0, 1.25), (-1.25, 0.0)]),
            Shape::Plus => {
                let (arm, half) = (1.15, 0.4);
                around(&[
                    (-half, -arm),
                    (half, -arm),
                    (half, -half),
                    (arm, -half),
                    (arm, half),
                    (half, half),
                    (half, arm),
                    (-half, arm),
                    (-half, half),
                    (-arm, half),
                    (-arm, -half),
                    (-half, -half),
                ])
            }
        };
        if !style.hollow {
            return self.fill(&corners, style.colour);
        }
        self.fill(&corners, WHITE)?;
        let closed: Vec<Place> = corners.iter().chain(&corners[..2]).copied().collect();
        self.line(&closed, line)
    }
}
