//! A number and a table of the figure of that number; or after the last number claims.csv and manifest.json, between zero
//! bytes.

#![no_main]

use std::fs;

use bodyschema::internals::{Page, figures, plot};
use bodyschema_fuzz::{accepted, file, folder};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|data: &[u8]| {
    let Some((&number, rest)) = data.split_first() else { return };
    let figures = figures();
    match figures.get(usize::from(number) % (figures.len() + 1)) {
        Some(figure) => {
            let table = file(&format!("figures/{}.csv", figure.name), rest);
            if let Some(pictures) = accepted(plot::render(&folder().join("figures"))) {
                assert!(pictures.iter().map(|picture| &picture.name).eq([&figure.name]));
                let picture = table.with_extension("svg");
                let svg = fs::read_to_string(&picture).expect("it was drawn");
                assert!(svg.starts_with("<svg") && svg.trim_end().ends_with("</svg>"));
                fs::remove_file(picture).expect("it was drawn");
            }
            fs::remove_file(table).expect("it was there");
        }
        None => {
            let mut files = rest.splitn(2, |byte| *byte == 0);
            file("claims.csv", files.next().unwrap_or_default());
            file("manifest.json", files.next().unwrap_or_default());
            accepted(Page::read(folder()).and_then(|page| page.write(folder())));
        }
    }
});
