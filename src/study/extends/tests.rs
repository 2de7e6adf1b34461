use super::*;

#[test]
fn what_a_design_does_not_say_stands_in_the_one_that_it_extends() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    std::fs::write(at("base.toml"), "seed = 1\ntitle = \"a\"\n[draws]\nmovements = 2\nmaps = 3\n").unwrap();
    std::fs::write(at("over.toml"), "extends = \"base.toml\"\nseed = 5\n[draws]\nmovements = 7\n").unwrap();
    let table = |seed| -> Table { DesignText::read(&at("over.toml"), seed).unwrap().text.parse().unwrap() };
    assert_eq!(table(None).to_string(), "seed = 5\ntitle = \"a\"\n\n[draws]\nmaps = 3\nmovements = 7\n");
    assert_eq!(table(Some(9))["seed"].as_integer(), Some(9));
    std::fs::write(at("base.toml"), "extends = \"over.toml\"").unwrap();
    let circle = DesignText::read(&at("over.toml"), None).unwrap_err().to_string();
    assert!(circle.contains("circle"), "{circle}");
    let missing = DesignText::read(&at("nothing.toml"), None).unwrap_err().to_string();
    assert!(missing.contains("nothing.toml") && missing.contains("multiverse"), "{missing}");
}
