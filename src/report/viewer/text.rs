//! Pack numbers into the text of a page: whole numbers of one or two bytes, as base64.

use serde::Serialize;

/// Numbers as whole ones of two bytes, little-endian, in base64: each is `scale` times what is written.
#[derive(Debug, Serialize)]
pub(super) struct Packed {
    scale: f64,
    data: String,
}

impl Packed {
    /// Packs numbers to a 32,767th of the largest. One that is not finite becomes 0.
    pub(super) fn of(numbers: impl Iterator<Item = f64> + Clone) -> Self {
        let finite = numbers.clone().filter(|number| number.is_finite());
        let largest = finite.fold(0.0, |largest: f64, number| largest.max(number.abs()));
        let scale = if largest > 0.0 { largest / f64::from(i16::MAX) } else { 1.0 };
        let whole =
            numbers.map(|number| if number.is_finite() { (number / scale).round() as i16 } else { 0 });
        let bytes: Vec<u8> = whole.flat_map(i16::to_le_bytes).collect();
        Self { scale, data: base64(&bytes) }
    }
}

/// Bytes in base64 (RFC 4648, with padding).
pub(super) fn base64(bytes: &[u8]) -> String {
    const LETTERS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for three in bytes.chunks(3) {
        let at = |place: usize| u32::from(three.get(place).copied().unwrap_or(0));
        let bits = at(0) << 16 | at(1) << 8 | at(2);
        for place in 0..4 {
            let letter = LETTERS[(bits >> (18 - 6 * place)) as usize & 63];
            text.push(if place <= three.len() { char::from(letter) } else { '=' });
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn base64_is_that_of_the_standard() {
        for (bytes, text) in
            [("", ""), ("f", "Zg=="), ("fo", "Zm8="), ("foo", "Zm9v"), ("foobar", "Zm9vYmFy")]
        {
            assert_eq!(base64(bytes.as_bytes()), text);
        }
    }

    #[test]
    fn numbers_are_shares_of_the_largest() {
        let packed = Packed::of([0.0, -2.0, 1.0, f64::NAN].into_iter());
        assert_eq!(packed.scale, 2.0 / 32_767.0);
        assert_eq!(packed.data, base64(&[0, 0, 0x01, 0x80, 0x00, 0x40, 0, 0]));
    }
}
