//! Record a protocol on a virtual bench.

fn main() {}
