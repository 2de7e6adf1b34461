use super::*;

#[test]
fn what_was_found_again_has_a_column_only_where_there_are_repeats() {
    let tables = |repeated: [Option<f64>; 2]| {
        let part = PartLine { part: 3, sensors: 20, rank: 6, residual: 0.01, repeated: repeated[0] };
        let joint = JointLine { parts: [3, 1], support: 0.9, repeated: repeated[1] };
        [part_table(&[part]).into_string(), joint_table(&[joint]).into_string()]
    };
    let [parts, joints] = tables([Some(0.7), Some(0.3)]);
    assert!(parts.contains(r#"<td data-label="found again">70"#), "{parts}");
    assert!(joints.contains(r#"<td data-label="bootstrap support">90"#), "{joints}");
    assert!(joints.contains(r#"<td data-label="found again">30"#), "{joints}");
    assert!(tables([None, None]).iter().all(|table| !table.contains("ound again")));
}
