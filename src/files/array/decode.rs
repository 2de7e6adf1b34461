//! Decode numbers of any type that NumPy has: floating-point numbers of 16 to 64 bits, integers, bool.

use std::io;

use npyz::{DType, Deserialize, TypeChar, TypeRead};

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
        match (kind.type_char(), kind.num_bytes()?) {
            (TypeChar::Float, 2) => of(dtype, half_number),
            (TypeChar::Float, 4) => of(dtype, <f64 as From<f32>>::from),
            (TypeChar::Float, 8) => of(dtype, |value: f64| value),
            (TypeChar::Bool, 1) => of(dtype, |value: bool| f64::from(u8::from(value))),
            (TypeChar::Int, 1) => of(dtype, <f64 as From<i8>>::from),
            (TypeChar::Int, 2) => of(dtype, <f64 as From<i16>>::from),
            (TypeChar::Int, 4) => of(dtype, <f64 as From<i32>>::from),
            (TypeChar::Int, 8) => of(dtype, |value: i64| value as f64),
            (TypeChar::Uint, 1) => of(dtype, <f64 as From<u8>>::from),
            (TypeChar::Uint, 2) => of(dtype, <f64 as From<u16>>::from),
            (TypeChar::Uint, 4) => of(dtype, <f64 as From<u32>>::from),
            (TypeChar::Uint, 8) => of(dtype, |value: u64| value as f64),
            _ => None,
        }
    }
}

/// float16 as f64.
fn half_number(value: half::f16) -> f64 {
    value.to_f64()
}

fn of<S: Deserialize<TypeReader: Send + Sync + 'static> + 'static>(
    dtype: &DType,
    number: fn(S) -> f64,
) -> Option<Decode> {
    let (decoder, width) = (S::reader(dtype).ok()?, size_of::<S>());
    let add = move |bytes: &[u8], values: &mut Vec<f64>| {
        values.reserve(bytes.len() / width);
        bytes.chunks_exact(width).try_for_each(|value| {
            values.push(number(decoder.read_one(value)?));
            Ok(())
        })
    };
    let DType::Plain(kind) = dtype else { return None };
    let is_single = width <= 2 || width == 4 && kind.type_char() == TypeChar::Float;
    Some(Decode { width, add: Box::new(add), is_single })
}
