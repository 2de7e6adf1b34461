//! Word what a body has in another way than its description.

use crate::stages::tree::Truth;

/// How many names there are, and the first of them; `None` if there is none.
pub(crate) fn names<'a>(names: impl Iterator<Item = &'a str>) -> Option<String> {
    const MOST: usize = 6;
    let names: Vec<&str> = names.collect();
    let more = if names.len() > MOST { ", …" } else { "" };
    let first = names[..names.len().min(MOST)].join(", ");
    (!names.is_empty()).then(|| format!("({}): {first}{more}", names.len()))
}

/// Says which parts turn about one place, if several do. Those without names are numbers.
pub(crate) fn at_one_place(truth: &Truth, part_names: Option<&[String]>) -> Option<String> {
    let name =
        |part: usize| part_names.and_then(|names| names.get(part).cloned()).unwrap_or(part.to_string());
    let parts: Vec<String> = truth.at_one_place().into_iter().map(name).collect();
    let names = names(parts.iter().map(String::as_str))?;
    Some(format!(
        "several parts turn about one place, where touch cannot tell which of them carries which {names}"
    ))
}

/// Says that a mesh is not there.
pub(super) fn absent(file: &str) -> String {
    format!("mesh `{file}` is not there")
}
