//! The pages can be read by somebody whose second language is English: their sentences are short, and they use the field's words.

use std::fs;

use pulldown_cmark::{Event, Options, Parser, Tag, TagEnd};
use unicode_segmentation::UnicodeSegmentation;

use crate::support::repository::{pages, read};

/// Most words of a sentence, on average over a page.
const AVERAGE: f64 = 25.0;

/// Most words of a single sentence.
const LONGEST: usize = 40;

/// Most words of the README.
const README: usize = 800;

/// Words of a dialect that nobody else speaks; CONTRIBUTING.md says what to write instead.
const DIALECT: [&str; 13] = [
    "a draw ",
    "draws of",
    "eligible draw",
    "single bodies",
    "fluid that pushes",
    "loose set",
    "hangs on",
    "on the mean",
    "on the whole",
    "reading of the paper",
    "by the reading",
    "one body shows",
    "taken apart",
];

/// The sentences of the paragraphs and lists of a page; what is in code is one word, and tables, headings and pictures do not count.
fn sentences(markdown: &str) -> Vec<String> {
    let (mut sentences, mut text, mut silent) = (Vec::new(), String::new(), 0);
    let mut end = |text: &mut String| {
        sentences.extend(text.unicode_sentences().map(str::trim).map(str::to_owned));
        text.clear();
    };
    for event in Parser::new_ext(markdown, Options::ENABLE_TABLES) {
        match event {
            Event::Start(Tag::Table(_) | Tag::Heading { .. } | Tag::CodeBlock(_) | Tag::Image { .. }) => {
                silent += 1
            }
            Event::End(TagEnd::Table | TagEnd::Heading(_) | TagEnd::CodeBlock | TagEnd::Image) => silent -= 1,
            Event::Text(words) if silent == 0 => text += &words,
            // As a name, which may begin a sentence.
            Event::Code(_) if silent == 0 => text += "Code",
            Event::SoftBreak | Event::HardBreak => text.push(' '),
            Event::Start(Tag::Item) | Event::End(TagEnd::Paragraph | TagEnd::Item) => end(&mut text),
            _ => {}
        }
    }
    end(&mut text);
    sentences.retain(|sentence| words(sentence) > 0);
    sentences
}

fn words(text: &str) -> usize {
    text.split_whitespace().filter(|word| word.chars().any(char::is_alphanumeric)).count()
}

/// What is wrong with a page, in a line each.
fn faults(markdown: &str) -> Vec<String> {
    let sentences = sentences(markdown);
    let long = sentences.iter().filter(|sentence| words(sentence) > LONGEST);
    let mut faults: Vec<String> =
        long.map(|sentence| format!("{} words: {sentence}", words(sentence))).collect();
    let average = sentences.iter().map(|sentence| words(sentence)).sum::<usize>() as f64
        / sentences.len().max(1) as f64;
    if average > AVERAGE {
        faults.push(format!("{average:.1} words on average"));
    }
    for sentence in &sentences {
        let lower = sentence.to_lowercase();
        faults.extend(
            DIALECT
                .iter()
                .filter(|word| lower.contains(**word))
                .map(|word| format!("`{word}` in: {sentence}")),
        );
    }
    faults
}

#[test]
fn sentences_are_short_and_in_the_fields_words() {
    let wrong: Vec<String> = pages()
        .into_iter()
        .flat_map(|page| {
            let found = faults(&fs::read_to_string(&page).unwrap());
            found.into_iter().map(move |fault| format!("{}: {fault}", page.display()))
        })
        .collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn the_readme_is_short() {
    let words = words(&read("README.md"));
    assert!(words <= README, "the README has {words} words");
}

#[test]
fn long_sentences_and_dialect_are_found() {
    let long = format!("# A heading\n\nShort. {} end.\n", "Word ".repeat(LONGEST));
    assert_eq!(faults(&long).len(), 1, "{:?}", faults(&long));
    let mean = format!("{} end.\n\n- {} end.\n", "word ".repeat(30), "word ".repeat(30));
    assert_eq!(faults(&mean), ["31.0 words on average"]);
    assert_eq!(faults("The tree hangs on p.\n").len(), 1);
    let fine =
        format!("See `{}` and\n\n| a | {} |\n|---|---|\n\n    code\n", "x ".repeat(50), "cell ".repeat(50));
    assert_eq!(faults(&fine), [""; 0]);
    assert_eq!(sentences("One sentence. Another, with 0.5 m.\n\n- An item\n- A second").len(), 4);
}
