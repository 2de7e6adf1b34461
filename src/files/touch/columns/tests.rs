//! Test which columns are no sensors.

use super::*;

fn names(names: &[&str]) -> Vec<String> {
    names.iter().map(ToString::to_string).collect()
}

fn columns(own: &[&str], format: &Format) -> Result<Columns, String> {
    Columns::new(Path::new("t.csv"), own.len(), names(own), format).map_err(|error| error.to_string())
}

#[test]
fn two_clocks_are_both_left_out_and_both_said() {
    let format = Format { leave_out: vec![Column::of_word("id")], ..Format::default() };
    let found = columns(&["%time", "seq", "id", "left"], &format).unwrap();
    assert_eq!((&found.times[..], &found.left_out[..]), (&[0][..], &[true, false, true, false][..]));
    let even = |step: f64| (0..50).map(|t| step * f64::from(t)).collect::<Vec<_>>();
    let found = found.found(&[(0, even(0.25)), (1, even(1.0)), (3, vec![0.0; 50])], false, &format);
    assert_eq!((found.left_out, found.interval), (vec![0, 1, 2], Some(0.25)));
    assert_eq!(
        found.guesses,
        [
            "column 1 (`%time`) is taken for the time by its name, and is no sensor (interval 0.25 s); --time none counts it as one",
            "column 2 (`seq`) counts the rows, and is no sensor; --time none counts it as one",
        ]
    );
}

#[test]
fn what_the_user_says_counts() {
    let even: Vec<f64> = (0..50).map(f64::from).collect();
    let said = |time| Format { time, ..Format::default() };
    let none = said(TimeColumn::None);
    let found = columns(&["time", "a"], &none).unwrap().found(&[(0, even.clone())], false, &none);
    assert_eq!(found, Found::default());
    let second = said(TimeColumn::Is(Column::of_word("2")));
    let found = columns(&["time", "a"], &second).unwrap().found(&[(1, even)], false, &second);
    assert_eq!(found, Found { left_out: vec![1], interval: Some(1.0), guesses: Vec::new() });
    let message = columns(&["a", "b"], &said(TimeColumn::Is(Column::of_word("c")))).err().unwrap();
    assert!(message.contains("t.csv: has no column `c`; --time takes a name"), "{message}");
    // A name that is a number, and a number that is a name.
    let counted = names(&["2", "1"]);
    let place =
        |number, name: Option<&str>| place(&Column { number, name: name.map(str::to_owned) }, &counted, 2);
    assert_eq!(
        (place(Some(1), None), place(None, Some("1")), place(Some(1), Some("1"))),
        (Some(0), Some(1), Some(0))
    );
    assert_eq!((place(Some(3), None), place(Some(0), None), place(None, Some("3"))), (None, None, None));
}
