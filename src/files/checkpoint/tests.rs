//! Test that a checkpoint is used whole and of the same run, or not at all.

use super::*;

#[test]
fn a_checkpoint_is_used_whole_and_of_the_same_run_or_not_at_all() {
    let folder = tempfile::tempdir().unwrap();
    // The hash of this program is slow to find again and again.
    let same = Checkpoints::new(folder.path(), &("settings", 1));
    let found = vec![(1.0_f64 / 3.0, Some("d")), (5e-324, None), (-0.0, Some("\u{e9}\n"))];
    same.keep("a/b", &found).unwrap();
    let recalled: Option<Vec<(f64, Option<String>)>> = same.recall("a/b");
    let bits = recalled.unwrap().into_iter().map(|(number, _)| number.to_bits());
    assert!(bits.eq(found.iter().map(|(number, _)| number.to_bits())));
    assert!(same.recall::<Vec<(f64, Option<String>)>>("a/c").is_none(), "never kept");
    let other = Checkpoints::new(folder.path(), &("settings", 2));
    assert!(other.recall::<Vec<(f64, Option<String>)>>("a/b").is_none(), "other settings");
    assert!(same.recall::<String>("a/b").is_none(), "something else");

    let path = folder.path().join("checkpoints/a/b.json");
    let whole = fs::read_to_string(&path).unwrap();
    for end in (0..whole.len()).filter(|end| whole.is_char_boundary(*end)) {
        fs::write(&path, &whole[..end]).unwrap();
        assert!(same.recall::<Vec<(f64, Option<String>)>>("a/b").is_none(), "cut at {end}");
    }
    fs::write(&path, whole.replace("0.333", "0.334")).unwrap();
    assert!(same.recall::<Vec<(f64, Option<String>)>>("a/b").is_none(), "changed");
    fs::write(&path, [0xff, 0xfe]).unwrap();
    assert!(same.recall::<Vec<(f64, Option<String>)>>("a/b").is_none(), "no text");
    same.clear().unwrap();
    same.clear().unwrap();
    assert!(!folder.path().join("checkpoints").exists());
}
