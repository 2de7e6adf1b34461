//! Read the skeleton of a BVH file: joints within joints, their offsets and channels.

use std::collections::HashMap;
use std::iter::Peekable;
use std::vec::IntoIter;

use super::{Wrong, number, quoted};
use crate::stages::agent::Vector3;
use crate::stages::simulate::recorded::{Channel, RecordedJoint};

/// Most joints of a skeleton.
const MAX_JOINTS: usize = 10_000;
/// Longest name, in characters; what is beyond is cut off.
const MAX_NAME: usize = 200;

/// A word and the line that it is on.
type Word<'a> = (usize, &'a str);

/// What a brace is open for.
enum Open {
    /// A joint, by its number.
    Joint(usize),
    /// The end of a bone, and the line on which it begins.
    End(usize, Option<Vector3>),
}

/// A joint as far as it is read.
struct Entry {
    line: usize,
    name: String,
    parent: Option<usize>,
    offset: Option<Vector3>,
    channels: Option<Vec<Channel>>,
    ends: Vec<Vector3>,
}

struct Hierarchy<'a> {
    words: Peekable<IntoIter<Word<'a>>>,
    entries: Vec<Entry>,
    open: Vec<Open>,
    /// Names, each with the number that the last joint got that wanted it.
    names: HashMap<String, usize>,
}

/// The joints that lines describe, each after the one that carries it.
pub(super) fn joints(lines: &[(usize, &str)]) -> Result<Vec<RecordedJoint>, Wrong> {
    let words: Vec<Word> = lines.iter().flat_map(|&(line, text)| words(line, text)).collect();
    let mut hierarchy = Hierarchy {
        words: words.into_iter().peekable(),
        entries: Vec::new(),
        open: Vec::new(),
        names: HashMap::new(),
    };
    match hierarchy.words.next() {
        Some((_, word)) if word.eq_ignore_ascii_case("HIERARCHY") => {}
        Some((line, word)) => {
            return Err(format!("line {line}: a BVH file begins with HIERARCHY, not with {}", quoted(word)));
        }
        None => return Err("is empty; a BVH file begins with HIERARCHY".to_owned()),
    }
    while let Some(word) = hierarchy.words.next() {
        hierarchy.read(word)?;
    }
    hierarchy.finish()
}

/// The words of a line; a brace is one, even without spaces around it.
fn words(line: usize, text: &str) -> Vec<Word<'_>> {
    let mut words = Vec::new();
    for mut word in text.split_whitespace() {
        while let Some(rest) = word.strip_prefix(['{', '}']) {
            words.push((line, &word[..1]));
            word = rest;
        }
        let bare = word.trim_end_matches(['{', '}']);
        if !bare.is_empty() {
            words.push((line, bare));
        }
        words.extend((bare.len()..word.len()).map(|at| (line, &word[at..=at])));
    }
    words
}

impl<'a> Hierarchy<'a> {
    fn read(&mut self, (line, word): Word<'a>) -> Result<(), Wrong> {
        match word.to_ascii_uppercase().as_str() {
            "ROOT" if !self.entries.is_empty() => Err(format!(
                "line {line}: a second ROOT; a file has one skeleton: write each into a file of its own"
            )),
            "ROOT" => self.joint(line, None),
            "JOINT" => match self.open.last() {
                Some(&Open::Joint(parent)) => self.joint(line, Some(parent)),
                _ => Err(format!(
                    "line {line}: JOINT is not within a ROOT or JOINT; check the braces before it"
                )),
            },
            "END" => match self.open.last() {
                Some(Open::Joint(_)) => {
                    self.name(line)?;
                    self.open.push(Open::End(line, None));
                    Ok(())
                }
                _ => Err(format!(
                    "line {line}: End Site is not within a ROOT or JOINT; check the braces before it"
                )),
            },
            "OFFSET" => self.offset(line),
            "CHANNELS" => self.channels(line),
            "}" => self.close(line),
            _ => Err(format!(
                "line {line}: {} is not expected here; check the words and braces before it",
                quoted(word)
            )),
        }
    }

    /// The words up to the brace that must follow on this line or a later one.
    fn name(&mut self, line: usize) -> Result<String, Wrong> {
        let mut name = Vec::new();
        while let Some((_, word)) = self.words.next_if(|(own, word)| *own == line && *word != "{") {
            name.push(word);
        }
        match self.words.next() {
            Some((_, "{")) => Ok(name.join(" ")),
            _ => Err(format!("line {line}: {} lacks its `{{`; add it", quoted(&name.join(" ")))),
        }
    }

    fn joint(&mut self, line: usize, parent: Option<usize>) -> Result<(), Wrong> {
        let name = self.name(line)?;
        if self.entries.len() == MAX_JOINTS {
            return Err(format!("line {line}: more than {MAX_JOINTS} joints, the maximum for a skeleton"));
        }
        let name = self.free_name(&name);
        self.open.push(Open::Joint(self.entries.len()));
        self.entries.push(Entry { line, name, parent, offset: None, channels: None, ends: Vec::new() });
        Ok(())
    }

    /// A name that no joint has yet, and a terminal can show.
    fn free_name(&mut self, name: &str) -> String {
        let shown = |letter: char| if letter.is_control() { '\u{fffd}' } else { letter };
        let name: String = name.chars().take(MAX_NAME).map(shown).collect();
        let name = if name.is_empty() { "unnamed".to_owned() } else { name };
        let mut free = name.clone();
        let mut number = self.names.get(&name).copied().unwrap_or(1);
        while self.names.contains_key(&free) {
            number += 1;
            free = format!("{name} ({number})");
        }
        self.names.insert(name, number);
        self.names.insert(free.clone(), 1);
        free
    }

    fn offset(&mut self, line: usize) -> Result<(), Wrong> {
        let mut offset = [0.0; 3];
        for slot in &mut offset {
            let word = self.words.next_if(|(own, _)| *own == line).map(|(_, word)| word);
            *slot = word.and_then(number).ok_or_else(|| {
                let found = word.map_or("nothing".to_owned(), quoted);
                format!("line {line}: OFFSET needs three numbers up to 1e9, but has {found}")
            })?;
        }
        let slot = match self.open.last_mut() {
            Some(&mut Open::Joint(joint)) => &mut self.entries[joint].offset,
            Some(Open::End(_, offset)) => offset,
            None => return Err(format!("line {line}: OFFSET is not within a ROOT, JOINT or End Site")),
        };
        match slot.replace(offset) {
            None => Ok(()),
            Some(_) => Err(format!("line {line}: a second OFFSET; remove one")),
        }
    }

    fn channels(&mut self, line: usize) -> Result<(), Wrong> {
        let wrong = |message: String| format!("line {line}: CHANNELS {message}");
        let Some(&Open::Joint(joint)) = self.open.last() else {
            return Err(wrong("is not within a ROOT or JOINT".to_owned()));
        };
        let count = self.words.next().and_then(|(_, word)| word.parse::<usize>().ok());
        let count = count.ok_or_else(|| wrong("does not begin with how many follow".to_owned()))?;
        let mut channels: Vec<Channel> = Vec::new();
        for _ in 0..count {
            let word = self.words.next().map_or("nothing", |(_, word)| word);
            let channel = channel(word).ok_or_else(|| {
                wrong(format!(
                    "has {}; the channels are Xposition, Yposition, Zposition, Xrotation, Yrotation and Zrotation, as many as \
                     it says",
                    quoted(word)
                ))
            })?;
            let rotations = channels.iter().filter(|channel| matches!(channel, Channel::Rotation(_))).count();
            match channel {
                Channel::Rotation(_) if rotations == 3 => {
                    return Err(wrong("has more than three rotations; keep three".to_owned()));
                }
                Channel::Position(_) if channels.contains(&channel) => {
                    return Err(wrong(format!("has {} twice; remove one", quoted(word))));
                }
                _ => channels.push(channel),
            }
        }
        match self.entries[joint].channels.replace(channels) {
            None => Ok(()),
            Some(_) => Err(wrong("stands a second time; remove one".to_owned())),
        }
    }

    fn close(&mut self, line: usize) -> Result<(), Wrong> {
        match self.open.pop() {
            Some(Open::Joint(_)) => Ok(()),
            Some(Open::End(begun, offset)) => {
                let offset = offset.ok_or_else(|| format!("line {begun}: End Site lacks OFFSET; add it"))?;
                if let Some(&Open::Joint(joint)) = self.open.last() {
                    self.entries[joint].ends.push(offset);
                }
                Ok(())
            }
            None => Err(format!("line {line}: `}}` closes nothing; remove it")),
        }
    }

    fn finish(self) -> Result<Vec<RecordedJoint>, Wrong> {
        if let Some(open) = self.open.last() {
            let line = match open {
                Open::Joint(joint) => self.entries[*joint].line,
                Open::End(line, _) => *line,
            };
            return Err(format!("line {line}: its `{{` is never closed; add `}}`"));
        }
        if self.entries.is_empty() {
            return Err("has no ROOT, and so no skeleton".to_owned());
        }
        if self.entries.iter().all(|entry| entry.channels.as_ref().is_none_or(Vec::is_empty)) {
            return Err("has no joint with CHANNELS, so that nothing can move".to_owned());
        }
        let joint = |entry: Entry| {
            let Entry { line, name, parent, offset, channels, ends } = entry;
            let offset =
                offset.ok_or_else(|| format!("line {line}: {} lacks OFFSET; add it", quoted(&name)))?;
            Ok(RecordedJoint { name, parent, offset, channels: channels.unwrap_or_default(), ends })
        };
        self.entries.into_iter().map(joint).collect()
    }
}

fn channel(word: &str) -> Option<Channel> {
    let (axis, kind) = word.split_at_checked(1)?;
    let axis = "xyz".find(&axis.to_ascii_lowercase())?;
    match kind.to_ascii_lowercase().as_str() {
        "position" => Some(Channel::Position(axis)),
        "rotation" => Some(Channel::Rotation(axis)),
        _ => None,
    }
}
