//! The rules of the house, read from the `use` lines and paths of `src`: rooms import only rooms below them, files never
//! import each other in a circle or the `mod.rs` of their folder, and the core knows no files, terminal or plots.
//!
//! There is no list of exceptions. Each rule is shown to find a file that breaks it.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

/// The rooms from the ground up: each imports only those before it.
const ROOMS: [&str; 9] =
    ["numerics", "stages", "files", "settings", "pipeline", "analysis", "report", "experiments", "cli"];

/// The stages in order: each imports only those before it, and `baselines` and `schema` never each other.
const STAGES: [&str; 11] = [
    "tree",
    "agent",
    "simulate",
    "sense",
    "quantise",
    "distance",
    "body_map",
    "mixture",
    "baselines",
    "schema",
    "evaluate",
];

/// Rooms that touch no files and no terminal.
const CORE: [&str; 3] = ["numerics", "stages", "pipeline"];

/// What the core must not name.
const OUTSIDE: [&str; 17] = [
    "anyhow",
    "clap",
    "csv",
    "ctrlc",
    "eprint",
    "humantime",
    "indicatif",
    "maud",
    "npyz",
    "plotters",
    "print",
    "println",
    "serde_json",
    "std::fs",
    "std::io",
    "std::process",
    "toml",
];

/// Longest file, in lines.
const MAX_LINES: usize = 400;

/// The source files by module path, `stages::agent` for `stages/agent.rs` and `stages` for `stages/mod.rs`.
type Sources = BTreeMap<String, Source>;

struct Source {
    text: String,
    is_mod_rs: bool,
}

fn sources() -> Sources {
    let mut sources = Sources::new();
    collect(&Path::new(env!("CARGO_MANIFEST_DIR")).join("src"), "", &mut sources);
    sources
}

fn collect(folder: &Path, within: &str, sources: &mut Sources) {
    for entry in fs::read_dir(folder).unwrap().map(Result::unwrap) {
        let name = entry.file_name().into_string().unwrap();
        let path = |name: &str| if within.is_empty() { name.to_owned() } else { format!("{within}::{name}") };
        if entry.path().is_dir() {
            collect(&entry.path(), &path(&name), sources);
        } else if let Some(stem) = name.strip_suffix(".rs") {
            let is_mod_rs = stem == "mod";
            let module = if is_mod_rs { within.to_owned() } else { path(stem) };
            let text = fs::read_to_string(entry.path()).unwrap();
            sources.insert(module, Source { text, is_mod_rs });
        }
    }
}

/// Code without comments and string literals.
fn code(text: &str) -> String {
    let mut code = String::new();
    for line in text.lines() {
        let (mut in_string, mut escaped, mut before) = (false, false, ' ');
        for (at, character) in line.char_indices() {
            if !in_string && line[at..].starts_with("//") {
                break;
            }
            match character {
                '"' if !escaped && before != '\'' => in_string = !in_string,
                _ if !in_string => code.push(character),
                _ => {}
            }
            escaped = in_string && character == '\\' && !escaped;
            before = character;
        }
        code.push('\n');
    }
    code
}

/// All paths that a file names, from `crate`: those of `use` trees and those in the code.
fn paths(module: &str, text: &str) -> BTreeSet<String> {
    let code = code(text);
    // In an inline module of tests, the first `super` is the file itself.
    let (code, tests) = code.split_once("mod tests {").unwrap_or((&code, ""));
    let from_tests = named(tests).into_iter().filter_map(|path| match path.strip_prefix("super::") {
        Some(rest) => rest.starts_with("super::").then(|| rest.to_owned()),
        None => Some(path),
    });
    named(code).into_iter().chain(from_tests).filter_map(|path| resolve(module, &path)).collect()
}

/// Paths as they are written, the leaves of `use` trees among them.
fn named(code: &str) -> BTreeSet<String> {
    let mut found = BTreeSet::new();
    for statement in code.split("use ").skip(1).filter_map(|rest| rest.split_once(';')).map(|(tree, _)| tree)
    {
        expand(statement.trim(), "", &mut found);
    }
    let word = |character: char| character.is_alphanumeric() || character == '_' || character == ':';
    for path in code.split(|character| !word(character)) {
        if ["crate::", "super::"].iter().any(|start| path.starts_with(start)) && !path.ends_with(':') {
            found.insert(path.to_owned());
        }
    }
    found
}

/// The leaves of a `use` tree.
fn expand(tree: &str, before: &str, found: &mut BTreeSet<String>) {
    match tree.split_once('{') {
        None => {
            let path = tree.split(" as ").next().unwrap().trim();
            found.insert(format!("{before}{path}"));
        }
        Some((head, rest)) => {
            let (mut depth, mut leaf) = (0, String::new());
            for character in rest.strip_suffix('}').unwrap_or(rest).chars().chain([',']) {
                match character {
                    ',' if depth == 0 => {
                        if !leaf.trim().is_empty() {
                            expand(leaf.trim(), &format!("{before}{}", head.trim()), found);
                        }
                        leaf.clear();
                    }
                    other => {
                        depth += i32::from(other == '{') - i32::from(other == '}');
                        leaf.push(other);
                    }
                }
            }
        }
    }
}

/// A path from `crate`; none for other crates.
fn resolve(module: &str, path: &str) -> Option<String> {
    if let Some(rest) = path.strip_prefix("crate::") {
        return Some(rest.to_owned());
    }
    if let Some(rest) = path.strip_prefix("self::") {
        return Some(format!("{module}::{rest}"));
    }
    let mut at: Vec<&str> = module.split("::").collect();
    let mut rest = path;
    while let Some(next) = rest.strip_prefix("super::") {
        at.pop();
        rest = next;
    }
    at.push(rest);
    (rest != path).then(|| at.join("::"))
}

/// The file in which a path ends.
fn file_of<'a>(sources: &'a Sources, path: &str) -> Option<&'a str> {
    let mut at = path;
    loop {
        if let Some((module, _)) = sources.get_key_value(at) {
            return Some(module);
        }
        at = at.rsplit_once("::")?.0;
    }
}

fn position(order: &[&str], name: &str) -> Option<usize> {
    order.iter().position(|known| *known == name)
}

/// What a file may not import, of rooms and stages.
fn upward(module: &str, path: &str) -> Option<String> {
    let part = |path: &str, at: usize| path.split("::").nth(at).unwrap_or_default().to_owned();
    let (from, to) = (part(module, 0), part(path, 0));
    let (Some(own), Some(other)) = (position(&ROOMS, &from), position(&ROOMS, &to)) else { return None };
    if other > own {
        return Some(format!("{module} imports {path}, but {to} is above {from}"));
    }
    if from == "stages" && to == "stages" {
        let (from, to) = (part(module, 1), part(path, 1));
        if let (Some(own), Some(other)) = (position(&STAGES, &from), position(&STAGES, &to)) {
            let rivals = (from.as_str(), to.as_str()) == ("schema", "baselines");
            if other > own || rivals {
                return Some(format!("{module} imports {path}, but stage {to} does not come before {from}"));
            }
        }
    }
    None
}

/// Every breach of a rule.
fn breaches(sources: &Sources) -> Vec<String> {
    let mut breaches = Vec::new();
    let mut imports: BTreeMap<&str, BTreeSet<&str>> = BTreeMap::new();
    for (module, source) in sources {
        let room = module.split("::").next().unwrap();
        if !["lib", "main"].contains(&room) && position(&ROOMS, room).is_none() {
            breaches.push(format!("{module} is in no room"));
        }
        if source.text.lines().count() > MAX_LINES {
            breaches.push(format!("{module} is longer than {MAX_LINES} lines"));
        }
        let code = code(&source.text);
        if CORE.contains(&room) {
            for word in OUTSIDE.iter().filter(|word| names(&code, word)) {
                breaches.push(format!("{module} names {word}, which the core must not"));
            }
        }
        if names(&code, "ode_sys") && module != "stages::simulate::world" {
            breaches.push(format!("{module} names ode_sys, which one file wraps"));
        }
        if source.is_mod_rs {
            breaches.extend(mod_rs(module, &code));
            continue;
        }
        for path in paths(module, &source.text) {
            if room != "lib" && room != "main" {
                breaches.extend(upward(module, &path));
            }
            let Some(file) = file_of(sources, &path) else { continue };
            if sources[file].is_mod_rs && is_within(module, file) {
                breaches.push(format!("{module} imports {path}, from the mod.rs of a folder that it is in"));
            }
            if file != module && !is_within(module, file) {
                imports.entry(module).or_default().insert(file);
            }
        }
    }
    breaches.extend(circles(sources, &imports));
    breaches
}

/// A `mod.rs` only lists its files and what they show: it defines nothing.
fn mod_rs(module: &str, code: &str) -> Vec<String> {
    let defines =
        ["fn ", "struct ", "enum ", "trait ", "const ", "static ", "impl ", "type ", "macro_rules!"];
    let line = |line: &&str| defines.iter().any(|word| line.trim_start_matches("pub ").starts_with(word));
    code.lines().filter(line).map(|line| format!("{module} (mod.rs) defines `{}`", line.trim())).collect()
}

/// Whether a module is in the folder of another.
fn is_within(module: &str, folder: &str) -> bool {
    module.strip_prefix(folder).is_some_and(|rest| rest.starts_with("::"))
}

/// Whether code names a crate, module, function or macro.
fn names(code: &str, word: &str) -> bool {
    let part = |character: char| character.is_alphanumeric() || character == '_';
    code.match_indices(word).any(|(at, _)| {
        let before = code[..at].chars().next_back();
        let after = code[at + word.len()..].chars().next();
        let macro_of_ours = word.starts_with("print") || word == "eprint";
        !before.is_some_and(part)
            && !after.is_some_and(part)
            && (!macro_of_ours || after == Some('!'))
            && (macro_of_ours || word.contains("::") || after == Some(':') || before_is_use(code, at))
    })
}

fn before_is_use(code: &str, at: usize) -> bool {
    code[..at].trim_end().ends_with("use")
}

/// Files that import each other in a circle: each is named with one that leads back to it.
fn circles(sources: &Sources, imports: &BTreeMap<&str, BTreeSet<&str>>) -> Vec<String> {
    // What a `mod.rs` shows is found in its folder: it stands for all its files.
    let mut edges = imports.clone();
    for (module, _) in sources.iter().filter(|(_, source)| source.is_mod_rs) {
        let files = sources.keys().filter(|file| is_within(file, module)).map(String::as_str);
        edges.entry(module).or_default().extend(files);
    }
    let reaches = |from: &str| {
        let mut reached = BTreeSet::new();
        let mut next: Vec<&str> = edges.get(from).into_iter().flatten().copied().collect();
        while let Some(file) = next.pop() {
            if reached.insert(file) {
                next.extend(edges.get(file).into_iter().flatten());
            }
        }
        reached
    };
    let reached: BTreeMap<&str, BTreeSet<&str>> = imports.keys().map(|file| (*file, reaches(file))).collect();
    let back = |file: &str| reached[file].contains(file);
    imports.keys().filter(|file| back(file)).map(|file| format!("{file} is in a circle of imports")).collect()
}

#[test]
fn every_file_keeps_the_rules() {
    let found = breaches(&sources());
    assert!(found.is_empty(), "{} breaches:\n{}", found.len(), found.join("\n"));
}

#[test]
fn the_rooms_and_stages_are_those_that_are_there() {
    let sources = sources();
    let folders: BTreeSet<&str> = sources.keys().map(|module| module.split("::").next().unwrap()).collect();
    let rooms: BTreeSet<&str> = ROOMS.into_iter().chain(["lib", "main"]).collect();
    assert_eq!(folders, rooms);
    let second = |module: &str| {
        module.strip_prefix("stages::").map(|rest| rest.split("::").next().unwrap().to_owned())
    };
    let stages: BTreeSet<String> = sources.keys().filter_map(|module| second(module)).collect();
    assert_eq!(stages, STAGES.map(str::to_owned).into());
}

/// A house with one more file, or another text in a file.
fn with(module: &str, text: &str) -> Vec<String> {
    let mut sources = sources();
    let is_mod_rs = sources.get(module).is_some_and(|source| source.is_mod_rs);
    sources.insert(module.to_owned(), Source { text: text.to_owned(), is_mod_rs });
    breaches(&sources)
}

#[test]
fn every_rule_finds_the_file_that_breaks_it() {
    for (module, text, expected) in [
        ("stages::agent", "use crate::settings::Settings;", "settings is above stages"),
        ("stages::sense", "fn f() { crate::report::page::write(); }", "report is above stages"),
        (
            "numerics::rng",
            "use crate::{\n    stages::{\n        tree::Edge,\n    },\n};",
            "stages is above numerics",
        ),
        (
            "stages::quantise",
            "use crate::stages::schema::Draw;",
            "stage schema does not come before quantise",
        ),
        (
            "stages::schema::gibbs",
            "use crate::stages::baselines::gmm;",
            "stage baselines does not come before schema",
        ),
        (
            "stages::baselines::gmm",
            "use super::super::schema::Draw;",
            "stage schema does not come before baselines",
        ),
        ("stages::schema::gibbs", "use crate::stages::schema::Draw;", "from the mod.rs of a folder"),
        ("files::npy", "use super::FileError;", "from the mod.rs of a folder"),
        ("files::npy", "mod tests {\n    use super::super::sha256;\n}", "from the mod.rs of a folder"),
        ("files::error", "use super::whole::write_text;", "files::error is in a circle of imports"),
        ("numerics::range", "use super::partition::sizes;\n", ""),
        ("stages::tree", "fn f() { println!(\"x\"); }", "names println, which the core must not"),
        ("pipeline", "use std::fs::File;", "names std::fs, which the core must not"),
        ("stages::sense", "use indicatif::ProgressBar;", "names indicatif, which the core must not"),
        ("pipeline", "fn f() -> anyhow::Result<()> { Ok(()) }", "names anyhow, which the core must not"),
        ("numerics::simd", "use ode_sys as ode;", "names ode_sys, which one file wraps"),
        ("files", "pub mod npy;\npub fn f() {}", "(mod.rs) defines"),
        ("attic", "", "attic is in no room"),
        ("report::page", &"\n".repeat(MAX_LINES + 1), "longer than 400 lines"),
    ] {
        let found = with(module, text);
        if expected.is_empty() {
            assert!(found.iter().all(|breach| !breach.contains(module)), "{module}: {found:?}");
        } else {
            let breach = |breach: &String| breach.contains(expected);
            assert!(found.iter().any(breach), "{module} with {text:?}: {found:?} lacks {expected:?}");
        }
    }
    // Words in comments and texts are no imports.
    let quiet = with("stages::tree", "//! use crate::report::page;\nconst A: &str = \"toml::x std::fs\";");
    assert!(quiet.iter().all(|breach| !breach.contains("stages::tree")), "{quiet:?}");
}
