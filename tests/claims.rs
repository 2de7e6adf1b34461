//! `docs/shown/claims.md` leads from every claim and sentence of the paper to code and test that exist, and is the page that
//! `reproduce/claims.py` makes of the committed results.

use std::collections::BTreeSet;

use toml::{Table, Value};

use crate::support::folder::Folder;
use crate::support::repository::{read, repository};
use crate::support::said::Said;
use crate::support::tools::python;

/// Most words of a quotation.
const WORDS: usize = 15;

/// The tables of a kind in a file of `reproduce`.
fn tables(name: &str, kind: &str) -> Vec<Value> {
    let file: Table = read(format!("reproduce/{name}")).parse().unwrap();
    file[kind].as_array().unwrap().clone()
}

fn text<'a>(table: &'a Value, key: &str) -> &'a str {
    table[key].as_str().unwrap()
}

fn ids(claims: &[Value]) -> BTreeSet<String> {
    claims.iter().map(|claim| text(claim, "id").to_owned()).collect()
}

/// What is wrong with sentences: too long, tested by nothing without a reason, or by a claim that does not exist; and claims
/// that no sentence has.
fn faults(sentences: &[Value], claims: &BTreeSet<String>) -> Vec<String> {
    let mut faults = Vec::new();
    let mut left = claims.clone();
    for sentence in sentences {
        let quote = text(sentence, "quote");
        let tested: Vec<&str> =
            sentence["claims"].as_array().unwrap().iter().map(|id| id.as_str().unwrap()).collect();
        if quote.split_whitespace().count() > WORDS || (tested.is_empty() && sentence.get("why").is_none()) {
            faults.push(quote.to_owned());
        }
        faults.extend(tested.iter().filter(|id| !claims.contains(**id)).map(|&id| id.to_owned()));
        left.retain(|id| !tested.contains(&id.as_str()));
    }
    faults.into_iter().chain(left).collect()
}

#[test]
fn every_claim_is_a_sentence_of_the_paper_and_every_sentence_has_a_claim_or_a_reason() {
    let (sentences, claims) = (tables("claims.toml", "sentence"), ids(&tables("published.toml", "claim")));
    assert_eq!(faults(&sentences, &claims), [""; 0]);
    let wrong: Table =
        "[[sentence]]\nquote = \"a b c d e f g h i j k l m n o p\"\nclaims = [\"lost\"]\n[[sentence]]\nquote = \"q\"\nclaims = []"
            .parse()
            .unwrap();
    let found = faults(wrong["sentence"].as_array().unwrap(), &BTreeSet::from(["tree-accuracy".to_owned()]));
    assert_eq!(found, ["a b c d e f g h i j k l m n o p", "lost", "q", "tree-accuracy"]);
}

/// The text of a function, to the next test.
fn body<'a>(source: &'a str, function: &str) -> Option<&'a str> {
    let (_, rest) = source.split_once(&format!("fn {function}("))?;
    Some(rest.split("#[test]").next().unwrap())
}

#[test]
fn every_kind_of_measure_has_a_function_and_a_test_that_judges_such_a_claim() {
    let (measures, claims) = (tables("claims.toml", "measure"), tables("published.toml", "claim"));
    let tests = read("src/analysis/claims/tests.rs");
    let kind_of = |claim: &Value| text(&claim["measure"], "kind").to_owned();
    let kinds: BTreeSet<String> = measures.iter().map(|measure| text(measure, "kind").to_owned()).collect();
    assert_eq!(claims.iter().map(kind_of).collect::<BTreeSet<_>>(), kinds);
    for measure in &measures {
        let [kind, file, function, test] = ["kind", "file", "function", "test"].map(|key| text(measure, key));
        assert!(body(&read(format!("src/analysis/{file}")), function).is_some(), "{file} has no {function}");
        let judged = body(&tests, test).unwrap_or_else(|| panic!("no test {test}"));
        let of_kind = ids(&claims.iter().filter(|claim| kind_of(claim) == kind).cloned().collect::<Vec<_>>());
        assert!(of_kind.iter().any(|id| judged.contains(&format!("\"{id}\""))), "{test} judges no {kind}");
    }
    assert!(body(&tests, "no_such_test").is_none());
}

#[test]
fn the_page_is_that_of_the_committed_results() {
    let folder = Folder::new();
    let Some(mut script) = python(&repository("reproduce/claims.py")) else { return };
    script.arg("--check").arg(folder.at("claims.md"));
    let mut check = |page: &str| {
        folder.write("claims.md", page);
        Said::by(&mut script)
    };
    let page = read("docs/shown/claims.md");
    let said = check(&page);
    assert_eq!(said.status, Some(0), "{said:?}");
    let stale = page.replacen("**not reproduced**", "**reproduced**", 1);
    assert!(stale != page && check(&stale).status != Some(0), "another verdict");
}
