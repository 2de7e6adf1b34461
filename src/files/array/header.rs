//! Refuse a header of a `.npy` file that NumPy would not write for a matrix.

/// Whether the header is one that NumPy would write, given the start of a file.
///
/// `npyz` reads any Python literal: it takes twice as long for each further list in a list, and multiplies the
/// lengths of any shape. NumPy's own header of a matrix has about a hundred characters, two pairs of brackets, and the
/// digits of two lengths and of a type.
pub(super) fn check(start: &[u8]) -> Result<(), &'static str> {
    const MAX_CHARACTERS: usize = 10_000;
    const MAX_BRACKETS: usize = 6;
    const MAX_DIGITS: usize = 18;
    let (length, text) = match *start {
        [b'\x93', b'N', b'U', b'M', b'P', b'Y', 1, _, a, b, ref text @ ..] => {
            (usize::from(u16::from_le_bytes([a, b])), text)
        }
        [b'\x93', b'N', b'U', b'M', b'P', b'Y', _, _, a, b, c, d, ref text @ ..] => {
            (u32::from_le_bytes([a, b, c, d]) as usize, text)
        }
        // The reader says what is wrong.
        _ => return Ok(()),
    };
    if length > MAX_CHARACTERS {
        return Err("has a header of more than 10000 characters; save the matrix again with numpy.save");
    }
    let text = &text[..length.min(text.len())];
    let brackets = text.iter().filter(|character| b"([{".contains(character)).count();
    let digits = text.iter().filter(|character| character.is_ascii_digit()).count();
    let hexadecimal = text.windows(2).any(|pair| pair.eq_ignore_ascii_case(b"0x"));
    if brackets > MAX_BRACKETS || digits > MAX_DIGITS || hexadecimal {
        return Err("has a header that is not of a plain matrix; save the matrix again with numpy.save");
    }
    Ok(())
}
