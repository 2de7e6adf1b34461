//! The source files of the crate, and what each names: the paths in its code, in what its macros are given, and at the
//! leaves of its `use` trees.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::rc::Rc;
use std::{fs, mem};

use proc_macro2::{TokenStream, TokenTree};
use syn::visit::{self, Visit};
use syn::{Item, ItemMod, ItemUse, Macro, MetaList, UseTree};
use walkdir::WalkDir;

pub struct Source {
    pub is_mod_rs: bool,
    pub lines: usize,
    pub items: Vec<Item>,
    /// The paths that it names, from `crate` on where they are of the crate; macros as `name!`.
    pub names: BTreeSet<String>,
}

impl Source {
    pub fn new(module: &str, is_mod_rs: bool, text: &str) -> Rc<Self> {
        let file = syn::parse_file(text).unwrap_or_else(|error| panic!("{module}: {error}"));
        let mut names = Names { module: module.to_owned(), paths: BTreeSet::new() };
        names.visit_file(&file);
        Rc::new(Self { is_mod_rs, lines: text.lines().count(), items: file.items, names: names.paths })
    }
}

/// Source files by module: `crate::stages::agent` for `stages/agent.rs`.
pub type Sources = BTreeMap<String, Rc<Source>>;

pub fn sources() -> Sources {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let paths = WalkDir::new(&root).into_iter().map(|entry| entry.unwrap().into_path());
    let files = paths.filter(|path| path.extension().is_some_and(|extension| extension == "rs"));
    let source = |path: PathBuf| {
        let file = path.strip_prefix(&root).unwrap().with_extension("").display().to_string();
        let (module, is_mod_rs) = file.strip_suffix("/mod").map_or((&*file, false), |folder| (folder, true));
        let module = format!("crate::{}", module.replace('/', "::"));
        let source = Source::new(&module, is_mod_rs, &fs::read_to_string(path).unwrap());
        (module, source)
    };
    files.map(source).collect()
}

/// The sources with another text of one of them, or with one more.
pub fn with(sources: &Sources, module: &str, text: &str) -> Sources {
    let mut sources = sources.clone();
    let is_mod_rs = sources.get(module).is_some_and(|source| source.is_mod_rs);
    sources.insert(module.to_owned(), Source::new(module, is_mod_rs, text));
    sources
}

/// Whether a path is that of a module, or of something in it.
pub fn is_in(path: &str, module: &str) -> bool {
    path.strip_prefix(module).is_some_and(|rest| rest.is_empty() || rest.starts_with("::"))
}

struct Names {
    /// Where the code stands that is being read.
    module: String,
    paths: BTreeSet<String>,
}

impl Names {
    /// Adds a path as it is written.
    fn add(&mut self, path: &str) {
        // As in `use a::{self, b}`.
        let path = path.strip_suffix("::self").unwrap_or(path);
        let (mut at, mut rest) = (self.module.as_str(), path.strip_prefix("self::").unwrap_or(path));
        while let Some(inner) = rest.strip_prefix("super::") {
            at = at.rsplit_once("::").map_or("crate", |(outer, _)| outer);
            rest = inner;
        }
        self.paths.insert(if rest == path { path.to_owned() } else { format!("{at}::{rest}") });
    }

    fn add_leaves(&mut self, tree: &UseTree, before: &str) {
        match tree {
            UseTree::Path(path) => self.add_leaves(&path.tree, &format!("{before}{}::", path.ident)),
            UseTree::Group(group) => group.items.iter().for_each(|tree| self.add_leaves(tree, before)),
            UseTree::Name(name) => self.add(&format!("{before}{}", name.ident)),
            UseTree::Rename(renamed) => self.add(&format!("{before}{}", renamed.ident)),
            _ => self.add(&format!("{before}*")),
        }
    }

    /// Adds the paths among tokens that are no code until a macro has read them.
    fn add_tokens(&mut self, tokens: &TokenStream) {
        for word in words(tokens.clone()).split_whitespace() {
            let word = word.trim_matches(':');
            if word.contains("::") || word.ends_with('!') {
                self.add(word);
            }
        }
    }
}

/// Tokens without literals and other marks, with no space within a path.
fn words(tokens: TokenStream) -> String {
    tokens.into_iter().fold(String::new(), |text, token| match token {
        TokenTree::Ident(name) if text.ends_with("::") => format!("{text}{name}"),
        TokenTree::Ident(name) => format!("{text} {name}"),
        TokenTree::Punct(mark) if [':', '!'].contains(&mark.as_char()) => format!("{text}{mark}"),
        TokenTree::Group(group) => format!("{text} {} ", words(group.stream())),
        _ => text + " ",
    })
}

impl<'a> Visit<'a> for Names {
    fn visit_path(&mut self, path: &'a syn::Path) {
        let names: Vec<String> = path.segments.iter().map(|segment| segment.ident.to_string()).collect();
        if names.len() > 1 {
            self.add(&names.join("::"));
        }
        visit::visit_path(self, path);
    }

    fn visit_macro(&mut self, called: &'a Macro) {
        self.paths.extend(called.path.segments.last().map(|name| format!("{}!", name.ident)));
        self.add_tokens(&called.tokens);
        visit::visit_macro(self, called);
    }

    fn visit_meta_list(&mut self, attribute: &'a MetaList) {
        self.add_tokens(&attribute.tokens);
    }

    fn visit_item_use(&mut self, item: &'a ItemUse) {
        self.add_leaves(&item.tree, "");
    }

    fn visit_item_mod(&mut self, item: &'a ItemMod) {
        if item.content.is_some() {
            let within = format!("{}::{}", self.module, item.ident);
            let outside = mem::replace(&mut self.module, within);
            visit::visit_item_mod(self, item);
            self.module = outside;
        }
    }
}
