//! Draw the pictures of the study.

use std::error::Error;
use std::path::Path;

use plotters::prelude::*;

/// Okabe and Ito's blue and orange.
pub(crate) const BLUE: RGBColor = RGBColor(0, 114, 178);
pub(crate) const ORANGE: RGBColor = RGBColor(213, 94, 0);

/// Pairs of parts of like probability.
pub(crate) struct Bin {
    /// Their mean probability.
    pub predicted: f64,
    /// How many of them are joined, as a share.
    pub observed: f64,
    /// Half of the interval of that.
    pub half: f64,
    /// How many there are.
    pub pairs: usize,
}

/// How often an edge is there against its probability, a panel for each set of bins.
pub(crate) fn reliability(path: &Path, panels: &[(String, Vec<Bin>)]) -> Result<(), Box<dyn Error>> {
    let area = SVGBackend::new(path, (900, 430)).into_drawing_area();
    area.fill(&WHITE)?;
    for (panel, (title, bins)) in area.split_evenly((1, panels.len())).iter().zip(panels) {
        let mut chart = ChartBuilder::on(panel)
            .caption(title, ("sans-serif", 18))
            .margin(10)
            .x_label_area_size(40)
            .y_label_area_size(45)
            .build_cartesian_2d(0.0..1.0, 0.0..1.0)?;
        chart
            .configure_mesh()
            .disable_mesh()
            .x_desc("probability of an edge")
            .y_desc("share that is there")
            .label_style(("sans-serif", 13))
            .draw()?;
        chart.draw_series(LineSeries::new([(0.0, 0.0), (1.0, 1.0)], BLACK.mix(0.4)))?;
        for bin in bins {
            let ends = [bin.observed - bin.half, bin.observed + bin.half].map(|end| end.clamp(0.0, 1.0));
            chart.draw_series([PathElement::new(ends.map(|end| (bin.predicted, end)).to_vec(), BLUE)])?;
            chart.draw_series([Circle::new((bin.predicted, bin.observed), 4, BLUE.filled())])?;
            // Within the panel.
            let across = if bin.predicted > 0.85 { -0.14 } else { 0.02 };
            let place = (bin.predicted + across, (bin.observed - 0.03).max(0.03));
            chart.draw_series([Text::new(format!("n = {}", bin.pairs), place, ("sans-serif", 11))])?;
        }
    }
    area.present()?;
    Ok(())
}

/// A line over seconds.
pub(crate) struct Line {
    pub colour: RGBColor,
    pub name: &'static str,
    /// Whether it is a mean, and not a single chain.
    pub bold: bool,
    pub points: Vec<(f64, f64)>,
}

/// A panel: its title, the name of its vertical axis, and its lines.
pub(crate) struct Panel {
    pub title: String,
    pub axis: &'static str,
    pub lines: Vec<Line>,
}

/// Lines over seconds on a logarithmic axis; `rows` of panels, one below the other.
pub(crate) fn traces(path: &Path, rows: &[Vec<Panel>]) -> Result<(), Box<dyn Error>> {
    let columns = rows.first().map_or(1, Vec::len);
    let area = SVGBackend::new(path, (300 * columns as u32, 260 * rows.len() as u32)).into_drawing_area();
    area.fill(&WHITE)?;
    let areas = area.split_evenly((rows.len(), columns));
    for (at, (area, panel)) in areas.iter().zip(rows.iter().flatten()).enumerate() {
        let points = || panel.lines.iter().flat_map(|line| line.points.iter());
        let ends = |values: &mut dyn Iterator<Item = f64>| {
            values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)))
        };
        let (start, end) = ends(&mut points().map(|point| point.0));
        let (low, high) = ends(&mut points().map(|point| point.1));
        let margin = 0.05 * (high - low).max(1e-6);
        let mut chart = ChartBuilder::on(area)
            .caption(&panel.title, ("sans-serif", 14))
            .margin(8)
            .x_label_area_size(34)
            .y_label_area_size(48)
            .build_cartesian_2d((start..end).log_scale(), low - margin..high + margin)?;
        chart
            .configure_mesh()
            .disable_mesh()
            .x_desc("seconds of a core")
            .y_desc(panel.axis)
            .x_labels(4)
            .y_labels(5)
            .label_style(("sans-serif", 11))
            .draw()?;
        for line in &panel.lines {
            let style =
                if line.bold { line.colour.stroke_width(2) } else { line.colour.mix(0.35).stroke_width(1) };
            let series = chart.draw_series(LineSeries::new(line.points.iter().copied(), style))?;
            if line.bold {
                let colour = line.colour;
                series
                    .label(line.name)
                    .legend(move |(x, y)| PathElement::new([(x, y), (x + 12, y)], colour.stroke_width(2)));
            }
        }
        // One legend for all, where chains start far from each other.
        if at == 0 {
            chart
                .configure_series_labels()
                .position(SeriesLabelPosition::UpperRight)
                .label_font(("sans-serif", 11))
                .draw()?;
        }
    }
    area.present()?;
    Ok(())
}
