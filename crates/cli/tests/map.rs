//! The map of the crates, `crates/README.md`, against the crates.

#![expect(clippy::unwrap_used, reason = "a test that fails may panic, and says what it measured")]

use std::fs;
use std::path::{Path, PathBuf};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").canonicalize().unwrap()
}

/// Folders of the crates, each with the name of its package.
fn crates() -> Vec<(String, String)> {
    let mut crates = Vec::new();
    for entry in fs::read_dir(root().join("crates")).unwrap() {
        let folder = entry.unwrap().path();
        let Ok(manifest) = fs::read_to_string(folder.join("Cargo.toml")) else { continue };
        let manifest: toml::Table = manifest.parse().unwrap();
        let name = manifest["package"]["name"].as_str().unwrap().to_owned();
        crates.push((folder.file_name().unwrap().to_str().unwrap().to_owned(), name));
    }
    assert!(crates.len() > 10, "{crates:?}");
    crates
}

#[test]
fn every_crate_is_on_the_map_under_its_name() {
    let map = fs::read_to_string(root().join("crates/README.md")).unwrap();
    let front = fs::read_to_string(root().join("README.md")).unwrap();
    assert!(front.contains("](crates/README.md)"), "README.md does not lead to the map");
    for (folder, package) in crates() {
        let row = map.lines().find(|line| line.starts_with('|') && line.contains(&format!("]({folder})")));
        let row = row.unwrap_or_else(|| panic!("crates/README.md has no row for crates/{folder}"));
        assert!(row.contains(&format!("`{package}`")), "crates/{folder} is the package {package}: {row}");
    }
}

/// Folders and files that the map names, in links and as `crate/src/path`, exist.
#[test]
fn what_the_map_points_to_exists() {
    let map = fs::read_to_string(root().join("crates/README.md")).unwrap();
    let folders: Vec<String> = crates().into_iter().map(|(folder, _)| folder).collect();
    let links = map.split("](").skip(1).filter_map(|rest| rest.split(')').next());
    let quoted = map.split('`').skip(1).step_by(2).filter(|word| {
        word.contains('/')
            && !word.contains(char::is_uppercase)
            && folders.iter().any(|f| word.split('/').next() == Some(f))
    });
    let mut n_seen = 0;
    for path in links.chain(quoted) {
        let place = root().join("crates").join(path);
        assert!(place.exists() || place.with_extension("rs").exists(), "crates/README.md names {path}");
        n_seen += 1;
    }
    assert!(n_seen > 20, "{n_seen} paths");
}
