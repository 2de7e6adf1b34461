//! Test types, orders and versions of `.npy` files, and each way in which one can be wrong.

use super::*;

fn folder() -> tempfile::TempDir {
    tempfile::tempdir().unwrap()
}

#[test]
fn what_was_written_is_read_in_either_order() {
    let folder = folder();
    let (samples, sensors) = (70, 45);
    let tactile = Tactile { samples, pressures: (0..samples * sensors).map(|at| at as f32 * 0.25).collect() };
    let fortran = folder.path().join("fortran.npy");
    write_tactile(&fortran, &tactile).unwrap();
    assert_eq!(read_tactile(&fortran).unwrap(), tactile);

    let at = |t: usize| (0..sensors).map(move |sensor| sensor * samples + t);
    let by_time: Vec<f32> = (0..samples).flat_map(at).map(|at| tactile.pressures[at]).collect();
    let c = folder.path().join("c.npy");
    write(&c, [samples, sensors], Order::C, by_time.iter().map(|&x| f64::from(x))).unwrap();
    assert_eq!(read_tactile(&c).unwrap(), tactile);
}

#[test]
fn symbols_of_any_type_are_read() {
    let folder = folder();
    let path = folder.path().join("symbols.npy");
    let expected = Symbols { samples: 2, levels: 6, values: vec![0, 1, 5, 0, 2, 2] };
    macro_rules! check {
        ($($kind:ty),*) => {$({
            let values = [0, 5, 2, 1, 0, 2].map(|value: u8| value as $kind);
            write(&path, [2, 3], Order::C, values.into_iter()).unwrap();
            assert_eq!(read_symbols(&path).unwrap(), expected);
        })*};
    }
    check!(i8, i16, i32, i64, u8, u16, u32, u64, f32, f64);
    let halves = [0.0, 5.0, 2.0, 1.0, 0.0, 2.0].map(half::f16::from_f64);
    write(&path, [2, 3], Order::C, halves.into_iter()).unwrap();
    assert_eq!(read_symbols(&path).unwrap(), expected);
    write(&path, [2, 2], Order::C, [true, false, false, true].into_iter()).unwrap();
    assert_eq!(read_symbols(&path).unwrap(), Symbols { samples: 2, levels: 2, values: vec![1, 0, 0, 1] });
    write(&path, [1, 1], Order::C, [-1_i8].into_iter()).unwrap();
    assert!(read_symbols(&path).is_err());
}

#[test]
fn mistakes_are_named_with_their_place() {
    let folder = folder();
    let path = folder.path().join("bad.npy");
    let says = |message: String, expected: &str| {
        assert!(message.contains(expected) && message.contains("bad.npy"), "{message:?} lacks {expected:?}");
    };
    says(read_tactile(&path).unwrap_err().to_string(), "no such file");

    write(&path, [2, 2], Order::C, [0.0, 1.0, f64::NAN, 2.0].into_iter()).unwrap();
    says(read_tactile(&path).unwrap_err().to_string(), "row 1, column 0: NaN; a pressure must be a finite");
    says(read_body_map(&path).unwrap_err().to_string(), "row 1, column 0: NaN; a coordinate");
    says(read_symbols(&path).unwrap_err().to_string(), "whole number from 0 to 255");

    write(&path, [2, 2], Order::C, [0.0, 1.0, -1.0, 2.0].into_iter()).unwrap();
    says(
        read_tactile(&path).unwrap_err().to_string(),
        "row 1, column 0: -1; a pressure must not be negative",
    );
    write(&path, [2, 2], Order::C, [0.0, 1.0, 3.0, 0.0].into_iter()).unwrap();
    says(read_distances(&path).unwrap_err().to_string(), "must be symmetric");
    write(&path, [2, 2], Order::C, [0.5, 1.0, 1.0, 0.0].into_iter()).unwrap();
    says(read_distances(&path).unwrap_err().to_string(), "the diagonal must be 0");
    write(&path, [1, 2], Order::C, [0.5, 1.0].into_iter()).unwrap();
    says(read_distances(&path).unwrap_err().to_string(), "square matrix, but the shape is 1 x 2");
    write(&path, [0, 2], Order::C, std::iter::empty::<f64>()).unwrap();
    says(read_body_map(&path).unwrap_err().to_string(), "is empty");

    write(&path, [100, 100], Order::C, (0..10_000).map(f64::from)).unwrap();
    let whole = std::fs::read(&path).unwrap();
    std::fs::write(&path, &whole[..whole.len() / 2]).unwrap();
    says(read_body_map(&path).unwrap_err().to_string(), "is truncated");
    std::fs::write(&path, &whole[..whole.len() - 3]).unwrap();
    says(read_body_map(&path).unwrap_err().to_string(), "is truncated");
    std::fs::write(&path, "sensor,part\n0,1\n").unwrap();
    says(read_body_map(&path).unwrap_err().to_string(), "cannot be read as a .npy file");
}

/// A file as NumPy writes it, of a header of our own and some bytes.
fn raw(version: u8, header: &str, data: &[u8]) -> Vec<u8> {
    let length = header.len() as u32;
    let prefix = match version {
        1 => (length as u16).to_le_bytes().to_vec(),
        _ => length.to_le_bytes().to_vec(),
    };
    [&b"\x93NUMPY"[..], &[version, 0], prefix.as_slice(), header.as_bytes(), data].concat()
}

fn header(dtype: &str, shape: &str) -> String {
    format!("{{'descr': '{dtype}', 'fortran_order': False, 'shape': {shape}, }}\n")
}

#[test]
fn bytes_in_any_order_and_any_version_of_the_header_are_read() {
    let folder = folder();
    let path = folder.path().join("map.npy");
    let expected = BodyMap { dims: 2, coordinates: vec![0.0, 258.0, -2.0, 3.0, 5.0, -300.0] };
    for version in 1..=3 {
        let big: Vec<u8> = expected.coordinates.iter().flat_map(|x| x.to_be_bytes()).collect();
        std::fs::write(&path, raw(version, &header(">f8", "(3, 2)"), &big)).unwrap();
        assert_eq!(read_body_map(&path).unwrap(), expected);
        let whole: Vec<u8> = expected.coordinates.iter().flat_map(|x| (*x as i16).to_be_bytes()).collect();
        std::fs::write(&path, raw(version, &header(">i2", "(3, 2)"), &whole)).unwrap();
        assert_eq!(read_body_map(&path).unwrap(), expected);
    }
    // Keys in another order, and no space.
    let text = "{'shape':(1,2),'descr':'<f4','fortran_order':True}";
    std::fs::write(&path, raw(1, text, &[0; 8])).unwrap();
    assert_eq!(read_body_map(&path).unwrap(), BodyMap { dims: 2, coordinates: vec![0.0; 2] });
}

#[test]
fn one_sensor_and_one_sample_are_data() {
    let folder = folder();
    let path = folder.path().join("one.npy");
    write(&path, [3, 1], Order::C, [0.0, 2.0, 1.0].into_iter()).unwrap();
    assert_eq!(read_tactile(&path).unwrap(), Tactile { samples: 3, pressures: vec![0.0, 2.0, 1.0] });
    write(&path, [1, 3], Order::C, [0.0, 2.0, 1.0].into_iter()).unwrap();
    assert_eq!(read_tactile(&path).unwrap(), Tactile { samples: 1, pressures: vec![0.0, 2.0, 1.0] });
    write(&path, [1, 1], Order::C, [0.0].into_iter()).unwrap();
    assert_eq!(read_distances(&path).unwrap(), Distances { sensors: 1, values: vec![0.0] });
}

#[test]
fn no_header_takes_long_or_much_memory_to_refuse() {
    let folder = folder();
    let path = folder.path().join("bad.npy");
    let largest = "18446744073709551615";
    let nested = format!("{}{}", "[".repeat(60), "]".repeat(60));
    for (bytes, expected) in [
        (raw(1, &header("<f8", &format!("({largest}, {largest})")), &[0; 64]), "not of a plain matrix"),
        (
            raw(1, &header("<f8", "(0xffffffffffffffff, 0xffffffffffffffff)"), &[0; 64]),
            "not of a plain matrix",
        ),
        (raw(1, &header("<f8", &nested), &[0; 64]), "not of a plain matrix"),
        (raw(2, &header("<f8", &"(".repeat(40)), &[0; 64]), "not of a plain matrix"),
        (raw(1, &header("<f8", "(999999999, 9999999)"), &[0; 64]), "is truncated: its header states"),
        (
            raw(1, &header("<f8", &format!("(1, 1{})", " ".repeat(20_000))), &[0; 8]),
            "more than 10000 characters",
        ),
        (b"\x93NUMPY\x02\x00\xff\xff\xff\xff{".to_vec(), "more than 10000 characters"),
        (b"\x93NUMPY\x01\x00\x80\x00{".to_vec(), "cannot be read as a .npy file"),
        (b"\x93NUMPY\x09\x00\x01\x00\x00\x00{".to_vec(), "cannot be read as a .npy file"),
        (b"\x93NUMPY\x01".to_vec(), "cannot be read as a .npy file"),
        (Vec::new(), "cannot be read as a .npy file"),
        (raw(1, &header("<f8", "(-1, 2)"), &[0; 64]), "dimension cannot be negative"),
        (raw(1, &header("<f8", "(4,)"), &[0; 64]), "must have two dimensions"),
        (raw(1, &header("<f8", "()"), &[0; 64]), "must have two dimensions"),
        (raw(1, &header("<f16", "(2, 2)"), &[0; 64]), "numbers or bool, but its dtype is '<f16'"),
        (raw(1, &header("|b1", "(2, 2)"), &[0, 1, 2, 1]), "is truncated or damaged"),
        (raw(1, &header("<c8", "(2, 2)"), &[0; 64]), "but its dtype is '<c8'"),
        (raw(1, &header("<U3", "(2, 2)"), &[0; 64]), "but its dtype is '<U3'"),
        (raw(1, &header("|O", "(2, 2)"), &[0; 64]), "but its dtype is '|O"),
        (raw(1, &header("<f7", "(2, 2)"), &[0; 64]), "cannot be read as a .npy file"),
    ] {
        std::fs::write(&path, bytes).unwrap();
        let begun = std::time::Instant::now();
        let message = read_tactile(&path).unwrap_err().to_string();
        assert!(message.contains(expected) && !message.contains('\n'), "{message:?} lacks {expected:?}");
        assert!(begun.elapsed().as_secs() < 5, "{expected} took {:?}", begun.elapsed());
    }
}
