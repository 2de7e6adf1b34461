//! Test every picture from a small table, and tables that cannot be rendered.

use std::f64::consts::TAU;

use super::*;
use crate::analysis::cells::EstimateCells;
use crate::files::tables::write_rows;
use crate::report::figure_rows::{
    AgentPoint, AgentRow, AngleRow, BoxRow, Counting, CurveRow, MapPoint, MapRow, PartsRow,
};

fn count(svg: &str, what: &str) -> usize {
    svg.matches(what).count()
}

fn agent() -> Vec<AgentRow> {
    let row = |part, kind, x_m: f64, turn: f64| AgentRow {
        part,
        kind,
        x_m: part as f64 * 0.6 + x_m,
        y_m: 0.03 * turn.sin(),
        z_m: 0.03 * turn.cos(),
    };
    let mut rows = Vec::new();
    for part in 0..2 {
        rows.push(AgentRow { z_m: 0.0, ..row(part, AgentPoint::ProximalEnd, 0.0, 0.0) });
        rows.push(AgentRow { z_m: 0.0, ..row(part, AgentPoint::DistalEnd, 0.5, 0.0) });
        rows.extend((0..12).map(|at| row(part, AgentPoint::Sensor, 0.25, TAU * f64::from(at) / 12.0)));
    }
    rows.push(row(1, AgentPoint::Joint, -0.05, 0.0));
    rows
}

fn map(dims: usize, joints: usize) -> Vec<MapRow> {
    let row = |kind, index: usize, group| MapRow {
        kind,
        index,
        group,
        x1: (index as f64).sin(),
        x2: (index as f64).cos(),
        x3: (dims == 3).then_some(index as f64 / 20.0),
    };
    let sensors = (0..20).map(|at| row(MapPoint::Sensor, at, Some(0)));
    sensors.chain((0..joints).map(|at| row(MapPoint::Joint, at, None))).collect()
}

fn curve(method: &str, clusters: Option<usize>, counting: Counting, at: (f64, usize)) -> CurveRow {
    CurveRow {
        method: method.to_owned(),
        clusters,
        counting,
        coordination: at.0,
        dimension: at.1,
        value: Some(0.5),
        cells: EstimateCells {
            n: 37,
            low: Some(0.4),
            high: Some(0.6),
            simulations: 2,
            lowest: Some(0.45),
            highest: Some(0.55),
        },
    }
}

fn parts() -> Vec<PartsRow> {
    let bar = |dimension, parts| PartsRow {
        dimension,
        counting: Counting::AllDraws,
        parts,
        count: 9,
        n: 18,
        mean: 5.5,
        low: Some(5.0),
        high: None,
    };
    (2..16).flat_map(|dimension| [bar(dimension, 5), bar(dimension, 6)]).collect()
}

/// A small table for each figure.
fn tables(folder: &Path) {
    let at = |name: &str| folder.join(format!("{name}.csv"));
    let angle = |p, time: i32, joint| AngleRow {
        coordination: p,
        time_s: f64::from(time),
        joint,
        angle1_rad: if time < 5 { 3.0 } else { -3.0 },
        angle2_rad: 0.1 * f64::from(time),
    };
    let angles = [0.0, 0.9, 1.0].into_iter().flat_map(|p| (0..10).map(move |time| angle(p, time, 1)));
    write_rows(&at("fig04-agent"), agent()).unwrap();
    write_rows(&at("fig05-angles"), angles).unwrap();
    write_rows(&at("fig06a-map-2d"), map(2, 0)).unwrap();
    write_rows(&at("fig06b-map-3d"), map(3, 0)).unwrap();
    write_rows(&at("fig06c-clusters-2d"), map(2, 4)).unwrap();
    write_rows(&at("fig06d-clusters-3d"), map(3, 4)).unwrap();
    write_rows(&at("fig07-parts"), parts()).unwrap();
    let told =
        |method, clusters| [2, 5, 14].map(|d| curve(method, Some(clusters), Counting::AllDraws, (0.9, d)));
    let baselines = ["ward", "k-means", "gmm"].into_iter().flat_map(|method| [3, 5].map(|k| told(method, k)));
    write_rows(&at("fig08a-ari-baselines"), baselines.flatten()).unwrap();
    let both = [Counting::AllDraws, Counting::BestDraw];
    let by_d =
        |method| both.into_iter().flat_map(move |way| [2, 5, 14].map(|d| curve(method, None, way, (0.9, d))));
    let by_p = || {
        both.into_iter().flat_map(|way| [0.0, 0.9, 0.95, 1.0].map(|p| curve("dpgmm-lj", None, way, (p, 14))))
    };
    write_rows(&at("fig08b-ari"), by_d("dpgmm").chain(by_d("dpgmm-lj"))).unwrap();
    let ari = BoxRow {
        dimension: 2,
        n: 20,
        lowest: -0.1,
        whisker_low: 0.5,
        lower_quartile: 0.6,
        median: 0.7,
        upper_quartile: 0.8,
        whisker_high: 1.0,
        highest: 1.0,
    };
    write_rows(&at("fig09-ari-box"), [ari]).unwrap();
    write_rows(&at("fig10a-tree-baseline"), by_d("dpgmm")).unwrap();
    write_rows(&at("fig10b-tree"), by_d("dpgmm-lj")).unwrap();
    write_rows(&at("fig11a-ari"), by_p()).unwrap();
    write_rows(&at("fig11b-tree"), by_p()).unwrap();
}

#[test]
fn every_figure_with_a_table_is_rendered_and_always_the_same() {
    let folder = tempfile::tempdir().unwrap();
    assert!(render(folder.path()).unwrap().is_empty());
    tables(folder.path());
    let pictures = render(folder.path()).unwrap();
    assert!(pictures.iter().map(|picture| picture.name.as_str()).eq(FIGURES.map(|(name, _)| name)));
    assert_eq!(render(folder.path()).unwrap(), pictures);
    for Picture { name, svg } in &pictures {
        assert_eq!(std::fs::read_to_string(folder.path().join(format!("{name}.svg"))).unwrap(), *svg);
        assert!(
            svg.starts_with("<svg width=\"520\" height=\"") && svg.trim_end().ends_with("</svg>"),
            "{name}"
        );
        assert!(!svg.contains("NaN") && !svg.contains("inf"), "{name}");
    }
    let of = |name: &str| &pictures.iter().find(|picture| picture.name.starts_with(name)).unwrap().svg;
    // All sensors of the body, those of the close-up, three keys, and a joint with its outline.
    assert_eq!(count(of("fig04"), "<circle"), 24 + 12 + 2 + 2 + 2);
    assert_eq!(count(of("fig05"), "\np = "), 3);
    assert_eq!(count(of("fig06a"), "<circle"), 20 + 1);
    // In both views.
    assert_eq!(count(of("fig06d"), "<circle"), 2 * (20 + 2 * 4) + 1 + 2);
    assert_eq!(count(of("fig07"), "\nd = "), 14);
    assert_eq!(count(of("fig08a"), "\nmean ARI\n"), 3);
    assert!(of("fig08b").contains("extension") && of("fig08b").contains("DPGMM-LJ"));
    assert_eq!(count(of("fig10a"), "\n37\n"), 6);
    assert!(of("fig11b").contains("\n100 %\n"));
}

#[test]
fn an_angle_that_wraps_is_not_a_line_across() {
    let folder = tempfile::tempdir().unwrap();
    tables(folder.path());
    render(folder.path()).unwrap();
    let svg = std::fs::read_to_string(folder.path().join("fig05-angles.svg")).unwrap();
    let heights = |line: &str| -> Vec<i32> {
        line.split(' ').filter_map(|place| place.split_once(',')?.1.parse().ok()).collect()
    };
    let lines = svg.lines().filter(|line| line.contains("stroke=\"#0072B2\""));
    let lines = lines.filter_map(|line| line.split("points=\"").nth(1)?.split('"').next());
    let spans: Vec<i32> =
        lines.map(heights).map(|ys| ys.iter().max().unwrap() - ys.iter().min().unwrap()).collect();
    // Of each p the first angle before and after the jump, and the second one; in quarters of a point.
    assert_eq!(spans.len(), 3 * 3);
    assert!(spans.iter().all(|span| *span < 150), "{spans:?}");
}

#[test]
fn a_condition_without_a_sample_is_marked() {
    let folder = tempfile::tempdir().unwrap();
    let mut rows = [2, 5, 14].map(|d| curve("dpgmm", None, Counting::AllDraws, (0.9, d)));
    rows[1].value = None;
    (rows[1].cells.n, rows[1].cells.low, rows[1].cells.high) = (0, None, None);
    write_rows(&folder.path().join("fig10a-tree-baseline.csv"), &rows).unwrap();
    render(folder.path()).unwrap();
    let svg = std::fs::read_to_string(folder.path().join("fig10a-tree-baseline.svg")).unwrap();
    assert!(svg.contains("no eligible sample") && svg.contains("\n0\n"));
}

#[test]
fn a_table_that_cannot_be_rendered_is_named_with_its_mistake() {
    let rejects = |name: &str, text: &str, expected: &str| {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join(format!("{name}.csv")), text).unwrap();
        let message = render(folder.path()).unwrap_err().to_string();
        assert!(message.contains(&format!("{name}.csv: ")), "{message:?}");
        assert!(message.contains(expected) && !message.contains('\n'), "{message:?} lacks {expected:?}");
        assert!(!folder.path().join(format!("{name}.svg")).exists());
    };
    for (name, _) in FIGURES {
        rejects(name, "", "has no rows");
        rejects(name, "colour,taste\nred,sweet\n", "line 2: ");
    }
    let map = "kind,index,group,x1,x2\n";
    rejects("fig06a-map-2d", &format!("{map}sensor,0,1,0.5,NaN\n"), "coordinate NaN");
    rejects("fig06a-map-2d", &format!("{map}sensor,0,,0.5,0.5\n"), "sensor 0 has no group");
    rejects("fig06a-map-2d", &format!("{map}joint,0,,0.5,0.5\n"), "has no sensors");
    rejects("fig06b-map-3d", &format!("{map}sensor,0,1,0.5,0.5\n"), "must have coordinates in 3 dimensions");
    rejects("fig04-agent", "part,kind,x_m,y_m,z_m\n0,sensor,0,0,0\n", "part 0 lacks an end");
    rejects("fig05-angles", "coordination,time_s,joint,angle1_rad,angle2_rad\n0,0,1,4,0\n", "angle 4");
    let parts = "dimension,counting,parts,count,n,mean,low,high\n";
    rejects("fig07-parts", &format!("{parts}2,best-draw,5,1,1,5,,\n"), "no row that counts all samples");
    let many: String = (0..100).map(|d| format!("{d},all-draws,5,1,1,5,,\n")).collect();
    rejects("fig07-parts", &format!("{parts}{many}"), "100 different values of d");
    let curve =
        "method,clusters,counting,coordination,dimension,value,n,low,high,simulations,lowest,highest\n";
    let row = "ward,,all-draws,0.9,2,0.5,1,,,1,,\n";
    rejects("fig08a-ari-baselines", &format!("{curve}{row}"), "without a number of clusters");
    rejects("fig08b-ari", &format!("{curve}{row}{row}"), "two rows of ward at 2");
    rejects("fig10b-tree", &format!("{curve}{}", row.replace("0.5", "-0.5")), "value -0.5");
    let ari = "dimension,n,lowest,whisker_low,lower_quartile,median,upper_quartile,whisker_high,highest\n";
    rejects("fig09-ari-box", &format!("{ari}2,9,0,0,0.5,0.4,0.6,1,1\n"), "quartiles out of order at d = 2");
}
