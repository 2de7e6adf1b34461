//! Fuzz the reader of recordings: tables, arrays and archives of them, with some options; what is accepted is cleaned.

#![no_main]

use bodyschema::files::FrontEnd;
use bodyschema::files::touch::{Column, Decimal, Format, Separator, TimeColumn, read_recorded};
use bodyschema::recording::Recording;
use bodyschema_fuzz::{accepted, file};
use libfuzzer_sys::fuzz_target;

/// Options by the bits of a byte.
fn format(bits: u8) -> Format {
    let is = |bit: u8| bits >> bit & 1 == 1;
    let separators = [None, Some(Separator::Semicolon), Some(Separator::Tab), Some(Separator::Blank)];
    Format {
        separator: separators[usize::from(bits & 3)],
        decimal: is(2).then_some(Decimal::Comma),
        header: is(3).then_some(is(4)),
        time: match bits >> 5 & 3 {
            1 => TimeColumn::None,
            2 => TimeColumn::Is(Column::of_word("2")),
            _ => TimeColumn::Guess,
        },
        leave_out: if is(7) { vec![Column::of_word("a")] } else { Vec::new() },
        array: None,
        front_end: FrontEnd::default(),
    }
}

fuzz_target!(|data: &[u8]| {
    let Some((&bits, bytes)) = data.split_first() else { return };
    let Some(recorded) = accepted(read_recorded(&file("touch", bytes), &format(bits))) else { return };
    let tactile = recorded.tactile;
    assert!(recorded.interval.is_none_or(|interval| interval > 0.0));
    assert!(tactile.sensors() > 0 && tactile.sensors() * tactile.samples == tactile.pressures.len());
    let recording = Recording::new(tactile);
    assert!(recording.tactile.pressures.iter().all(|pressure| !pressure.is_infinite()));
});
