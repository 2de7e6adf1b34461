//! Compare named configurations by the paper's claims: a page, two pictures and a table.

mod design;
mod page;
mod run;
mod table;

pub use self::design::Design;
pub use self::run::{compare, is_comparison, redraw};
