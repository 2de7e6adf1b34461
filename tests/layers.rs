//! The rules of the house, read from the `use` lines and paths of `src`: rooms import only rooms below them, files never
//! import each other in a circle or the `mod.rs` of their folder, and the core knows no files, terminal or plots.
//!
//! There is no list of exceptions. Each rule is shown to find a file that breaks it.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

/// The rooms from the ground up: each imports only those before it.
const ROOMS: [&str; 13] = [
    "numerics",
    "stages",
    "files",
    "settings",
    "pipeline",
    "recording",
    "estimate",
    "analysis",
    "report",
    "tasks",
    "experiments",
    "study",
    "cli",
];

/// The stages in order: each imports only those before it, and `baselines` and `schema` never each other.
const STAGES: [&str; 15] = [
    "tree",
    "agent",
    "simulate",
    "sense",
    "usable",
    "noise",
    "quantise",
    "distance",
    "rigid_parts",
    "joints",
    "body_map",
    "mixture",
    "baselines",
    "schema",
    "evaluate",
];

/// Rooms that touch no files and no terminal.
const CORE: [&str; 5] = ["numerics", "stages", "pipeline", "recording", "estimate"];

/// What the core must not name.
const OUTSIDE: [&str; 14] = [
    "anyhow",
    "clap",
    "csv",
    "ctrlc",
    "humantime",
    "indicatif",
    "maud",
    "npyz",
    "plotters",
    "serde_json",
    "std::fs",
    "std::io",
    "std::process",
    "toml",
];

/// Macros that print.
const PRINTING: [&str; 5] = ["print!", "println!", "eprint!", "eprintln!", "dbg!"];

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

/// Code without comments and the contents of literals; lines stay lines.
fn code(text: &str) -> String {
    let mut code = String::new();
    let mut rest = text;
    while let Some(next) = rest.chars().next() {
        let skipped = literal_or_comment(rest);
        if skipped > 0 {
            code.extend(rest[..skipped].chars().filter(|character| *character == '\n'));
            rest = &rest[skipped..];
        } else {
            code.push(next);
            rest = &rest[next.len_utf8()..];
        }
    }
    code
}

/// Length of the comment, string or character with which a text begins; 0 if it begins with none.
fn literal_or_comment(text: &str) -> usize {
    let through =
        |from: usize, end: &str| text[from..].find(end).map_or(text.len(), |at| from + at + end.len());
    let hashes = text.strip_prefix('r').map_or(0, |rest| rest.len() - rest.trim_start_matches('#').len());
    if text.starts_with("//") {
        text.find('\n').unwrap_or(text.len())
    } else if text.starts_with("/*") {
        through(2, "*/")
    } else if text.starts_with('r') && text[1 + hashes..].starts_with('"') {
        through(2 + hashes, &format!("\"{}", "#".repeat(hashes)))
    } else if text.starts_with('"') {
        let mut escaped = false;
        let end = text.char_indices().skip(1).find(|(_, character)| {
            let ends = *character == '"' && !escaped;
            escaped = *character == '\\' && !escaped;
            ends
        });
        end.map_or(text.len(), |(at, _)| at + 1)
    } else if text.starts_with("'\\") {
        through(3, "'")
    } else if text.starts_with('\'') {
        // A character, not a lifetime.
        let end = text.char_indices().nth(2);
        end.filter(|(_, character)| *character == '\'').map_or(0, |(at, _)| at + 1)
    } else {
        0
    }
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
    if path == "crate" {
        return Some("*".to_owned());
    }
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
        let in_crate_root = ["lib", "main"].contains(&room);
        if !in_crate_root && position(&ROOMS, room).is_none() {
            breaches.push(format!("{module} is in no room"));
        }
        if source.text.lines().count() > MAX_LINES {
            breaches.push(format!("{module} is longer than {MAX_LINES} lines"));
        }
        let code = code(&source.text);
        if CORE.contains(&room) {
            breaches.extend(outside(module, &code));
        }
        if names(&code, "ode_sys") && !module.starts_with("stages::simulate::world") {
            breaches.push(format!("{module} names ode_sys, which one module wraps"));
        }
        breaches.extend(inline_modules(module, &code, in_crate_root));
        if source.is_mod_rs {
            breaches.extend(mod_rs(module, &code));
        }
        for path in paths(module, &source.text) {
            let first = path.split("::").next().unwrap();
            if !in_crate_root {
                breaches.extend(upward(module, &path));
                if position(&ROOMS, first).is_none() {
                    breaches.push(format!("{module} imports {path}, which is in no room"));
                }
            }
            let Some(file) = file_of(sources, &path) else { continue };
            // A `mod.rs` shows its own files.
            if source.is_mod_rs {
                continue;
            }
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

/// What the core names and must not.
fn outside(module: &str, code: &str) -> Vec<String> {
    let mut found: BTreeSet<&str> = PRINTING.into_iter().filter(|word| names(code, word)).collect();
    for path in named(code) {
        let starts = |word: &str| path == word || path.starts_with(&format!("{word}::"));
        found.extend(OUTSIDE.into_iter().filter(|word| starts(word)));
    }
    found.extend(OUTSIDE.into_iter().filter(|word| names(code, &format!("{word}::"))));
    found.into_iter().map(|word| format!("{module} names {word}, which the core must not")).collect()
}

/// Modules within a file, but for tests at its end: their paths would need another reading. The crate's root has one.
fn inline_modules(module: &str, code: &str, in_crate_root: bool) -> Option<String> {
    let opens = |line: &&str| {
        line.trim_start().split("mod ").nth(1).is_some_and(|rest| rest.trim_end().ends_with('{'))
    };
    let modules: Vec<&str> = code.lines().filter(opens).map(str::trim).collect();
    let allowed = in_crate_root || modules.is_empty() || modules == ["mod tests {"];
    (!allowed).then(|| format!("{module} has inline modules: {}", modules.join(", ")))
}

/// A `mod.rs` only lists its files and what they show: it defines nothing.
fn mod_rs(module: &str, code: &str) -> Vec<String> {
    let mut breaches = Vec::new();
    let mut in_use = false;
    for line in code.lines().map(str::trim).filter(|line| !line.is_empty()) {
        let lists = ["mod ", "pub mod ", "pub(crate) mod ", "use ", "pub use ", "pub(crate) use ", "#["];
        in_use |= line.contains("use ");
        if !in_use && !lists.iter().any(|start| line.starts_with(start)) {
            breaches.push(format!("{module} (mod.rs) defines `{line}`"));
        }
        in_use &= !line.ends_with(';');
    }
    breaches
}

/// Whether a module is in the folder of another.
fn is_within(module: &str, folder: &str) -> bool {
    module.strip_prefix(folder).is_some_and(|rest| rest.starts_with("::"))
}

/// Whether code has a word, and not as a piece of a longer one.
fn names(code: &str, word: &str) -> bool {
    let part = |character: char| character.is_alphanumeric() || character == '_';
    code.match_indices(word).any(|(at, _)| {
        let before = code[..at].chars().next_back();
        let after = code[at + word.len()..].chars().next();
        !before.is_some_and(part) && (word.ends_with(['!', ':']) || !after.is_some_and(part))
    })
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
            "use crate::stages::schema::Sample;",
            "stage schema does not come before quantise",
        ),
        (
            "stages::schema::gibbs",
            "use crate::stages::baselines::gmm;",
            "stage baselines does not come before schema",
        ),
        (
            "stages::baselines::gmm",
            "use super::super::schema::Sample;",
            "stage schema does not come before baselines",
        ),
        ("stages::schema::gibbs", "use crate::stages::schema::Sample;", "from the mod.rs of a folder"),
        ("files::npy", "use super::FileError;", "from the mod.rs of a folder"),
        ("files::npy", "mod tests {\n    use super::super::sha256;\n}", "from the mod.rs of a folder"),
        ("files::error", "use super::whole::write_text;", "files::error is in a circle of imports"),
        ("numerics::range", "use super::partition::sizes;\n", ""),
        ("stages::tree", "fn f() { println!(\"x\"); }", "names println!, which the core must not"),
        ("pipeline", "use std::fs::File;", "names std::fs, which the core must not"),
        ("stages::sense", "use indicatif::ProgressBar;", "names indicatif, which the core must not"),
        ("pipeline", "fn f() -> anyhow::Result<()> { Ok(()) }", "names anyhow, which the core must not"),
        ("numerics::simd", "use ode_sys as ode;", "names ode_sys, which one module wraps"),
        ("files", "pub mod npy;\npub fn f() {}", "(mod.rs) defines"),
        ("attic", "", "attic is in no room"),
        ("files", "pub use crate::report::page;", "report is above files"),
        ("files", "pub(crate) struct S;", "(mod.rs) defines"),
        ("stages::tree", "fn f() { eprintln!(\"x\"); }", "names eprintln!, which the core must not"),
        ("stages::tree", "use std::{fs, io};", "names std::fs, which the core must not"),
        ("stages::tree", "use {csv, toml};", "names csv, which the core must not"),
        ("stages::tree", "use crate::*;", "which is in no room"),
        ("stages::tree", "use crate as c;", "which is in no room"),
        ("stages::tree", "mod inner {\n    use super::x;\n}", "has inline modules"),
        ("stages::tree", "const A: &str = \"'\";\nuse crate::report::page;", "report is above stages"),
        ("stages::tree", "const A: &str = r#\"\"\"#;\nuse crate::report::page;", "report is above stages"),
        ("stages::tree", "const A: &str = \"a \\\n b\"; use crate::report::page;", "report is above stages"),
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
