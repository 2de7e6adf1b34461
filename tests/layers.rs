//! The rules of the house, read from the names in the files of `src`: rooms import only rooms below them, files never import
//! each other in a circle or the `mod.rs` of their folder, and the core knows no files, terminal or plots. Without exceptions.
//! Each rule is shown to find a file that breaks it.

use petgraph::{algo::tarjan_scc, graphmap::DiGraphMap};
use syn::{Item, ItemMod};

use crate::support::names::{Sources, is_in, sources, with};

/// The rooms from the ground up: each imports only those before it.
const ROOMS: [&str; 14] = [
    "numerics",
    "stages",
    "files",
    "settings",
    "movement",
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
const STAGES: [&str; 18] = [
    "tree",
    "agent",
    "simulate",
    "sense",
    "clock",
    "usable",
    "noise",
    "quantise",
    "distance",
    "parameters",
    "rigid_parts",
    "joints",
    "placement",
    "body_map",
    "mixture",
    "baselines",
    "schema",
    "evaluate",
];

/// Rooms that touch no files and no terminal, and what they must not name.
const CORE: [&str; 5] = ["numerics", "stages", "pipeline", "recording", "estimate"];
const OUTSIDE: &str = "anyhow clap csv ctrlc humantime indicatif maud npyz plotters serde_json std::fs std::io \
                       std::process toml print! println! eprint! eprintln! dbg!";

/// Longest file, in lines.
const MAX_LINES: usize = 400;

/// How far up a path of the crate is: its room, and its stage, above all of which is their `mod.rs`; none in no room.
fn height(path: &str) -> Option<(usize, usize)> {
    let mut names = path.split("::").skip(1);
    let place = |order: &[&str], name: &str| order.iter().position(|known| *known == name);
    let room = place(&ROOMS, names.next()?)?;
    let stage = names.next().filter(|_| ROOMS[room] == "stages").and_then(|name| place(&STAGES, name));
    Some((room, stage.unwrap_or(STAGES.len())))
}

/// Every breach of a rule.
fn breaches(sources: &Sources) -> Vec<String> {
    let mut found = Vec::new();
    let mut imports = DiGraphMap::<&str, (), std::hash::RandomState>::default();
    for (module, source) in sources {
        let mut forbid = |broken: bool, what: &str| found.extend(broken.then(|| format!("{module} {what}")));
        let room = module.split("::").nth(1).unwrap();
        let is_root = ["lib", "main"].contains(&room);
        let lists = |item: &Item| matches!(item, Item::Use(_) | Item::Mod(ItemMod { content: None, .. }));
        let inline = |item: &Item| matches!(item, Item::Mod(inner) if !lists(item) && inner.ident != "tests");
        forbid(!is_root && height(module).is_none(), "is in no room");
        forbid(source.lines > MAX_LINES, "is too long");
        forbid(source.is_mod_rs && !source.items.iter().all(lists), "is a mod.rs and defines something");
        forbid(!is_root && source.items.iter().any(inline), "has an inline module");
        // A `mod.rs` stands for all files of its folder, which it shows.
        let shown = sources.keys().filter(|file| source.is_mod_rs && *file != module && is_in(file, module));
        imports.extend(shown.map(|file| (&**module, &**file)));
        for path in &source.names {
            let is = |module: &str| is_in(path, module);
            let rivals = is_in(module, "crate::stages::schema") && is("crate::stages::baselines");
            let below = !rivals && height(path).is_some_and(|other| Some(other) <= height(module));
            // The file that the path leads to, whose module sorts last of those that it is in.
            let file = sources.keys().rev().find(|file| !source.is_mod_rs && is(file));
            let is_shown = file.is_some_and(|file| sources[file].is_mod_rs && is_in(module, file));
            let mut forbid = |broken: bool, what: &str| forbid(broken, &format!("names {path}, {what}"));
            forbid(!is_root && is("crate") && !below, "which is not below it");
            forbid(CORE.contains(&room) && OUTSIDE.split_whitespace().any(is), "which the core must not");
            forbid(is("ode_sys") && !is_in(module, "crate::stages::simulate::world"), "which world wraps");
            forbid(is_shown, "from a mod.rs above it");
            imports.extend(file.filter(|file| !is_in(module, file)).map(|file| (&**module, &**file)));
        }
    }
    let circles = tarjan_scc(&imports).into_iter().filter(|files| files.len() > 1);
    found.extend(circles.map(|files| format!("{} are in a circle of imports", files.join(", "))));
    found
}

#[test]
fn every_file_keeps_the_rules() {
    assert_eq!(breaches(&sources()), [""; 0]);
}

#[test]
fn the_rooms_and_stages_are_those_that_are_there() {
    let sources = sources();
    let within = |folder| {
        let inner = sources.keys().filter_map(move |module: &String| module.strip_prefix(folder));
        inner.map(|module| module.split("::").next().unwrap()).collect::<std::collections::BTreeSet<_>>()
    };
    assert_eq!(within("crate::"), ROOMS.into_iter().chain(["lib", "main"]).collect());
    assert_eq!(within("crate::stages::"), STAGES.into());
}

#[test]
fn every_rule_finds_the_file_that_breaks_it() {
    let sources = sources();
    for (module, text, expected) in [
        ("stages::sense", "fn f() { crate::report::page::write(); }", "is not below it"),
        ("stages::sense", "fn f() { g!(\"a\", [crate::report::X]); }", "is not below it"),
        ("numerics::rng", "use crate::{stages::{tree::Edge}};", "names crate::stages::tree::Edge, which"),
        ("files", "pub use crate::report::page;", "is not below it"),
        ("stages::baselines::gmm", "use super::super::schema::Sample;", "is not below it"),
        ("stages::schema::gibbs", "use crate::stages::baselines::gmm;", "is not below it"),
        ("stages::tree", "use crate::*;", "is not below it"),
        ("stages::tree", "use crate as c;", "is not below it"),
        ("stages::schema::gibbs", "use crate::stages::schema::Sample;", "from a mod.rs above it"),
        ("files::npy", "mod tests { use super::super::sha256; }", "from a mod.rs above it"),
        ("files::error", "use super::whole::write_text;", "are in a circle of imports"),
        ("stages::tree", "fn f() { vec![{ eprintln!() }]; }", "names eprintln!, which the core must not"),
        ("stages::tree", "use {csv, std::{fs, io}};", "names std::fs, which the core must not"),
        ("pipeline", "type R = anyhow::Result<()>;", "names anyhow::Result, which the core must not"),
        ("numerics::simd", "use ode_sys as ode;", "names ode_sys, which world wraps"),
        ("files", "pub(crate) struct S;", "is a mod.rs and defines something"),
        ("attic", "", "is in no room"),
        ("stages::tree", "mod inner {}", "has an inline module"),
        ("report::page", &"\n".repeat(MAX_LINES + 1), "is too long"),
        // No breaches: files side by side, words in comments and texts, and what tests stand in.
        ("numerics::range", "use super::partition::sizes;", ""),
        ("stages::tree", "//! use crate::report::page;\nmod tests { use super::*; g!(\"std::fs\"); }", ""),
    ] {
        let found = breaches(&with(&sources, &format!("crate::{module}"), text));
        let is_found = found.iter().any(|breach| breach.contains(expected));
        assert_eq!(is_found, !expected.is_empty(), "{module} with {text:?}: {found:?}");
    }
}
