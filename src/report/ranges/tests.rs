use super::super::figure_rows::Counting;
use super::*;
use crate::analysis::cells::EstimateCells;
use crate::analysis::claims::Verdict;

fn row(unit: Unit, accepted: (f64, f64), value: Option<f64>, interval: Option<(f64, f64)>) -> Row {
    let (low, high) = interval.unzip();
    Row {
        id: "claim".to_owned(),
        counting: Counting::AllDraws,
        reading: None,
        figure: String::new(),
        place: String::new(),
        statement: String::new(),
        unit: Some(unit),
        published: None,
        wording: String::new(),
        value,
        cells: EstimateCells { n: 20, low, high, ..EstimateCells::default() },
        accepted_low: Some(accepted.0),
        accepted_high: Some(accepted.1),
        verdict: Some(Verdict::Reproduced),
        found: String::new(),
        bodies: None,
        bodies_share: None,
        bodies_low: None,
        bodies_high: None,
        bodies_together: None,
        one_body: None,
    }
}

fn svg(row: &Row) -> String {
    drawing(row).unwrap().into_string()
}

#[track_caller]
fn assert_has(svg: &str, parts: &[&str]) {
    parts.iter().for_each(|part| assert!(svg.contains(part), "{svg} lacks {part}"));
}

#[test]
fn band_tick_dot_and_interval_are_where_the_numbers_are() {
    // A rate's axis is 148 px long and begins at 10 px.
    let row = Row { published: Some(0.25), ..row(Unit::Rate, (0.5, 1.0), Some(0.75), Some((0.5, 1.0))) };
    let svg = svg(&row);
    let words = "accepted 50.0 to 100 %, published 25.0 %, reproduced 75.0 %, 95 % interval 50.0 to 100 %";
    assert_has(
        &svg,
        &[
            r#"<rect class="band" x="84" y="5" width="74""#,
            r#"<line class="published" x1="47""#,
            r#"<circle class="value" cx="121""#,
            r#"<line class="interval" x1="84" y1="13" x2="158""#,
            r#"role="img""#,
            &format!("aria-label=\"{words}\""),
            &format!("<title>{words}</title>"),
            ">0 %</text>",
            ">100 %</text>",
        ],
    );
    assert!(!svg.contains("beyond"), "{svg}");
}

#[test]
fn the_axis_depends_on_the_unit() {
    let of = |unit| {
        let Axis { low, high } = Axis::new(unit, (5.0, 6.0));
        (low, high)
    };
    assert_eq!(of(Unit::Parts), (2.0, 9.0));
    assert_eq!(of(Unit::Dimension), (1.0, 15.0));
    for unit in [Unit::Rate, Unit::Ari, Unit::Coordination, Unit::PValue] {
        assert_eq!(of(unit), (0.0, 1.0));
    }
    assert_eq!(Axis::new(Unit::Parts, (1.0, 2.0)).low, 0.0);
}

#[test]
fn a_range_of_one_number_has_a_band_around_it() {
    let svg = svg(&row(Unit::Dimension, (8.0, 8.0), Some(8.0), None));
    assert_has(&svg, &[r#"<rect class="band" x="82" y="5" width="4""#, r#"cx="84""#]);
}

#[test]
fn what_lies_beyond_the_axis_is_an_open_marker_at_its_end() {
    let below = svg(&row(Unit::Ari, (-0.2, 0.2), Some(-0.1), Some((-0.3, 0.5))));
    assert_has(
        &below,
        &[
            // The triangle points to the left, as does the arrow of the interval's lower end.
            r#"<polygon class="beyond" points="10,7.5 2,13 10,18.5""#,
            r#"<polyline class="interval" points="14,9 10,13 14,17""#,
            r#"<polyline class="interval" points="84,9 84,13 84,17""#,
            r#"<rect class="band" x="10" y="5" width="29.6""#,
        ],
    );
    assert!(!below.contains("<circle"), "{below}");
    let above = svg(&row(Unit::Parts, (5.0, 6.0), Some(12.0), None));
    assert_has(&above, &[r#"<polygon class="beyond" points="158,7.5 166,13 158,18.5""#]);
}

#[test]
fn without_a_value_only_the_range_is_drawn_and_without_a_range_nothing() {
    let none = row(Unit::Rate, (0.5, 1.0), None, None);
    let svg = svg(&none);
    assert_has(&svg, &["band", "accepted 50.0 to 100 %, no reproduced value"]);
    assert!(!svg.contains("circle") && !svg.contains("interval"), "{svg}");
    assert!(drawing(&Row { accepted_low: None, accepted_high: None, ..none.clone() }).is_none());
    assert!(drawing(&Row { unit: None, ..none }).is_none());
}
