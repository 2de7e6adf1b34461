//! Read attributes of an XML element, and say in one line which one is wrong.

use nalgebra::{UnitVector3, Vector3};
use roxmltree::Node;

use super::document::{Wrong, place};

/// Largest number that is read: sums and products of such numbers are numbers still.
const LARGEST: f64 = 1e9;

/// An element with the elements that give attributes it lacks, nearest first.
pub(super) struct Element<'a> {
    /// What messages call it.
    label: String,
    levels: Vec<Node<'a, 'a>>,
}

impl<'a> Element<'a> {
    /// An element by itself.
    pub(super) fn new(label: impl Into<String>, node: Node<'a, 'a>) -> Self {
        Self { label: label.into(), levels: vec![node] }
    }

    /// An element over its defaults, nearest first.
    pub(super) fn over(mut self, defaults: impl IntoIterator<Item = Node<'a, 'a>>) -> Self {
        self.levels.extend(defaults);
        self
    }

    /// An element within this one, by itself.
    pub(super) fn part(&self, node: Node<'a, 'a>) -> Self {
        Self::new(format!("{} of {}", node.tag_name().name(), self.label), node)
    }

    /// What kind of element it is.
    pub(super) fn tag(&self) -> &'a str {
        self.levels[0].tag_name().name()
    }

    /// A message that says where the element is.
    pub(super) fn wrong(&self, message: impl std::fmt::Display) -> Wrong {
        format!("{}: {} {message}", place(self.levels[0]), self.label)
    }

    /// An attribute, as it is written.
    pub(super) fn text(&self, key: &str) -> Option<&'a str> {
        self.levels.iter().find_map(|node| node.attribute(key))
    }

    /// An attribute that must be there.
    pub(super) fn needed(&self, key: &str) -> Result<&'a str, Wrong> {
        self.text(key).ok_or_else(|| self.wrong(format!("lacks {key}; add it")))
    }

    /// Which of several attributes that exclude each other is given nearest.
    pub(super) fn one_of(&self, keys: &[&'static str]) -> Option<&'static str> {
        let given = |node: &Node| keys.iter().copied().find(|key| node.has_attribute(*key));
        self.levels.iter().find_map(given)
    }

    /// An attribute that is so many numbers.
    pub(super) fn numbers<const N: usize>(&self, key: &str) -> Result<Option<[f64; N]>, Wrong> {
        let Some(text) = self.text(key) else { return Ok(None) };
        let found = parsed(text).and_then(|numbers| numbers.try_into().ok());
        let kind = if N == 1 { "a number".to_owned() } else { format!("{N} numbers") };
        found
            .map(Some)
            .ok_or_else(|| self.wrong(format!("has {key} `{text}`, which must be {kind} up to 1e9")))
    }

    /// An attribute that is a number.
    pub(super) fn number(&self, key: &str) -> Result<Option<f64>, Wrong> {
        Ok(self.numbers::<1>(key)?.map(|[number]| number))
    }

    /// Numbers that must be there.
    pub(super) fn needed_numbers<const N: usize>(&self, key: &str) -> Result<[f64; N], Wrong> {
        self.needed(key)?;
        Ok(self.numbers(key)?.unwrap_or([0.0; N]))
    }

    /// A number that must be there.
    pub(super) fn needed_number(&self, key: &str) -> Result<f64, Wrong> {
        Ok(self.needed_numbers::<1>(key)?[0])
    }

    /// An attribute that is a list of numbers, of which a nearer element may give the first ones only.
    pub(super) fn overlaid(&self, key: &str) -> Result<Vec<f64>, Wrong> {
        let mut all: Vec<f64> = Vec::new();
        for text in self.levels.iter().rev().filter_map(|node| node.attribute(key)) {
            let near = parsed(text)
                .ok_or_else(|| self.wrong(format!("has {key} `{text}`, which must be numbers up to 1e9")))?;
            let far = all.split_off(all.len().min(near.len()));
            all = near.into_iter().chain(far).collect();
        }
        Ok(all)
    }

    /// The direction of three numbers of an attribute.
    pub(super) fn direction(&self, key: &str, numbers: &[f64]) -> Result<UnitVector3<f64>, Wrong> {
        UnitVector3::try_new(Vector3::from_iterator(numbers.iter().copied()), 1e-9)
            .ok_or_else(|| self.wrong(format!("has {key} of length 0; give it a direction")))
    }
}

/// Numbers with spaces between them.
fn parsed(text: &str) -> Option<Vec<f64>> {
    let number = |word: &str| word.parse().ok().filter(|number: &f64| number.abs() <= LARGEST);
    text.split_whitespace().map(number).collect()
}
