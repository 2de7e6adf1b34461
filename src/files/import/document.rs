//! Parse XML, and say where in which file an element is.

use std::path::Path;

use roxmltree::{Document, Node, ParsingOptions};

/// What is wrong with a description.
pub(super) type Wrong = String;

/// Name of the instruction that says from where the text after it is.
const ORIGIN: &str = "bodyschema-origin";

/// Reads XML. Entities are read as far as they do not grow out of proportion.
pub(super) fn parsed(text: &str) -> Result<Document<'_>, Wrong> {
    parse(text).map_err(|error| format!("this is not well-formed XML: {error}"))
}

/// Reads XML, with the error as the parser has it.
pub(super) fn parse(text: &str) -> Result<Document<'_>, roxmltree::Error> {
    Document::parse_with_options(text, ParsingOptions { allow_dtd: true, ..ParsingOptions::default() })
}

/// From where text is: the file, and the line on which it begins.
pub(super) fn origin(path: &Path, line: u32) -> String {
    let name = path.file_name().unwrap_or_default().to_string_lossy().replace(['?', '>'], "");
    format!("<?{ORIGIN} {line} {name}?>")
}

/// Where a node is, in words: the line, and the file if it is included.
pub(super) fn place(node: Node) -> String {
    let (text, start) = (node.document().input_text(), node.range().start);
    let begins = text[..start].rfind(&format!("<?{ORIGIN} "));
    let Some(begins) = begins else { return format!("line {}", node.document().text_pos_at(start).row) };
    let since = &text[begins..start];
    let words = since.split_once("?>").map_or("", |(mark, _)| mark).splitn(3, ' ').collect::<Vec<_>>();
    let first = words.get(1).and_then(|line| line.parse::<usize>().ok()).unwrap_or(1);
    format!("{} line {}", words.get(2).unwrap_or(&""), first + since.matches('\n').count())
}
