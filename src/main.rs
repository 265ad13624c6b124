//! stepwave
fn main() {}
