//! Word what a body has in another way than its description.

/// How many names there are, and the first of them; `None` if there is none.
pub(crate) fn names<'a>(names: impl Iterator<Item = &'a str>) -> Option<String> {
    const MOST: usize = 6;
    let names: Vec<&str> = names.collect();
    let more = if names.len() > MOST { ", …" } else { "" };
    let first = names[..names.len().min(MOST)].join(", ");
    (!names.is_empty()).then(|| format!("({}): {first}{more}", names.len()))
}

/// Says that a mesh is not there.
pub(super) fn absent(file: &str) -> String {
    format!("mesh `{file}` is not there")
}
