//! Test which separators and decimals are guessed.

use super::*;

fn guess(text: &str) -> (Separator, Decimal, bool) {
    let Dialect { separator, decimal, is_guess } = Dialect::of(text.as_bytes(), &Format::default());
    (separator, decimal, is_guess)
}

#[test]
fn separators_and_decimals_are_guessed() {
    use Decimal::{Comma as C, Point as P};
    for (text, expected) in [
        ("a,b\n1.5,2\n3,4\n5,6\n", (Separator::Comma, P, false)),
        ("1, 5\n3, 4\n5, 6\n", (Separator::Comma, P, false)),
        ("a;b\n1.5;2\n3;4\n5;6\n", (Separator::Semicolon, P, true)),
        ("a;b\r\n1,5;2\r\n3;4,25\r\n5;6\r\n", (Separator::Semicolon, C, true)),
        (
            "Zeit;a\n01.05.2024 12:00;2,5\n01.05.2024 12:01;3,5\n01.05.2024 12:02;3,5\n",
            (Separator::Semicolon, C, true),
        ),
        ("a\tb\n1.5\t2\n3\t4\n5\t6\n", (Separator::Tab, P, true)),
        ("1,5\t2\n3\t4\n5\t6\n", (Separator::Tab, C, true)),
        ("1.5  2\n3   4\n5 6\n", (Separator::Blank, P, true)),
        ("1,5 2,5\n3,5 4\n5 6,5\n", (Separator::Blank, C, true)),
        ("\"1,5\",\"2,5\"\n\"3\",\"4\"\n\"1,5\",\"2,5\"\n\"1\",\"2\"\n", (Separator::Comma, C, true)),
        ("# a b\n1.5e-3 2\n3 4\n5 6\n", (Separator::Blank, P, true)),
        ("7\n8\n9\n", (Separator::Comma, P, false)),
        ("", (Separator::Comma, P, false)),
        ("\u{fffd},,\"", (Separator::Comma, P, false)),
    ] {
        assert_eq!(guess(text), expected, "{text:?}");
    }
}

#[test]
fn what_is_said_is_not_guessed() {
    let format =
        Format { separator: Some(Separator::Semicolon), decimal: Some(Decimal::Point), ..Format::default() };
    let found = Dialect::of(b"1,5 2\n3,5 4\n", &format);
    assert_eq!(found, Dialect { separator: Separator::Semicolon, decimal: Decimal::Point, is_guess: false });
}
