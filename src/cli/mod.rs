pub mod compare;
pub mod merge;
