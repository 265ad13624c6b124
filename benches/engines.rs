//! How fast each engine runs each model: `cargo bench --bench engines [NAME]`.
fn main() {}
