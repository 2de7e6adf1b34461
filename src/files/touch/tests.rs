//! Test files as people have them, and as nobody should.

use std::io::{Cursor, Write};
use std::path::PathBuf;

use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipWriter};

use super::*;

/// A file in a folder of its own.
struct File {
    _folder: tempfile::TempDir,
    path: PathBuf,
}

fn file(name: &str, bytes: impl AsRef<[u8]>) -> File {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    std::fs::write(&path, bytes).unwrap();
    File { _folder: folder, path }
}

fn read_as(bytes: impl AsRef<[u8]>, format: &Format) -> Result<Recorded, String> {
    read_recorded(&file("touch.csv", bytes).path, format).map_err(|error| error.to_string())
}

fn read(bytes: impl AsRef<[u8]>) -> Result<Recorded, String> {
    read_as(bytes, &Format::default())
}

/// Pressures by sample.
fn by_time(recorded: &Recorded) -> Vec<f32> {
    let series: Vec<&[f32]> = recorded.tactile.series().collect();
    (0..recorded.tactile.samples).flat_map(|t| series.iter().map(move |own| own[t])).collect()
}

#[test]
fn a_table_is_the_same_however_it_is_written() {
    let expected = [1.5, -2.0, 3.0, 40.0, 5.25, 6.0];
    for text in [
        "a,b\n1.5,-2\n3,4e1\n5.25,6\n",
        "1.5,-2\n3, 40\n5.25,6\n",
        "a;b\r\n1,5;-2\r\n3;40\r\n5,25;6\r\n",
        "\u{feff}a;b;\r\n1,5;-2;\r\n3;40;\r\n5,25;6;\r\n",
        "a\tb\n1.5\t-2\n3\t40\n5.25\t6\n",
        "# made by a robot\n# a b\n  1.5  -2\n3   40\n\n   \n5.25 6\n",
        "1,5 -2\n3 40\n5,25 6\n",
        "\"a\",\"b\"\n\"1,5\",\"-2\"\n\"3\",\"40\"\n\"5,25\",\"6\"\n",
        "%a,b\r1.5,-2\r3,40\r5.25,6",
    ] {
        let found = read(text).unwrap_or_else(|error| panic!("{text:?}: {error}"));
        assert_eq!(by_time(&found), expected, "{text:?}");
        let is_guess = !text.contains("1.5,-2");
        assert_eq!(found.guesses.len(), usize::from(is_guess), "{text:?}: {:?}", found.guesses);
        let units: Vec<u8> = text.encode_utf16().flat_map(u16::to_le_bytes).collect();
        assert_eq!(by_time(&read([b"\xFF\xFE", &units[..]].concat()).unwrap()), expected);
    }
    let holes = read("1,,nan,NA\n4,5,inf,true\n").unwrap();
    assert!(by_time(&holes)[1..4].iter().all(|value| value.is_nan()));
    assert_eq!(by_time(&holes)[4..], [4.0, 5.0, f32::INFINITY, 1.0]);
    // Letters of any encoding.
    assert_eq!(by_time(&read(b"gr\xF6\xDFe,b\n1,2\n").unwrap()), [1.0, 2.0]);
}

/// A table of three sensors that starts with some columns, which `columns` gives.
fn table(names: &str, columns: impl Fn(usize) -> String) -> String {
    let sensor = |t: usize, sensor: usize| (0.1 * (t * (sensor + 1)) as f64).sin().max(0.0);
    let row =
        |t: usize| format!("{}{:.4},{:.4},{:.4}\n", columns(t), sensor(t, 0), sensor(t, 1), sensor(t, 2));
    format!("{names}{}", (0..100).map(row).collect::<String>())
}

#[test]
fn a_column_of_times_is_no_sensor_and_gives_the_interval() {
    for (names, first, interval) in [
        ("time,a,b,c\n", "0.02", Some(0.02)),
        ("%time,a,b,c\n", "20000000", Some(2e7)),
        ("stamp,a,b,c\n", "1.7e9", Some(1.0)),
        ("t [ms],a,b,c\n", "20", Some(0.02)),
        ("", "0.125", Some(0.125)),
        ("n,a,b,c\n", "1", None),
        (",0,1,2\n", "1", None),
        ("Zeit,a,b,c\n", "x", None),
    ] {
        let time = |t: usize| match first {
            "x" => format!("2024-05-01 12:00:{t:02},"),
            "1.7e9" => format!("{},", 1_700_000_000 + t),
            step => format!("{},", step.parse::<f64>().unwrap() * t as f64),
        };
        let found = read(table(names, time)).unwrap();
        assert_eq!((found.tactile.samples, found.tactile.sensors()), (100, 3), "{names}{first}");
        assert!(found.interval.zip(interval).is_none_or(|(found, own)| (found - own).abs() < 1e-9 * own));
        assert_eq!(found.interval.is_some(), interval.is_some(), "{names}{first}");
        let told = found.guesses.last().unwrap();
        assert!(told.starts_with("column 1") && told.contains("--time none"), "{told}");
        // It can be said that it is one, or that none is.
        let none = Format { time: TimeColumn::None, header: Some(!names.is_empty()), ..Format::default() };
        let all = read_as(table(names, time), &none);
        match first {
            "x" => assert!(all.unwrap_err().contains("say --time 1"), "a date is no number"),
            _ => assert_eq!((all.as_ref().unwrap().tactile.sensors(), all.unwrap().guesses.len()), (4, 0)),
        }
        let first = Format { time: TimeColumn::Is(Column::of_word("1")), ..Format::default() };
        assert_eq!(read_as(table(names, time), &first).unwrap().tactile, found.tactile);
    }
    let two = read(table("%time,field.seq,field.stamp,field.id,a,b,c\n", |t| {
        format!("{t}e8,{},{t}e8,skin,", t + 7)
    }));
    assert!(
        two.unwrap_err().contains("row 2, column 4 (`field.id`): `skin` is not a number; empty the cell")
    );
    let format = Format { leave_out: vec![Column::of_word("field.id")], ..Format::default() };
    let two =
        table("%time,field.seq,field.stamp,field.id,a,b,c\n", |t| format!("{t}e8,{},{t}e8,skin,", t + 7));
    let found = read_as(two, &format).unwrap();
    assert_eq!((found.tactile.sensors(), found.guesses.len()), (3, 3), "{:?}", found.guesses);
    // A counter that begins again, and one that jumps: what rises evenly for the most part is no sensor.
    assert_eq!(read(table("", |t| format!("{},", 100 * (t % 60)))).unwrap().tactile.sensors(), 3);
    // What rises, but not evenly, and what is short, may be one.
    assert_eq!(read(table("", |t| format!("{},", t * t))).unwrap().tactile.sensors(), 4);
    assert_eq!(read("1,0.5\n2,0\n3,0.5\n").unwrap().tactile.sensors(), 2);
}

#[test]
fn what_is_no_table_of_numbers_is_named_with_its_place_and_what_helps() {
    let long = format!("a,b\n{}1,x\n", "1,2\n".repeat(100));
    for (text, expected) in [
        (
            "1,2\n3,x\n",
            "row 2, column 2: `x` is not a number; empty the cell if a value is missing, or say --leave-out 2",
        ),
        (&long, "row 102, column 2 (`b`): `x`"),
        ("a,b\n1,2\n3\n", "row 3 has 1 cells, but the first row of numbers has 2; repair or delete the row"),
        ("a,b\n1,2,3\n", "row 2 has 3 cells, but the row of names has 2"),
        ("a,b\n1,5,2,5\n3,5,4,5\n", "if commas are decimal ones, write the table with `;` between cells"),
        ("1,05,2,75\n3,25,4,00\n", "row 1, column 2: `05` seems to be the decimals of the cell before"),
        (
            "a;b\n1,5;2\n3;4\n5;1.234,5\n",
            "row 4, column 2 (`b`): `1.234,5` is not a number; decimals have commas here",
        ),
        (
            "12:00:01,1\n12:00:02,2\n",
            "row 1, column 1: `12:00:01` is not a number; if it is a time, say --time 1",
        ),
        (
            "1,2\n3;4,5\n5,6\n7,8\n",
            "row 2, column 1: `3;4` is not a number; if `;` is between cells, say --separator",
        ),
        ("1,2\n3,\0\n", "row 2, column 2: `\u{fffd}` is not a number"),
        ("1,2\n\"3,4\n5,6\n", "row 2 has 1 cells"),
        (
            "1 2\n3 4\n5\n6 7\n",
            "row 3 has 1 cells, but the first row of numbers has 2; write nan where a value is missing",
        ),
        ("a,b\n", "has no row of numbers"),
        ("time\n1\n2\n", "has no column of a sensor"),
        ("# a\n", "has no row of numbers"),
        ("\n\n", "has no row of numbers"),
        ("", "is empty"),
        ("{\"a\": [1, 2]}", "has no row of numbers"),
        ("a\nb\n", "row 2, column 1 (`a`): `b` is not a number"),
    ] {
        let message = read(text).unwrap_err();
        assert!(message.contains(expected) && !message.contains('\n'), "{text:?}: {message}");
    }
    let wide = vec!["1"; 30_000].join(",");
    assert!(read(wide).unwrap_err().contains("is it transposed?"));
    let point = Format { decimal: Some(Decimal::Point), ..Format::default() };
    assert_eq!(read_as("1,05,2,75\n", &point).unwrap().tactile.sensors(), 4);
    let message = read_as("1,2\n", &Format { array: Some("x".to_owned()), ..Format::default() }).unwrap_err();
    assert!(message.contains("is no .npz archive"), "{message}");
    let absent = Format { time: TimeColumn::Is(Column::of_word("5")), ..Format::default() };
    assert!(read_as("1,2\n", &absent).unwrap_err().contains("has no column `5`; --time takes a name"));
    let folder = tempfile::tempdir().unwrap();
    assert!(read_recorded(folder.path(), &point).unwrap_err().to_string().contains("is a folder"));
}

/// A `.npy` file of a type, in C or Fortran order, that states this shape.
fn npy(dtype: &str, fortran: bool, shape: &str, data: &[u8]) -> Vec<u8> {
    let order = if fortran { "True" } else { "False" };
    let header = format!("{{'descr': '{dtype}', 'fortran_order': {order}, 'shape': {shape}, }}\n");
    [&b"\x93NUMPY\x01\x00"[..], &(header.len() as u16).to_le_bytes(), header.as_bytes(), data].concat()
}

/// Times since 1970, and two sensors: 50 × 3.
fn with_clock(fortran: bool) -> Vec<u8> {
    let value = |t: usize, column: usize| match column {
        0 => 1.7e9 + 0.1 * t as f64,
        _ => (0.1 * (t * column) as f64).sin().max(0.0),
    };
    let all: Vec<(usize, usize)> = match fortran {
        true => (0..3).flat_map(|column| (0..50).map(move |t| (t, column))).collect(),
        false => (0..50).flat_map(|t| (0..3).map(move |column| (t, column))).collect(),
    };
    let data: Vec<u8> = all.into_iter().flat_map(|(t, column)| value(t, column).to_be_bytes()).collect();
    npy(">f8", fortran, "(50, 3)", &data)
}

#[test]
fn times_in_an_array_are_told_with_all_their_digits() {
    for fortran in [false, true] {
        let found = read(with_clock(fortran)).unwrap();
        assert_eq!((found.tactile.samples, found.tactile.sensors()), (50, 2));
        assert!((found.interval.unwrap() - 0.1).abs() < 1e-6, "{found:?}");
        let none = Format { time: TimeColumn::None, ..Format::default() };
        assert_eq!(read_as(with_clock(fortran), &none).unwrap().tactile.sensors(), 3);
    }
    let counts: Vec<u8> = (0..40_u8).flat_map(|t| [t, u8::from(t % 3 == 0)]).collect();
    let found = read(npy("|u1", false, "(40, 2)", &counts)).unwrap();
    assert_eq!((found.tactile.sensors(), found.interval), (1, None));
    let pads: Vec<u8> = (0..40_u8).map(|at| at % 2).collect();
    assert_eq!(read(npy("|b1", false, "(20, 2)", &pads)).unwrap().tactile.sensors(), 2);
}

/// An archive of arrays, packed or not.
fn npz(arrays: &[(&str, Vec<u8>)], method: CompressionMethod) -> Vec<u8> {
    let mut archive = ZipWriter::new(Cursor::new(Vec::new()));
    for (name, bytes) in arrays {
        archive.start_file(*name, SimpleFileOptions::default().compression_method(method)).unwrap();
        archive.write_all(bytes).unwrap();
    }
    archive.finish().unwrap().into_inner()
}

#[test]
fn an_array_of_an_archive_is_read_and_others_are_named() {
    let own = || npy("<f4", false, "(2, 2)", &[0; 16]);
    for method in [CompressionMethod::Stored, CompressionMethod::Deflated] {
        let one =
            read(npz(&[("tactile.npy", with_clock(false)), ("notes.txt", b"x".to_vec())], method)).unwrap();
        assert_eq!((one.tactile.sensors(), one.guesses.len()), (2, 1));
        let two = npz(&[("a.npy", own()), ("b.npy", with_clock(true))], method);
        let message = read(&two).unwrap_err();
        assert!(message.contains("holds 2 arrays; say which with --array, one of: a, b"), "{message}");
        let second = |name: &str| Format { array: Some(name.to_owned()), ..Format::default() };
        assert_eq!(read_as(&two, &second("b")).unwrap().tactile.samples, 50);
        assert!(
            read_as(&two, &second("c")).unwrap_err().contains("has no array `c`; --array takes one of: a, b")
        );
        for end in [two.len() / 2, two.len() - 1] {
            assert!(read(&two[..end]).unwrap_err().contains("cannot be read as an .npz archive"));
        }
    }
    let text = npz(&[("a.npy", b"1,2\n".to_vec())], CompressionMethod::Stored);
    assert!(read(text).unwrap_err().contains("cannot be read as a .npy file"));
    assert!(read(npz(&[], CompressionMethod::Stored)).unwrap_err().contains("holds no array"));
    assert!(read(b"PK\x03\x04").unwrap_err().contains("cannot be read as an .npz archive"));
}

#[test]
fn an_archive_cannot_state_more_than_it_holds() {
    let large = npz(&[("a.npy", npy("<f8", false, "(99999999, 9)", &[0; 64]))], CompressionMethod::Deflated);
    assert!(read(large).unwrap_err().contains("is truncated: its header states 99999999 x 9 values"));
    // The size of the entry is a lie, too: eight bytes before the end of each of its two headers.
    let mut lies = npz(&[("a.npy", npy("<f8", false, "(99999999, 9)", &[0; 64]))], CompressionMethod::Stored);
    let real = (lies.windows(5).position(|part| part == b"a.npy").unwrap() - 8)..;
    let size = lies[real.start..real.start + 4].to_vec();
    let places: Vec<usize> = (0..lies.len() - 4).filter(|at| lies[*at..*at + 4] == size[..]).collect();
    places.into_iter().for_each(|at| lies[at..at + 4].copy_from_slice(&0xFFFF_FFF0_u32.to_le_bytes()));
    let message = read(lies).unwrap_err();
    assert!(message.contains("cannot") || message.contains("truncated"), "{message}");
}

#[test]
fn a_pipe_is_read_as_a_file_is() {
    let bytes = [
        with_clock(false),
        npz(&[("a.npy", with_clock(true))], CompressionMethod::Deflated),
        b"1;2,5\n3;4\n".to_vec(),
    ];
    for bytes in bytes {
        let expected = read(&bytes).unwrap();
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("pipe");
        let made = std::process::Command::new("mkfifo").arg(&path).status().unwrap();
        assert!(made.success());
        let writer = std::thread::spawn({
            let path = path.clone();
            move || std::fs::write(path, bytes).unwrap()
        });
        assert_eq!(read_recorded(&path, &Format::default()).unwrap(), expected);
        writer.join().unwrap();
    }
}

#[test]
fn a_name_that_promises_an_array_is_taken_at_its_word() {
    for (name, expected) in
        [("t.npy", "cannot be read as a .npy file"), ("t.npz", "cannot be read as an .npz archive")]
    {
        let message = read_recorded(&file(name, "1,2\n").path, &Format::default()).unwrap_err().to_string();
        assert!(message.contains(expected), "{message}");
    }
    // Whatever its name, an array is one.
    assert_eq!(read_touch(&file("t.dat", with_clock(false)).path).unwrap().sensors(), 2);
}
