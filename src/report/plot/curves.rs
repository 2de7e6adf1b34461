//! Render figures 8, 10 and 11: a mean or a rate against d or p, with its interval and sample size.

use std::collections::BTreeSet;

use plotters::style::Color;

use super::super::figure_rows::{Counting, CurveRow};
use super::axes::{Axis, Panel, Rect, Stack, X_LABELS, percent, plain, sparse};
use super::canvas::plot_error;
use super::canvas::{
    Anchor, Canvas, GREY, INK, MarkerStyle, PlotError, Rendered, SMALL, Shape, WIDTH, render_svg, stroke,
    text_width,
};
use super::legend::{FAINT, Key, Legend};
use super::values::{check, distinct, few};
use crate::analysis::published::Mark;

/// What a figure shows.
pub(super) struct Kind {
    /// Whether against p rather than d.
    by_coordination: bool,
    /// Whether rates of trees rather than means of the ARI.
    rates: bool,
}

/// Figures 8a and 8b.
pub(super) const ARI_BY_DIMENSION: Kind = Kind { by_coordination: false, rates: false };
/// Figures 10a and 10b.
pub(super) const TREE_BY_DIMENSION: Kind = Kind { by_coordination: false, rates: true };
/// Figure 11a.
pub(super) const ARI_BY_COORDINATION: Kind = Kind { by_coordination: true, rates: false };
/// Figure 11b.
pub(super) const TREE_BY_COORDINATION: Kind = Kind { by_coordination: true, rates: true };

const Y_LABELS: f64 = 50.0;
/// The same where they are percentages.
const Y_PERCENT: f64 = 66.0;
const N_LINE: f64 = 16.0;
const RADIUS: f64 = 3.8;

impl Kind {
    fn x(&self, row: &CurveRow) -> f64 {
        if self.by_coordination { row.coordination } else { row.dimension as f64 }
    }

    fn check(&self, rows: &[CurveRow]) -> Rendered {
        check("p", rows.iter().map(|row| row.coordination), 0.0, 1.0)?;
        check("d", rows.iter().map(|row| row.dimension as f64), 1.0, 1e6)?;
        let values = rows.iter().flat_map(|row| [row.value, row.cells.lowest, row.cells.highest]).flatten();
        check("value", values, if self.rates { 0.0 } else { -1.0 }, 1.0)?;
        // An interval of few samples may reach beyond what is possible.
        check(
            "interval end",
            rows.iter().flat_map(|row| [row.cells.low, row.cells.high]).flatten(),
            -1e9,
            1e9,
        )?;
        few(if self.by_coordination { "p" } else { "d" }, rows.iter().map(|row| self.x(row)))?;
        few("method", rows.iter().map(|row| row.method.as_str()))?;
        few("clusters", rows.iter().map(|row| row.clusters))?;
        let mut seen = BTreeSet::new();
        // −0 is 0.
        match rows.iter().find(|row| !seen.insert((key(row), (self.x(row) + 0.0).to_bits()))) {
            Some(row) => plot_error(format!("has two rows of {} at {}", row.method, plain(self.x(row)))),
            None => Ok(()),
        }
    }

    fn axes(&self, rows: &[CurveRow]) -> (Axis<'static>, Axis<'static>) {
        let xs = distinct(rows.iter().map(|row| self.x(row)));
        let (first, last) = (xs[0], xs[xs.len() - 1]);
        let room = if self.by_coordination { 0.03 } else { 0.7 };
        // About the width of a label.
        let between = 24.0 * (last - first + 2.0 * room) / (WIDTH - Y_LABELS);
        let x = Axis {
            ticks: sparse(&xs, between),
            ..Axis::new(
                if self.by_coordination {
                    "p, probability that a joint stays locked"
                } else {
                    "d, dimensions of the body map"
                },
                first - room..last + room,
                5,
            )
        };
        let lowest = rows.iter().flat_map(|row| [row.value, row.cells.lowest]).flatten().fold(0.0, f64::min);
        let y = if self.rates {
            Axis { label: percent, ..Axis::new("tree accuracy", -0.04..1.04, 5) }
        } else {
            Axis::new("mean adjusted Rand index", (lowest - 0.03).max(-1.02)..1.02, 5)
        };
        (x, y)
    }
}

/// What tells one series from another.
fn key(row: &CurveRow) -> (&str, Option<usize>, bool) {
    (&row.method, row.clusters, row.counting == Counting::BestDraw)
}

/// Rows of each series, in the order of the table.
fn series(rows: &[CurveRow]) -> Vec<Vec<&CurveRow>> {
    let mut all: Vec<Vec<&CurveRow>> = Vec::new();
    for row in rows {
        match all.iter_mut().find(|series| key(series[0]) == key(row)) {
            Some(series) => series.push(row),
            None => all.push(vec![row]),
        }
    }
    all
}

fn name(method: &str) -> &str {
    match method {
        "ward" => "Ward\u{2019}s method",
        "gmm" => "GMM",
        "dpgmm" => "DPGMM",
        "dpgmm-lj" => "DPGMM-LJ",
        other => other,
    }
}

/// The marker style of a series: each method has the same one in every figure, and extensions of the paper are hollow.
fn style(row: &CurveRow, methods: &[&str]) -> MarkerStyle {
    let at = match row.method.as_str() {
        "dpgmm-lj" => 0,
        "dpgmm" => 3,
        other => 1 + methods.iter().position(|method| *method == other).unwrap_or(0),
    };
    let shape = if at == 3 { Shape::Square } else { MarkerStyle::of(at).shape };
    MarkerStyle { shape, hollow: row.counting == Counting::BestDraw, ..MarkerStyle::of(at) }
}

/// A figure with one panel and a series for each method and way of counting.
pub(super) fn render(rows: &[CurveRow], kind: &Kind, mark: Option<&Mark>) -> Result<String, PlotError> {
    kind.check(rows)?;
    let methods = few("method", rows.iter().map(|row| row.method.as_str()))?;
    let all = series(rows);
    let styles: Vec<MarkerStyle> = all.iter().map(|series| style(series[0], &methods)).collect();

    let legend = legend(rows, kind, &all, &styles, mark);
    let top = legend.height() + N_LINE * all.len() as f64 + 4.0;
    let height = top + 250.0 + X_LABELS;
    render_svg(height, |canvas| {
        legend.render(canvas)?;
        let (x, y) = kind.axes(rows);
        let outer = Rect { left: 4.0, top, width: WIDTH - 10.0, height: height - top - 2.0 };
        let panel = Panel::render(canvas, outer, if kind.rates { Y_PERCENT } else { Y_LABELS }, &x, &y)?;
        if let Some(mark) = mark {
            panel.reference(canvas, mark.value)?;
        }
        // Where there is no room for a label.
        for x in distinct(rows.iter().map(|row| kind.x(row))) {
            let (x, bottom) = panel.at(x, y.range.start);
            canvas.line(&[(x, bottom), (x, bottom + 2.5)], stroke(GREY, 0.8))?;
        }
        curves(canvas, &panel, &all, &styles, kind)?;
        for (at, (series, &style)) in all.iter().zip(&styles).enumerate() {
            let y = top - N_LINE * (all.len() - at) as f64 + N_LINE / 2.0 - 2.0;
            numbers(canvas, &panel, y, series, style, kind)?;
        }
        Ok(())
    })
}

/// The legend of [`render`].
fn legend(
    rows: &[CurveRow],
    kind: &Kind,
    all: &[Vec<&CurveRow>],
    styles: &[MarkerStyle],
    mark: Option<&Mark>,
) -> Legend {
    let mut legend = Legend::default();
    let extensions = styles.iter().filter(|style| style.hollow).count();
    for (series, &style) in all.iter().zip(styles).filter(|(_, style)| !style.hollow) {
        let tree = if kind.rates && series[0].method == "dpgmm" { " + Prim" } else { "" };
        legend.add(Key::Curve(style), format!("{}{tree}", name(&series[0].method)));
    }
    legend.add(Key::Whisker, "95 % interval");
    if let Some(&style) = styles.iter().find(|style| style.hollow) {
        let which = if extensions > 1 { "hollow: " } else { "" };
        legend.add(Key::Marker(style, RADIUS), format!("{which}most probable sample (extension)"));
    }
    if rows.iter().any(|row| row.cells.lowest.is_some()) {
        legend.add(Key::Band(INK, FAINT), "lowest to highest simulation");
    }
    if rows.iter().any(|row| row.value.is_none()) {
        let what = if kind.rates { "no eligible sample" } else { "no sample" };
        legend.add(Key::Marker(missing(), RADIUS), what);
    }
    if let Some(mark) = mark {
        legend.add(Key::Dashes, mark.name.clone());
    }
    legend
}

/// Figure 8a: a panel for each method, a series for each number of clusters.
pub(super) fn baselines(rows: &[CurveRow], mark: Option<&Mark>) -> Result<String, PlotError> {
    let kind = ARI_BY_DIMENSION;
    kind.check(rows)?;
    let mut methods: Vec<&str> = Vec::new();
    for row in rows {
        if !methods.contains(&row.method.as_str()) {
            methods.push(&row.method);
        }
    }
    let told = few("clusters", rows.iter().filter_map(|row| row.clusters))?;
    if told.is_empty() || rows.iter().any(|row| row.clusters.is_none()) {
        return plot_error("has a row without a number of clusters");
    }
    few("method", methods.iter().copied())?;
    let style =
        |row: &CurveRow| MarkerStyle::of(told.iter().position(|k| Some(*k) == row.clusters).unwrap_or(0));

    let legend = baselines_legend(rows, &told, mark);
    let (top, count) = (legend.height(), methods.len());
    let stack = Stack { top, title: 20.0, each: 186.0, width: WIDTH - 10.0, count };
    render_svg(stack.height(), |canvas| {
        legend.render(canvas)?;
        let (x, y) = kind.axes(rows);
        let y = Axis { name: "mean ARI", ..y };
        for (at, method) in methods.iter().enumerate() {
            let x = Axis { name: if stack.is_last(at) { x.name } else { "" }, ..x.clone() };
            let panel = Panel::render(canvas, stack.panel(at), Y_LABELS, &x, &y)?;
            panel.title(canvas, name(method))?;
            if let Some(mark) = mark {
                panel.reference(canvas, mark.value)?;
            }
            let mine: Vec<CurveRow> = rows.iter().filter(|row| row.method == *method).cloned().collect();
            let all = series(&mine);
            let styles: Vec<MarkerStyle> = all.iter().map(|series| style(series[0])).collect();
            curves(canvas, &panel, &all, &styles, &kind)?;
        }
        Ok(())
    })
}

/// The legend of [`baselines`].
fn baselines_legend(rows: &[CurveRow], told: &[usize], mark: Option<&Mark>) -> Legend {
    let mut legend = Legend::default();
    for (at, clusters) in told.iter().enumerate() {
        legend.add(Key::Curve(MarkerStyle::of(at)), format!("K = {clusters}"));
    }
    if let Some(mark) = mark {
        legend.add(Key::Dashes, mark.name.clone());
    }
    let counts = distinct(rows.iter().map(|row| row.cells.n));
    let counts = match counts[..] {
        [n] => format!("n = {n}"),
        [least, .., most] => format!("n = {least} to {most}"),
        [] => String::new(),
    };
    legend.add(Key::Whisker, format!("95 % interval, {counts}"));

    if rows.iter().any(|row| row.cells.lowest.is_some()) {
        legend.add(Key::Band(INK, FAINT), "lowest to highest simulation");
    }
    legend
}

fn missing() -> MarkerStyle {
    MarkerStyle { colour: GREY, shape: Shape::Cross, hollow: false }
}

/// Draws series, beside each other where they share an x.
fn curves(
    canvas: &Canvas,
    panel: &Panel,
    all: &[Vec<&CurveRow>],
    styles: &[MarkerStyle],
    kind: &Kind,
) -> Rendered {
    let xs = distinct(all.iter().flatten().map(|row| kind.x(row)));
    let room =
        xs.windows(2).map(|pair| panel.at(pair[1], 0.0).0 - panel.at(pair[0], 0.0).0).fold(60.0, f64::min);
    let apart = (0.8 * room / all.len() as f64).min(9.0);
    let shift = |at: usize| apart * (at as f64 - (all.len() - 1) as f64 / 2.0);
    let place = |at: usize, row: &CurveRow, y: f64| {
        let (x, y) = panel.at(kind.x(row), y);
        (x + shift(at), y)
    };
    let mut sorted: Vec<(usize, Vec<&CurveRow>, MarkerStyle)> = Vec::new();
    for (at, series) in all.iter().enumerate() {
        let mut series = series.clone();
        series.sort_by(|a, b| kind.x(a).total_cmp(&kind.x(b)));
        sorted.push((at, series, styles[at]));
    }
    // From the back to the front, so that no bar hides a marker.
    for (at, series, style) in sorted.iter().filter(|(.., style)| !style.hollow) {
        for row in series {
            if let (Some(low), Some(high)) = (row.cells.lowest, row.cells.highest) {
                let ((x, low), (_, high)) = (place(*at, row, low), place(*at, row, high));
                canvas.bar((x - 4.0, high), (x + 4.0, low), style.colour.mix(FAINT))?;
            }
        }
        for run in series.split(|row| row.value.is_none()).filter(|run| run.len() > 1) {
            let line: Vec<_> = run.iter().filter_map(|row| Some(place(*at, row, row.value?))).collect();
            canvas.line(&line, stroke(style.colour, 1.4))?;
        }
    }
    for (at, series, style) in &sorted {
        for row in series {
            if let (Some(low), Some(high)) = (row.cells.low, row.cells.high) {
                canvas.line(&[place(*at, row, low), place(*at, row, high)], stroke(style.colour, 1.3))?;
            }
            match row.value {
                Some(value) => canvas.marker(place(*at, row, value), RADIUS, *style)?,
                None => canvas.marker(place(*at, row, 0.0), RADIUS, missing())?,
            }
        }
    }
    Ok(())
}

/// A line of sample sizes above the axes: a rate without them says little.
fn numbers(
    canvas: &Canvas,
    panel: &Panel,
    y: f64,
    series: &[&CurveRow],
    style: MarkerStyle,
    kind: &Kind,
) -> Rendered {
    canvas.marker((panel.inner.left - 40.0, y), RADIUS, style)?;
    canvas.text("n =", (panel.inner.left - 13.0, y), Anchor::End, SMALL, INK)?;
    let mut places: Vec<(f64, String)> =
        series.iter().map(|row| (panel.at(kind.x(row), 0.0).0, row.cells.n.to_string())).collect();
    places.sort_by(|a, b| a.0.total_cmp(&b.0));
    let room = places.windows(2).map(|pair| pair[1].0 - pair[0].0).fold(60.0, f64::min);
    let widest = places.iter().map(|(_, text)| text_width(text, 1.0) + 0.3).fold(0.0, f64::max);
    let size = SMALL.min(room / widest);
    for (x, text) in places {
        canvas.text(&text, (x, y), Anchor::Middle, size, INK)?;
    }
    Ok(())
}
