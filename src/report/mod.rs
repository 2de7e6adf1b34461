//! Show what an experiment found: tables and pictures of the paper's figures, the table of claims, and a page.

pub(crate) mod claims_table;
pub(crate) mod document;
pub(crate) mod estimated;
pub(crate) mod figure_rows;
pub(crate) mod figures;
pub(crate) mod headline;
pub mod markdown;
pub(crate) mod numbers;
pub(crate) mod overview;
pub(crate) mod page;
pub mod plot;
pub(crate) mod ranges;
pub(crate) mod text_tree;
pub(crate) mod viewer;
