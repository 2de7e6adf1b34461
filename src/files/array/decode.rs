//! Decode numbers of any type that NumPy has: floating-point numbers of 16 to 64 bits, integers, bool.

use std::io;

use npyz::{DType, Endianness, TypeChar};

/// Adds the values that bytes hold.
type AddValues = dyn Fn(&[u8], &mut Vec<f64>) -> io::Result<()> + Send + Sync;

/// Decodes values of one type. All but integers beyond 2^53 are exact as f64.
pub(super) struct Decode {
    /// Bytes of a value.
    pub width: usize,
    pub add: Box<AddValues>,
    /// Whether float32 has room for all digits of a value.
    pub is_single: bool,
}

impl Decode {
    /// Of values of a type; `None` if they are no numbers.
    pub(super) fn of(dtype: &DType) -> Option<Self> {
        let DType::Plain(kind) = dtype else { return None };
        let is_big = kind.endianness() == Endianness::Big;
        let (width, is_float) = (kind.num_bytes()?, kind.type_char() == TypeChar::Float);
        let add = match (kind.type_char(), width) {
            (TypeChar::Float, 2) => adds(is_big, |bytes| half::f16::from_le_bytes(bytes).to_f64()),
            (TypeChar::Float, 4) => adds(is_big, |bytes| f64::from(f32::from_le_bytes(bytes))),
            (TypeChar::Float, 8) => adds(is_big, f64::from_le_bytes),
            (TypeChar::Bool, 1) => Box::new(add_bools),
            (TypeChar::Int, 1) => adds(is_big, |bytes| f64::from(i8::from_le_bytes(bytes))),
            (TypeChar::Int, 2) => adds(is_big, |bytes| f64::from(i16::from_le_bytes(bytes))),
            (TypeChar::Int, 4) => adds(is_big, |bytes| f64::from(i32::from_le_bytes(bytes))),
            (TypeChar::Int, 8) => adds(is_big, |bytes| i64::from_le_bytes(bytes) as f64),
            (TypeChar::Uint, 1) => adds(is_big, |bytes| f64::from(u8::from_le_bytes(bytes))),
            (TypeChar::Uint, 2) => adds(is_big, |bytes| f64::from(u16::from_le_bytes(bytes))),
            (TypeChar::Uint, 4) => adds(is_big, |bytes| f64::from(u32::from_le_bytes(bytes))),
            (TypeChar::Uint, 8) => adds(is_big, |bytes| u64::from_le_bytes(bytes) as f64),
            _ => return None,
        };
        Some(Self { width, add, is_single: width <= 2 || is_float && width == 4 })
    }
}

/// Decodes each `WIDTH` bytes by `number`, which takes the least significant byte first.
fn adds<const WIDTH: usize>(
    is_big: bool,
    number: impl Fn([u8; WIDTH]) -> f64 + Send + Sync + 'static,
) -> Box<AddValues> {
    let reversed = |mut bytes: [u8; WIDTH]| {
        bytes.reverse();
        bytes
    };
    Box::new(move |bytes, values| {
        let each = bytes.as_chunks().0.iter();
        match is_big {
            true => values.extend(each.map(|bytes| number(reversed(*bytes)))),
            false => values.extend(each.map(|bytes| number(*bytes))),
        }
        Ok(())
    })
}

/// Adds bytes that must be 0 or 1.
fn add_bools(bytes: &[u8], values: &mut Vec<f64>) -> io::Result<()> {
    if let Some(byte) = bytes.iter().find(|byte| **byte > 1) {
        return Err(io::Error::new(io::ErrorKind::InvalidData, format!("{byte} is no bool")));
    }
    values.extend(bytes.iter().map(|byte| f64::from(*byte)));
    Ok(())
}
