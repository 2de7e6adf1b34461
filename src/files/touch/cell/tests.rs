//! Test how cells are read.

use super::*;

#[test]
fn numbers_are_read_as_programs_write_them() {
    let read = |cell: &str, decimal| number(cell.as_bytes(), decimal);
    for (cell, expected) in
        [("1.5", 1.5), ("-2", -2.0), ("+4e1", 40.0), ("True", 1.0), ("false", 0.0), ("inf", f32::INFINITY)]
    {
        assert_eq!(read(cell, Decimal::Point), Some(expected), "{cell}");
    }
    for cell in ["", "NaN", "nan", "NA", "N/A", "null", "-nan(ind)"] {
        assert!(read(cell, Decimal::Point).unwrap().is_nan() && read(cell, Decimal::Comma).unwrap().is_nan());
    }
    for (cell, expected) in [("1,5", 1.5), ("-2", -2.0), ("1,5E-1", 0.15), ("-inf", f32::NEG_INFINITY)] {
        assert_eq!(read(cell, Decimal::Comma), Some(expected), "{cell}");
    }
    for cell in ["1,5", "x", "1.2.3", "1 2", "0x1f", "\u{2212}1", "1\0", "."] {
        assert_eq!(read(cell, Decimal::Point), None, "{cell}");
    }
    for cell in ["1.5", "1.234,5", "1,2,3"] {
        assert_eq!(read(cell, Decimal::Comma), None, "{cell}");
    }
    assert_eq!(number(b"\xFF", Decimal::Point), None);
    assert_eq!(exact(b"1700000000,125", Decimal::Comma), Some(1_700_000_000.125));
}

#[test]
fn dates_are_told_from_names() {
    assert!(
        ["12:00:00.5", "2024-05-01T12:00:00Z", "01.05.2024 12:00"]
            .iter()
            .all(|cell| is_date(cell.as_bytes()))
    );
    assert!(["left_0", "1st pad", "", "-3", "a:b", "12"].iter().all(|cell| !is_date(cell.as_bytes())));
}
