//! Render the legend above a picture.

use plotters::style::{Color, RGBColor};

use super::canvas::{
    Anchor, Canvas, FONT, GREY, INK, MarkerStyle, Place, Rendered, WIDTH, stroke, text_width,
};

const LINE: f64 = 19.0;
const KEY: f64 = 26.0;
const GAP: f64 = 14.0;

/// How an entry's key is drawn.
#[derive(Debug, Clone, Copy)]
pub(super) enum Key {
    /// A marker of a radius.
    Marker(MarkerStyle, f64),
    /// A marker on a line with an interval.
    Curve(MarkerStyle),
    /// A line of a width.
    Line(RGBColor, f64),
    /// A dashed line.
    Dashes,
    /// A vertical line: an interval.
    Whisker,
    /// A bar or band of a colour and an opacity.
    Band(RGBColor, f64),
    /// No key and no text: what follows is on a new line.
    Break,
}

/// Opacity of bands and bars behind the data.
pub(super) const FAINT: f64 = 0.28;

/// Keys and what they mean.
#[derive(Debug, Default)]
pub(super) struct Legend(pub Vec<(Key, String)>);

impl Legend {
    /// Adds an entry.
    pub(super) fn add(&mut self, key: Key, text: impl Into<String>) {
        self.0.push((key, text.into()));
    }

    /// The place of each entry, and the height of all.
    fn layout(&self) -> (Vec<Place>, f64) {
        let (mut x, mut y) = (8.0, 12.0);
        let mut places = Vec::new();
        for (key, text) in &self.0 {
            let width = KEY + text_width(text, FONT);
            let new_line = x + width > WIDTH - 4.0 || matches!(key, Key::Break);
            if x > 8.0 && new_line {
                (x, y) = (8.0, y + LINE);
            }
            places.push((x, y));
            x += if matches!(key, Key::Break) { 0.0 } else { width + GAP };
        }
        (places, if self.0.is_empty() { 0.0 } else { y + LINE / 2.0 + 2.0 })
    }

    /// Height that the legend takes at the top of a picture.
    pub(super) fn height(&self) -> f64 {
        self.layout().1
    }

    /// Draws the legend at the top of the picture.
    pub(super) fn render(&self, canvas: &Canvas) -> Rendered {
        for ((key, text), (x, y)) in self.0.iter().zip(self.layout().0) {
            let (left, right, middle) = (x, x + KEY - 6.0, x + KEY / 2.0 - 3.0);
            match *key {
                Key::Marker(style, radius) => canvas.marker((middle, y), radius, style)?,
                Key::Curve(style) => {
                    canvas.line(&[(left, y), (right, y)], stroke(style.colour, 1.6))?;
                    canvas.line(&[(middle, y - 7.0), (middle, y + 7.0)], stroke(style.colour, 1.4))?;
                    canvas.marker((middle, y), 3.6, style)?;
                }
                Key::Line(colour, width) => canvas.line(&[(left, y), (right, y)], stroke(colour, width))?,
                Key::Dashes => canvas.dashes((left, y), (right, y), stroke(GREY, 1.2))?,
                Key::Band(colour, opacity) => {
                    canvas.bar((middle - 5.0, y - 7.0), (middle + 5.0, y + 7.0), colour.mix(opacity))?;
                }
                Key::Whisker => canvas.line(&[(middle, y - 7.0), (middle, y + 7.0)], stroke(INK, 1.4))?,
                Key::Break => continue,
            }
            canvas.text(text, (x + KEY, y), Anchor::Start, FONT, INK)?;
        }
        Ok(())
    }
}
