//! Read text as UTF-8, whatever its encoding: with or without a byte order mark, UTF-16 of either order.

use std::io::{self, Read};

/// The encoding of a text.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Encoding {
    /// UTF-8, or any other that has digits as ASCII has them; so many bytes of a mark come before it.
    Bytes(usize),
    /// UTF-16: whether the high byte comes first, and bytes of a mark.
    Utf16(bool, usize),
}

impl Encoding {
    /// By the first bytes. In UTF-16 without a mark, every second byte of a table is 0.
    fn of(head: &[u8]) -> Self {
        let zeros = |first: usize| head.iter().skip(first).step_by(2).filter(|byte| **byte == 0).count();
        let most =
            |first: usize, other: usize| 4 * zeros(first) > head.len() && 8 * zeros(other) < head.len();
        match head {
            [0xEF, 0xBB, 0xBF, ..] => Self::Bytes(3),
            [0xFF, 0xFE, ..] => Self::Utf16(false, 2),
            [0xFE, 0xFF, ..] => Self::Utf16(true, 2),
            _ if most(1, 0) => Self::Utf16(false, 0),
            _ if most(0, 1) => Self::Utf16(true, 0),
            _ => Self::Bytes(0),
        }
    }
}

/// Reads the text of `from`, which begins with `head`.
pub(super) fn text<'a>(
    head: &[u8],
    mut from: impl Read + Send + 'a,
) -> io::Result<Box<dyn Read + Send + 'a>> {
    let encoding = Encoding::of(head);
    let (Encoding::Bytes(mark) | Encoding::Utf16(_, mark)) = encoding;
    from.read_exact(&mut [0; 3][..mark])?;
    Ok(match encoding {
        Encoding::Bytes(_) => Box::new(from),
        Encoding::Utf16(is_big, _) => {
            Box::new(Utf16 { from, is_big, ready: Vec::new(), at: 0, rest: Vec::new() })
        }
    })
}

/// Reads UTF-16 as UTF-8.
struct Utf16<R> {
    from: R,
    is_big: bool,
    /// What was decoded, and how much of it was read.
    ready: Vec<u8>,
    at: usize,
    /// Bytes that do not make a character yet.
    rest: Vec<u8>,
}

impl<R: Read> Utf16<R> {
    /// Decodes some more; whether there was more.
    fn advance(&mut self) -> io::Result<bool> {
        const BLOCK: u64 = 1 << 14;
        let kept = self.rest.len();
        self.from.by_ref().take(BLOCK).read_to_end(&mut self.rest)?;
        let is_last = self.rest.len() == kept;
        let unit = |pair: &[u8; 2]| {
            if self.is_big { u16::from_be_bytes(*pair) } else { u16::from_le_bytes(*pair) }
        };
        let mut units: Vec<u16> = self.rest.as_chunks().0.iter().map(unit).collect();
        // The first half of a pair waits for the second.
        if !is_last && units.last().is_some_and(|last| (0xD800..0xDC00).contains(last)) {
            units.pop();
        }
        self.rest.drain(..2 * units.len());
        self.ready = String::from_utf16_lossy(&units).into_bytes();
        self.at = 0;
        Ok(!is_last || !self.ready.is_empty())
    }
}

impl<R: Read> Read for Utf16<R> {
    fn read(&mut self, into: &mut [u8]) -> io::Result<usize> {
        while self.at == self.ready.len() {
            if !self.advance()? {
                return Ok(0);
            }
        }
        let count = into.len().min(self.ready.len() - self.at);
        into[..count].copy_from_slice(&self.ready[self.at..self.at + count]);
        self.at += count;
        Ok(count)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(bytes: &[u8]) -> String {
        let mut found = Vec::new();
        text(bytes, bytes).unwrap().read_to_end(&mut found).unwrap();
        String::from_utf8(found).unwrap()
    }

    #[test]
    fn every_encoding_gives_the_same_text() {
        let original = format!("größe;𝔭\r\n{}", "1,5;-2\r\n".repeat(20_000));
        let units = || original.encode_utf16();
        let little: Vec<u8> = units().flat_map(u16::to_le_bytes).collect();
        let big: Vec<u8> = units().flat_map(u16::to_be_bytes).collect();
        assert_eq!(read(original.as_bytes()), original);
        assert_eq!(read(&[b"\xEF\xBB\xBF", original.as_bytes()].concat()), original);
        assert_eq!(read(&[b"\xFF\xFE", &little[..]].concat()), original);
        assert_eq!(read(&[b"\xFE\xFF", &big[..]].concat()), original);
        assert_eq!((read(&little), read(&big)), (original.clone(), original.clone()));
        // Cut in a character, and half of a pair: no failure.
        assert_eq!(read(&[b"\xFF\xFE", &little[..9]].concat()), "größ");
        assert_eq!(read(b"\xFF\xFEa\0\x35\xD8"), "a\u{FFFD}");
        assert_eq!(read(b"\xFF\xFE"), "");
    }
}
