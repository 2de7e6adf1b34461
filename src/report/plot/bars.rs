//! Render figures 7 and 9: histograms of the number of parts, and boxes of the adjusted Rand index.

use plotters::style::{Color, WHITE};

use super::super::figure_rows::{BoxRow, Counting, PartsRow};
use super::axes::{Axis, Panel, Rect, X_BARE, X_LABELS, sparse};
use super::canvas::plot_error;
use super::canvas::{
    Anchor, BLUE, Canvas, FONT, GREY, INK, MarkerStyle, PlotError, Rendered, SMALL, Shape, VERMILLION, WIDTH,
    render_svg, stroke,
};
use super::legend::{FAINT, Key, Legend};
use super::values::{check, distinct, few};
use crate::analysis::published::Mark;

/// Opacity of the bars of a histogram.
const BAR: f64 = 0.5;
const COLUMNS: usize = 3;

fn best() -> MarkerStyle {
    MarkerStyle { colour: VERMILLION, shape: Shape::Diamond, hollow: true }
}

/// Figure 7: a histogram of the number of parts for each d.
pub(super) fn parts(rows: &[PartsRow], mark: Option<&Mark>) -> Result<String, PlotError> {
    check("number of parts", rows.iter().map(|row| row.parts as f64), 0.0, 1000.0)?;
    check("mean", rows.iter().map(|row| row.mean), 0.0, 1000.0)?;
    check("interval end", rows.iter().flat_map(|row| [row.low, row.high]).flatten(), -1e9, 1e9)?;
    let dimensions = few("d", rows.iter().map(|row| row.dimension))?;
    let of = |counting| rows.iter().filter(move |row| row.counting == counting);
    let Some(most) = of(Counting::AllDraws).map(|row| row.count).max() else {
        return plot_error("has no row that counts all samples");
    };

    let legend = parts_legend(of(Counting::BestDraw).next().is_some(), mark);
    let (above, each) = (24.0, 116.0);
    let lines = dimensions.len().div_ceil(COLUMNS);
    let top = legend.height();
    let height = top + lines as f64 * (above + each) + X_LABELS - X_BARE + 2.0;

    let numbers = distinct(rows.iter().map(|row| row.parts as f64).chain(mark.map(|mark| mark.value)));
    let range = numbers[0] - 0.8..numbers[numbers.len() - 1] + 0.8;
    let every = 17.0 * (range.end - range.start) / (each - X_BARE);
    let whole: Vec<f64> =
        Axis::new("", range.clone(), 30).ticks.into_iter().filter(|at| at.fract() == 0.0).collect();
    let most = most as f64;
    let left = 22.0;
    let wide = (WIDTH - left - 4.0) / COLUMNS as f64;
    render_svg(height, |canvas| {
        legend.render(canvas)?;
        for (at, dimension) in dimensions.iter().enumerate() {
            let (line, column) = (at / COLUMNS, at % COLUMNS);
            let lowest = at + COLUMNS >= dimensions.len();
            let x = Axis::new(if lowest { "samples" } else { "" }, 0.0..1.12 * most.max(1.0), 2);
            let x = Axis { ticks: x.ticks.into_iter().filter(|tick| tick.fract() == 0.0).collect(), ..x };
            let y = Axis { ticks: sparse(&whole, every), ..Axis::new("", range.clone(), 5) };
            let outer = Rect {
                left: left + column as f64 * wide,
                top: top + line as f64 * (above + each) + above,
                width: wide - 18.0,
                height: each + if lowest { X_LABELS - X_BARE } else { 0.0 },
            };
            let panel = Panel::render(canvas, outer, 24.0, &x, &y)?;
            if column == 0 {
                let middle = panel.inner.top + panel.inner.height / 2.0;
                canvas.upwards("parts", (12.0, middle), FONT)?;
            }
            one_dimension(canvas, &panel, x.range.end, rows, *dimension, mark)?;
        }
        Ok(())
    })
}

/// The histogram of one d, with its title and, at `end` of the axis, the mean of the posterior samples of highest log posterior.
fn one_dimension(
    canvas: &Canvas,
    panel: &Panel,
    end: f64,
    rows: &[PartsRow],
    dimension: usize,
    mark: Option<&Mark>,
) -> Rendered {
    let of = |counting| rows.iter().filter(move |row| row.dimension == dimension && row.counting == counting);
    panel.title(canvas, &title(dimension, of(Counting::AllDraws).next()))?;
    histogram(canvas, panel, of(Counting::AllDraws), mark)?;
    if let Some(row) = of(Counting::BestDraw).next() {
        let (x, y) = panel.at(end, row.mean);
        // Beside the histogram, since it is not a count.
        canvas.marker((x + 8.0, y), 4.4, best())?;
    }
    Ok(())
}

/// The legend of [`parts`]; `extension` says whether the posterior samples of highest log posterior are shown.
fn parts_legend(extension: bool, mark: Option<&Mark>) -> Legend {
    let mut legend = Legend::default();
    legend.add(Key::Band(BLUE, BAR), "posterior samples");
    legend.add(Key::Line(INK, 2.0), "mean");
    legend.add(Key::Band(INK, FAINT), "its 95 % interval");
    if let Some(mark) = mark {
        legend.add(Key::Dashes, mark.name.clone());
    }
    if extension {
        legend.add(Key::Marker(best(), 4.4), "mean of the most probable samples (extension)");
    }
    legend
}

fn title(dimension: usize, row: Option<&PartsRow>) -> String {
    row.map_or(format!("d = {dimension}"), |row| format!("d = {dimension}, n = {}", row.n))
}

fn histogram<'a>(
    canvas: &Canvas,
    panel: &Panel,
    rows: impl Iterator<Item = &'a PartsRow>,
    mark: Option<&Mark>,
) -> Rendered {
    let (left, right) = (panel.inner.left, panel.inner.left + panel.inner.width);
    let mut mean = None;
    for row in rows {
        let parts = row.parts as f64;
        canvas.bar(panel.at(0.0, parts + 0.4), panel.at(row.count as f64, parts - 0.4), BLUE.mix(BAR))?;
        mean = Some((row.mean, row.low.zip(row.high)));
    }
    if let Some(mark) = mark {
        panel.reference(canvas, mark.value)?;
    }
    if let Some((mean, interval)) = mean {
        let y = |parts| panel.at(0.0, parts).1;
        if let Some((low, high)) = interval {
            canvas.bar((left, y(low)), (right, y(high)), INK.mix(FAINT))?;
        }
        canvas.line(&[(left, y(mean)), (right, y(mean))], stroke(INK, 2.0))?;
    }
    Ok(())
}

/// Checks that the boxes can be placed on a picture.
fn check_boxes(rows: &[BoxRow]) -> Rendered {
    check("d", rows.iter().map(|row| row.dimension as f64), 1.0, 1e6)?;
    if few("d", rows.iter().map(|row| row.dimension))?.len() < rows.len() {
        return plot_error("has two rows of the same d");
    }
    for row in rows {
        let ends = [
            row.lowest,
            row.whisker_low,
            row.lower_quartile,
            row.median,
            row.upper_quartile,
            row.whisker_high,
            row.highest,
        ];
        check("ARI", ends, -1.0, 1.0)?;
        let inner = [row.lowest, row.lower_quartile, row.median, row.upper_quartile, row.highest];
        if !inner.is_sorted() {
            return plot_error(format!("has quartiles out of order at d = {}", row.dimension));
        }
    }
    Ok(())
}

/// Figure 9: a box of ARIs for each d.
pub(super) fn boxes(rows: &[BoxRow]) -> Result<String, PlotError> {
    check_boxes(rows)?;
    let mut legend = Legend::default();
    legend.add(Key::Line(VERMILLION, 2.6), "median");
    legend.add(Key::Band(BLUE, FAINT), "quartiles");
    legend.add(Key::Line(INK, 1.2), "within 1.5 interquartile ranges");
    legend.add(Key::Marker(extreme(), 3.2), "lowest or highest, if beyond");

    let numbers = 16.0;
    let top = legend.height() + numbers + 4.0;
    let height = top + 260.0 + X_LABELS;
    render_svg(height, |canvas| {
        legend.render(canvas)?;
        let dimensions = distinct(rows.iter().map(|row| row.dimension as f64));
        let range = dimensions[0] - 0.7..dimensions[dimensions.len() - 1] + 0.7;
        let between = 24.0 * (range.end - range.start) / (WIDTH - 62.0);
        let x = Axis::new("d, dimensions of the body map", range, 5);
        let x = Axis { ticks: sparse(&dimensions, between), ..x };
        let lowest = rows.iter().map(|row| row.lowest).fold(0.0, f64::min);
        let y = Axis::new("adjusted Rand index", (lowest - 0.03).max(-1.02)..1.02, 5);
        let outer = Rect { left: 4.0, top, width: WIDTH - 10.0, height: height - top - 2.0 };
        let panel = Panel::render(canvas, outer, 52.0, &x, &y)?;
        let line = top - numbers / 2.0 - 2.0;
        canvas.text("n =", (panel.inner.left - 6.0, line), Anchor::End, SMALL, INK)?;
        let step = panel.at(x.range.start + 1.0, 0.0).0 - panel.inner.left;
        for row in rows {
            one_box(canvas, &panel, row, (0.32 * step).clamp(2.0, 12.0))?;
            let at = panel.at(row.dimension as f64, 0.0).0;
            let text = row.n.to_string();
            let size = SMALL.min(step.max(12.0) / (super::canvas::text_width(&text, 1.0) + 0.3));
            canvas.text(&text, (at, line), Anchor::Middle, size, INK)?;
        }
        Ok(())
    })
}

fn extreme() -> MarkerStyle {
    MarkerStyle { colour: GREY, shape: Shape::Circle, hollow: false }
}

fn one_box(canvas: &Canvas, panel: &Panel, row: &BoxRow, half: f64) -> Rendered {
    let at = |ari: f64| panel.at(row.dimension as f64, ari);
    let ((x, upper), (_, lower)) = (at(row.upper_quartile), at(row.lower_quartile));
    for (end, edge) in [(row.whisker_low, lower), (row.whisker_high, upper)] {
        let (_, y) = at(end);
        canvas.line(&[(x, edge), (x, y)], stroke(INK, 1.2))?;
        canvas.line(&[(x - half / 2.0, y), (x + half / 2.0, y)], stroke(INK, 1.2))?;
    }
    canvas.bar((x - half, upper), (x + half, lower), WHITE)?;
    canvas.bar((x - half, upper), (x + half, lower), BLUE.mix(FAINT))?;
    let corners =
        [(x - half, upper), (x + half, upper), (x + half, lower), (x - half, lower), (x - half, upper)];
    canvas.line(&corners, stroke(BLUE, 1.2))?;
    let (_, median) = at(row.median);
    canvas.line(&[(x - half, median), (x + half, median)], stroke(VERMILLION, 2.6))?;
    for (end, whisker) in [(row.lowest, row.whisker_low), (row.highest, row.whisker_high)] {
        if end != whisker {
            canvas.marker(at(end), 3.2, extreme())?;
        }
    }
    Ok(())
}
