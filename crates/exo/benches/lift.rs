//! Speed of lifts.

fn main() {
    divan::main();
}
