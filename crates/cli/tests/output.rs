//! Outputs against a real file system.

use std::fs;
use std::io::Write as _;
use std::os::unix::fs::{PermissionsExt as _, symlink};
use std::path::Path;

use pam_cli::{Output, OutputError, commit_all, write_file};

#[expect(clippy::unwrap_used, reason = "part of the tests below")]
fn names(folder: &Path) -> Vec<String> {
    let mut names: Vec<String> =
        fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

#[test]
fn a_reader_sees_the_old_content_until_the_commit() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("model.json");
    fs::write(&path, "old").unwrap();
    let mut output = Output::open(&path).unwrap();
    output.write_all(b"half of the new content").unwrap();
    assert_eq!(fs::read_to_string(&path).unwrap(), "old");
    output.finish().unwrap();
    assert_eq!(fs::read_to_string(&path).unwrap(), "half of the new content");
    assert_eq!(names(folder.path()), ["model.json"]);
}

#[test]
fn an_output_that_is_not_committed_leaves_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let mut output = Output::open(folder.path().join("a.csv")).unwrap();
    assert!(names(folder.path()).is_empty(), "opening leaves no file while the program computes");
    output.write_all(&vec![b'x'; 1 << 20]).unwrap();
    drop(output);
    assert!(names(folder.path()).is_empty());
}

#[test]
fn a_fresh_file_has_the_permissions_of_any_other_and_a_replaced_one_keeps_its_own() {
    let folder = tempfile::tempdir().unwrap();
    let mode = |name: &str| fs::metadata(folder.path().join(name)).unwrap().permissions().mode() & 0o7777;
    fs::write(folder.path().join("plain"), "").unwrap();
    write_file(folder.path().join("fresh"), "x").unwrap();
    assert_eq!(mode("fresh"), mode("plain"));
    fs::set_permissions(folder.path().join("plain"), fs::Permissions::from_mode(0o640)).unwrap();
    write_file(folder.path().join("plain"), "x").unwrap();
    assert_eq!(mode("plain"), 0o640);
}

#[test]
fn several_outputs_appear_together_or_not_at_all() {
    let folder = tempfile::tempdir().unwrap();
    let first = Output::open(folder.path().join("a.json")).unwrap();
    let full = Output::open("/dev/full").unwrap();
    let message = commit_all([(first, "{}"), (full, "{}")]).unwrap_err().to_string();
    assert_eq!(message, "cannot write /dev/full: no space left on the device; free some or name a path elsewhere");
    assert!(names(folder.path()).is_empty());

    let outputs = ["a.json", "b.csv"].map(|name| (Output::open(folder.path().join(name)).unwrap(), name));
    commit_all(outputs).unwrap();
    assert_eq!(names(folder.path()), ["a.json", "b.csv"]);
}

#[test]
fn what_is_no_regular_file_is_written_and_not_replaced() {
    write_file("/dev/null", "x").unwrap();
    assert!(!fs::metadata("/dev/null").unwrap().is_file());
    let folder = tempfile::tempdir().unwrap();
    let fifo = folder.path().join("fifo");
    assert!(std::process::Command::new("mkfifo").arg(&fifo).status().unwrap().success());
    let reader = std::thread::spawn({
        let fifo = fifo.clone();
        move || fs::read_to_string(fifo).unwrap()
    });
    write_file(&fifo, "through the pipe").unwrap();
    assert_eq!(reader.join().unwrap(), "through the pipe");
    assert_eq!(names(folder.path()), ["fifo"]);
}

#[test]
fn a_symbolic_link_is_followed_also_to_a_file_that_is_not_there_yet() {
    let folder = tempfile::tempdir().unwrap();
    fs::create_dir(folder.path().join("deep")).unwrap();
    let link = folder.path().join("link");
    symlink("deep/target", &link).unwrap();
    write_file(&link, "one").unwrap();
    write_file(&link, "two").unwrap();
    assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
    assert_eq!(fs::read_to_string(folder.path().join("deep/target")).unwrap(), "two");
    symlink("round", folder.path().join("round")).unwrap();
    assert!(Output::open(folder.path().join("round")).is_err());
}

#[test]
fn what_cannot_be_written_is_refused_before_the_work_with_the_way_out() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let message =
        |path: &Path| Output::open(path).unwrap_err().to_string().replace(folder.path().to_str().unwrap(), "F");
    fs::write(at("file"), "").unwrap();
    fs::write(at("kept"), "").unwrap();
    fs::set_permissions(at("kept"), fs::Permissions::from_mode(0o444)).unwrap();
    assert_eq!(message(folder.path()), "cannot write F: it is a folder; name a file inside it");
    assert_eq!(
        message(&at("no/such/x.json")),
        "cannot write F/no/such/x.json: folder F/no/such does not exist; create it with `mkdir -p F/no/such`"
    );
    assert_eq!(message(&at("file/x.json")), "cannot write F/file/x.json: F/file is not a folder; name another path");
    assert_eq!(message(&at("kept")), "cannot write F/kept: the file is read-only; make it writable or name another");
    assert!(message(&at(&"x".repeat(300))).contains("name too long"), "{}", message(&at(&"x".repeat(300))));
    assert!(Output::open("/proc/x.json").is_err());
    assert!(Output::open(at("new/")).is_err());
}

#[test]
fn a_name_as_long_as_the_system_allows_is_written() {
    let folder = tempfile::tempdir().unwrap();
    write_file(folder.path().join("x".repeat(255)), "long").unwrap();
}

#[test]
fn two_outputs_to_one_file_and_an_output_over_an_input_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.csv");
    fs::write(&path, "raw").unwrap();
    let first = Output::open(&path).unwrap();
    let roundabout = folder.path().join(".").join("a.csv");
    assert!(matches!(Output::open(&roundabout), Err(OutputError::NamedTwice { .. })));
    assert!(matches!(first.apart_from([&roundabout]), Err(OutputError::IsInput { .. })));
    assert!(Output::open(&path).unwrap().apart_from(["-", "elsewhere.csv"]).is_ok());
    assert_eq!(fs::read_to_string(&path).unwrap(), "raw");
}

#[test]
fn a_picture_in_a_format_that_is_not_written_is_refused_with_the_way_out() {
    let folder = tempfile::tempdir().unwrap();
    let refused = Output::open_figure(folder.path().join("fit.JPG")).unwrap_err();
    assert!(matches!(refused, OutputError::AnotherPicture { .. }), "{refused}");
    assert!(refused.to_string().contains("figures are SVG, PNG or PDF; name it "), "{refused}");
    let refused = Output::open(folder.path().join("model.PNG")).unwrap_err();
    assert!(matches!(refused, OutputError::IsPicture { .. }), "{refused}");
    assert!(Output::open_figure(folder.path().join("fit.PNG")).is_ok());
    assert!(names(folder.path()).is_empty());
}
