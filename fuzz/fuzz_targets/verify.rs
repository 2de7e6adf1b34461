//! Fuzz the comparison of results: a table, its reference and a manifest, between zero bytes; what can be read must
//! agree with itself.

#![no_main]

use bodyschema::internals::verify::{Outcome, against_manifest, against_reference};
use bodyschema_fuzz::{accepted, file, folder};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|data: &[u8]| {
    let mut files = data.splitn(3, |byte| *byte == 0);
    for name in ["own/table.csv", "reference/table.csv", "manifested/manifest.json"] {
        file(name, files.next().unwrap_or_default());
    }
    let [own, reference, manifested] = ["own", "reference", "manifested"].map(|name| folder().join(name));
    accepted(against_manifest(&manifested));
    let findings = accepted(against_reference(&own, &reference)).into_iter().flatten();
    for line in findings.map(|finding| finding.to_string()) {
        assert!(line.lines().count() == 1, "{line:?}");
    }
    let itself = accepted(against_reference(&own, &own)).expect("bytes are the same, whatever they are");
    assert!(itself.iter().all(|finding| finding.outcome == Outcome::Same), "{itself:?}");
});
