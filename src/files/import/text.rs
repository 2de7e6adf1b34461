//! Read the text of a description, with the files that it includes and with what it replicates written out.
//!
//! Where text of another file begins or ends, a processing instruction names the file and its line, for messages.

use std::ops::Range;
use std::path::{Path, PathBuf};

use roxmltree::{Document, Node};

use super::document::{Wrong, origin, parse, parsed};
use super::located::Located;
use super::xml::Element;

/// Most bytes of a description with all that it includes, and most copies that an element may be replicated into.
const MOST_BYTES: usize = 64 << 20;
const MOST_COPIES: usize = 1024;
/// Most prefixes of names that a file may use without declaring them.
const MOST_PREFIXES: usize = 16;
/// Attribute of `attach` in the text that is written out: what the names get at their end, if the element is replicated.
pub(super) const SUFFIX: &str = "suffix";

/// The text of a description, written out.
///
/// # Errors
/// If a file cannot be read or is no XML, or if files include each other in a loop.
pub(super) fn written_out(path: &Path, files: &Located) -> Result<String, Wrong> {
    included(path.canonicalize().unwrap_or_else(|_| path.to_owned()), files, &[])
}

/// The text of a model that another one attaches, written out. It says of itself which file it is.
///
/// # Errors
/// As [`written_out`], or if it is no MJCF.
pub(super) fn attached_text(path: &Path, files: &Located) -> Result<String, Wrong> {
    let text = included(path.to_owned(), files, &[])?;
    let document = parsed(&text)?;
    let root = document.root_element();
    if !root.has_tag_name("mujoco") {
        let tag = root.tag_name().name();
        return Err(format!("its root is <{tag}>, but what is attached must be <mujoco>"));
    }
    let start = inside(root)?.start;
    let line = document.text_pos_at(start).row;
    Ok(format!("{}{}{}", &text[..start], origin(path, line), &text[start..]))
}

/// The text of a file: UTF-8, or Latin-1 as old descriptions have it. What comes before an XML declaration is left out.
fn read(path: &Path) -> Result<String, Wrong> {
    let bytes = std::fs::read(path).map_err(|error| format!("cannot be read: {error}"))?;
    if bytes.len() > MOST_BYTES {
        return Err(format!("has {} bytes, but at most {MOST_BYTES} are read", bytes.len()));
    }
    let text = match String::from_utf8(bytes) {
        Ok(text) => text,
        Err(error) => error.into_bytes().into_iter().map(char::from).collect(),
    };
    let text = text.trim_start_matches('\u{feff}');
    let is_before = |before: &str| before.trim_start().is_empty() || before.trim_start().starts_with("<!--");
    let text = match text.split_once("<?xml ") {
        // Lines stay what they are.
        Some((before, rest)) if !before.is_empty() && is_before(before) => {
            let declared = rest.split_once("?>").map_or(rest, |(_, after)| after);
            format!("{before}{declared}")
        }
        _ => text.to_owned(),
    };
    Ok(with_known_prefixes(text))
}

/// A text in which names have no prefix that the file does not declare: `a:b` becomes `a.b`, which nothing reads.
fn with_known_prefixes(mut text: String) -> String {
    for _ in 0..MOST_PREFIXES {
        let Err(roxmltree::Error::UnknownNamespace(prefix, _)) = parse(&text) else { break };
        for begins in ["<", "</", " ", "\t", "\n"] {
            text = text.replace(&format!("{begins}{prefix}:"), &format!("{begins}{prefix}."));
        }
    }
    text
}

/// A file whose text is written out, and those that include it.
struct Source<'f> {
    files: &'f Located,
    path: PathBuf,
    around: Vec<PathBuf>,
}

/// The text of a file with all that it includes; `around` are the files that include it.
fn included(path: PathBuf, files: &Located, around: &[PathBuf]) -> Result<String, Wrong> {
    let text = read(&path)?;
    let document = parsed(&text)?;
    let root = document.root_element();
    if !["mujoco", "mujocoinclude"].contains(&root.tag_name().name()) {
        return Ok(text);
    }
    let around = around.iter().cloned().chain([path.clone()]).collect();
    let inner = Source { files, path, around }.inside(root, &text)?;
    let Range { start, end } = inside(root)?;
    Ok(format!("{}{inner}{}", &text[..start], &text[end..]))
}

/// Where the content of an element is in the text.
fn inside(node: Node) -> Result<Range<usize>, Wrong> {
    let Range { start, end } = node.range();
    let range = node.first_child().zip(node.last_child());
    let range = range.map_or(end..end, |(first, last)| first.range().start..last.range().end);
    // What stands for an entity is where the entity is declared.
    if start <= range.start && range.start <= range.end && range.end <= end {
        Ok(range)
    } else {
        Err(Element::new(node.tag_name().name(), node)
            .wrong("contains entities that stand for elements; write them out"))
    }
}

impl Source<'_> {
    /// The content of an element of the file, written out.
    fn inside(&self, node: Node, text: &str) -> Result<String, Wrong> {
        let range = inside(node)?;
        let (mut whole, mut from) = (String::new(), range.start);
        let stands_for_more = |node: &Node| ["include", "replicate"].contains(&node.tag_name().name());
        for node in node.descendants().skip(1).filter(stands_for_more) {
            let Range { start, end } = node.range();
            // Those within another one are written out with it.
            if start < from {
                continue;
            }
            whole.push_str(&text[from..start]);
            whole.push_str(&if node.has_tag_name("include") {
                self.include(node)?
            } else {
                self.replicate(node, text)?
            });
            let line = node.document().text_pos_at(end).row;
            whole.push_str(&origin(&self.path, line));
            if whole.len() > MOST_BYTES {
                return Err(format!(
                    "stands for more than {MOST_BYTES} bytes, with what it includes and replicates"
                ));
            }
            from = end;
        }
        whole.push_str(&text[from.min(range.end)..range.end]);
        Ok(whole)
    }

    fn include(&self, node: Node) -> Result<String, Wrong> {
        let element = Element::new("include", node);
        let name = element.needed("file")?;
        let found = self.files.find("", name).map_err(|wrong| element.wrong(wrong))?;
        let path = found.ok_or_else(|| element.wrong(format!("names `{name}`, which is not there")))?;
        if self.around.contains(&path) {
            return Err(element
                .wrong(format!("names `{name}`, which includes this file in turn; remove one of them")));
        }
        let text =
            included(path.clone(), self.files, &self.around).map_err(|wrong| format!("{name}: {wrong}"))?;
        let document = parsed(&text).map_err(|wrong| format!("{name}: {wrong}"))?;
        let content = inside(document.root_element())?;
        let line = document.text_pos_at(content.start).row;
        Ok(format!("{}{}", origin(&path, line), &text[content]))
    }

    /// Copies of what is in an element, each in a frame within that of the one before. Their names end in the number of the copy.
    fn replicate(&self, node: Node, text: &str) -> Result<String, Wrong> {
        let element = Element::new("replicate", node);
        let count = element.needed_number("count")?;
        if count.fract() != 0.0 || !(1.0..=MOST_COPIES as f64).contains(&count) {
            return Err(element.wrong(format!("has count {count}, which must be 1 to {MOST_COPIES}")));
        }
        let count = count as usize;
        let line = node.document().text_pos_at(inside(node)?.start).row;
        let content =
            format!("<replicate>{}{}</replicate>", origin(&self.path, line), self.inside(node, text)?);
        let document = parsed(&content)?;
        let content = &content[..];
        let attribute = |key: &str, name: &str| {
            node.attribute(key).map_or_else(String::new, |value| format!(" {name}=\"{}\"", escaped(value)))
        };
        let frame = format!("<frame{}{}>", attribute("offset", "pos"), attribute("euler", "euler"));
        let digits = count.to_string().len();
        let mut whole = String::new();
        for copy in 0..count {
            let suffix = format!("{}{copy:0digits$}", escaped(node.attribute("sep").unwrap_or_default()));
            if copy > 0 {
                whole.push_str(&frame);
            }
            whole.push_str(&renamed(&document, content, &suffix)?);
            if whole.len() > MOST_BYTES {
                return Err(element.wrong(format!("stands for more than {MOST_BYTES} bytes")));
            }
        }
        whole.push_str(&"</frame>".repeat(count - 1));
        Ok(whole)
    }
}

/// The value of an attribute as it is written.
fn escaped(value: &str) -> String {
    value.replace('&', "&amp;").replace('<', "&lt;").replace('"', "&quot;").replace('\'', "&apos;")
}

/// What is in the root of a document, with a suffix on all names, also on those of what is attached.
fn renamed(document: &Document, text: &str, suffix: &str) -> Result<String, Wrong> {
    let range = inside(document.root_element())?;
    let (mut whole, mut from) = (String::new(), range.start);
    for node in document.descendants().filter(Node::is_element) {
        let is_attach = node.has_tag_name("attach");
        let name = node.attribute_node(if is_attach { SUFFIX } else { "name" });
        let end = match name {
            Some(name) => name.range_value().end,
            None if is_attach => node.range().start + "<attach".len(),
            None => continue,
        };
        if end < from || end > range.end {
            continue;
        }
        whole.push_str(&text[from..end]);
        whole.push_str(&if name.is_some() { suffix.to_owned() } else { format!(" {SUFFIX}=\"{suffix}\"") });
        from = end;
    }
    whole.push_str(&text[from..range.end]);
    Ok(whole)
}

#[cfg(test)]
mod tests;
