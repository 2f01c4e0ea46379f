//! Lists the effects in C, a file each, so that a new one is a file and no line anywhere.

use std::path::Path;

const FOLDER: &str = "src/c/templates/effects";

fn main() -> std::io::Result<()> {
    println!("cargo::rerun-if-changed={FOLDER}");
    let mut names = Vec::new();
    for entry in std::fs::read_dir(FOLDER)? {
        names.extend(entry?.file_name().to_string_lossy().strip_suffix(".h").map(str::to_owned));
    }
    names.sort();
    let line = |name: &String| {
        format!("    ({name:?}, include_str!(concat!(env!(\"CARGO_MANIFEST_DIR\"), \"/{FOLDER}/{name}.h\"))),\n")
    };
    let lines: String = names.iter().map(line).collect();
    let out = std::env::var_os("OUT_DIR").unwrap_or_default();
    std::fs::write(Path::new(&out).join("effects.rs"), format!("&[\n{lines}]\n"))
}
