//! Test how a file of settings is read, and what is wrong with one.

use super::*;
use crate::stages::schema::EdgeWeight;

fn load(text: &str) -> Result<Settings, SettingsError> {
    let file = tempfile::NamedTempFile::new().unwrap();
    std::fs::write(file.path(), text).unwrap();
    Settings::load(false, Some(file.path()))
}

#[test]
fn both_files_of_the_repository_load() {
    let paper = Settings::load(false, None).unwrap();
    assert_eq!(paper, Settings::paper());
    assert_eq!((paper.physics.samples(0.1), paper.physics.steps_per_sample(0.1)), (100_000, 10));
    assert!(Settings::load(true, None).unwrap().physics.samples(0.1) < 100_000);
}

#[test]
fn a_file_changes_only_what_it_names() {
    let mut expected = Settings::paper();
    expected.motion.coordination = 1.0;
    expected.schema.edge_weight = EdgeWeight::Collapsed;
    assert_eq!(load("[motion]\ncoordination = 1\n[schema]\nedge_weight = \"collapsed\"").unwrap(), expected);
}

#[test]
fn mistakes_are_named() {
    for (text, expected) in [
        ("[motion]\nspeed = 3", "unknown setting `motion.speed`"),
        ("[moton]\nepoch = 3", "unknown setting `moton`"),
        ("[motion]\nepoch = \"long\"", "`motion.epoch` has type string, but must have type integer"),
        ("[motion]\nepoch = -3", "motion.epoch"),
        ("[motion\nepoch = 3", "line 1:"),
        ("[schema]\ncomponents = 0", "`schema.components` is 0, but must be 1 to 1000"),
        ("[schema]\nedge_weight = \"prim\"", "unknown variant `prim`"),
        ("[physics]\nstep = nan", "`physics.step` is NaN"),
        ("[agent]\ndensity = 1e-320", "agent.density"),
        ("[physics]\nduration = 1e9", "`physics.duration` is 1000000000"),
        ("[physics]\nstep = 0.03", "a whole number of physics.step"),
        ("[skin]\ncaps = 3", "even"),
        ("[experiment]\ndimensions = []", "experiment.dimensions"),
    ] {
        let message = load(text).unwrap_err().to_string();
        assert!(message.contains(expected), "{text:?} gave {message:?}");
        assert!(!message.contains('\n'), "{message:?} is one line");
    }
}
