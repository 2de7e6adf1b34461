//! Show what an experiment found: tables and pictures of the paper's figures, the table of claims, and a page.

pub mod claims_table;
pub mod estimated;
pub mod figure_rows;
pub mod figures;
pub mod headline;
pub mod markdown;
pub mod numbers;
pub mod overview;
pub mod page;
pub mod plot;
pub mod ranges;
pub mod text_tree;
pub mod viewer;
