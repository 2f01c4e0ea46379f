//! Exit codes, closed pipes and signals, each in a process of its own: this test is its own child.

#![expect(clippy::unwrap_used, reason = "a test without a harness is still a test")]

use std::fs;
use std::io::{Read as _, Write as _};
use std::path::PathBuf;
use std::process::{Child, Command, ExitCode, Output as Finished, Stdio};
use std::time::Duration;

use clap::Parser;
use pam_cli::{Output, Verdict};
use serde_json::json;

/// Schema of the lines for machines, as published.
const MESSAGES: &str = include_str!("../../artifact/schemas/pam-messages-1.json");

/// Arguments of the child.
#[derive(Debug, Parser)]
#[command(version)]
struct Args {
    #[command(flatten)]
    run: pam_cli::RunArgs,
    #[arg(long, default_value = "-")]
    out: PathBuf,
    /// What to do.
    task: String,
}

/// Schema of what the child would write.
const ARTIFACT: &str = r#"{ "properties": { "rmse_n": { "type": "number" } } }"#;

fn run(args: &Args) -> anyhow::Result<Verdict> {
    let console = args.run.start()?;
    console.note("a note\non two lines");
    console.warn("a warning");
    let mut output = Output::open(&args.out)?;
    match args.task.as_str() {
        "reject" => return Ok(Verdict::Rejected),
        "fail" => anyhow::bail!("first line\nsecond line"),
        "refuse" => anyhow::bail!("{}:3:14: no number", args.out.display()),
        "slow" => {
            console.text(" a   b\n───────\n 1   2\n");
            let bar = console.progress("waiting", 4);
            for _ in 0..3 {
                std::thread::sleep(Duration::from_millis(600));
                bar.advance(1);
            }
        }
        "panic" => {
            output.write_all(&vec![b'x'; 1 << 20])?;
            assert!(fs::read_dir(args.out.parent().unwrap())?.next().is_some(), "no temporary yet");
            rayon::join(|| panic!("a mistake of ours"), || ());
        }
        "threads" => output.commit(rayon_threads())?,
        "hang" => {
            output.write_all(&vec![b'x'; 1 << 20])?;
            fs::write(args.out.with_extension("ready"), "")?;
            std::thread::sleep(Duration::from_secs(60));
        }
        _ => {
            let bar = console.progress("writing", 1 << 12);
            for _ in 0..1 << 12 {
                output.write_all(&[b'x'; 256])?;
                bar.advance(1);
            }
            output.finish()?;
        }
    }
    Ok(Verdict::Accepted)
}

fn rayon_threads() -> String {
    rayon::current_num_threads().to_string()
}

fn child(arguments: &[&str]) -> Command {
    let mut command = Command::new(std::env::current_exe().unwrap());
    command.env("PAM_CLI_TEST_CHILD", "1").args(arguments).stdout(Stdio::piped()).stderr(Stdio::piped());
    command
}

fn finish(arguments: &[&str]) -> (Option<i32>, String, String) {
    let Finished { status, stdout, stderr } = child(arguments).output().unwrap();
    (status.code(), String::from_utf8(stdout).unwrap(), String::from_utf8(stderr).unwrap())
}

fn exit_codes_and_notes() {
    let notes = "note: a note on two lines\nwarning: a warning\n";
    let (code, stdout, stderr) = finish(&["write"]);
    assert_eq!((code, stdout.len(), stderr.as_str()), (Some(0), 1 << 20, notes));
    assert_eq!(finish(&["reject"]), (Some(1), String::new(), notes.to_owned()));
    assert_eq!(finish(&["fail", "--quiet"]), (Some(2), String::new(), "error: first line second line\n".to_owned()));
    assert_eq!(finish(&["threads", "--quiet", "--threads", "3"]), (Some(0), "3".to_owned(), String::new()));
    let (code, stdout, stderr) = finish(&["write", "--sed", "4"]);
    assert_eq!((code, stdout.as_str(), stderr.lines().count()), (Some(2), "", 1), "{stderr}");
}

/// Standard error of a run with `--format json`, line by line; every line obeys the published schema.
fn json_lines(arguments: &[&str], code: i32) -> Vec<serde_json::Value> {
    let schema = serde_json::from_str(MESSAGES).unwrap();
    let validator = jsonschema::validator_for(&schema).unwrap();
    let (status, _, stderr) = finish(arguments);
    assert_eq!(status, Some(code), "{stderr}");
    let lines = stderr.lines().map(|line| {
        let line: serde_json::Value = serde_json::from_str(line).unwrap();
        let errors: Vec<String> = validator.iter_errors(&line).map(|error| error.to_string()).collect();
        assert!(errors.is_empty(), "{line}: {errors:?}");
        line
    });
    lines.collect()
}

fn machines_get_json_lines() {
    let note = json!({"level": "note", "message": "a note on two lines"});
    let warning = json!({"level": "warning", "message": "a warning"});
    assert_eq!(json_lines(&["reject", "--format", "json"], 1), [note.clone(), warning.clone()]);
    assert!(json_lines(&["reject", "--format=json", "--quiet"], 1).is_empty());

    let lines = json_lines(&["slow", "--format", "json"], 0);
    assert_eq!(lines[2], json!({"level": "table", "message": " a   b\n───────\n 1   2"}));
    // Once a second has passed, and where it stopped.
    let (last, earlier) = lines[3..].split_last().unwrap();
    let of = |key: &str| last[key].clone();
    assert_eq!(
        [of("level"), of("task"), of("done"), of("total")],
        [json!("progress"), json!("waiting"), json!(3), json!(4)]
    );
    assert!(!earlier.is_empty() && earlier[0]["seconds_left"].as_f64().unwrap() > 0.0, "{lines:?}");

    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("model.json");
    let path = path.to_str().unwrap();
    let error =
        json!({"level": "error", "message": format!("{path}:3:14: no number"), "path": path, "line": 3, "column": 14});
    assert_eq!(json_lines(&["refuse", "--format", "json", "--out", path, "--quiet"], 2), [error]);
    // A command line that cannot be understood says so in the form that it asks for.
    let lines = json_lines(&["write", "--sed", "4", "--format", "json"], 2);
    assert_eq!((lines.len(), &lines[0]["level"]), (1, &json!("error")));
    let (_, schema, _) = finish(&["--schema=messages"]);
    assert!(schema == MESSAGES, "the published schema is stale; run scripts/schemas");
}

fn completions_and_the_manual_page_are_printed() {
    for (shell, word) in [("bash", "complete -F"), ("zsh", "#compdef"), ("fish", "complete -c")] {
        let (code, script, stderr) = finish(&["--completions", shell]);
        assert_eq!((code, stderr.as_str()), (Some(0), ""));
        assert!(script.contains(word) && script.contains("threads") && script.contains("pam-cli"), "{script}");
    }
    let (code, page, _) = finish(&["--man"]);
    assert_eq!(code, Some(0));
    assert!(page.contains(".SH SYNOPSIS") && page.contains("Seed of every random draw"), "{page}");
}

fn schema_help_and_version_need_no_other_argument() {
    let (code, stdout, stderr) = finish(&["--schema"]);
    assert_eq!((code, stderr.as_str()), (Some(0), ""));
    let schema: serde_json::Value = serde_json::from_str(&stdout).unwrap();
    assert_eq!(schema["properties"]["rmse_n"]["type"], "number");
    let (code, stdout, _) = finish(&["--help"]);
    assert_eq!(code, Some(0));
    assert!(stdout.contains("--schema"), "{stdout}");
    assert_eq!(finish(&["--version"]).0, Some(0));
}

fn a_closed_pipe_is_quiet_and_code_2() {
    let mut child = child(&["write", "--quiet"]).spawn().unwrap();
    drop(child.stdout.take());
    let mut stderr = String::new();
    child.stderr.take().unwrap().read_to_string(&mut stderr).unwrap();
    assert_eq!(child.wait().unwrap().code(), Some(2));
    assert_eq!(stderr, "");
}

fn a_full_standard_output_is_one_line_and_code_2() {
    let full = fs::OpenOptions::new().write(true).open("/dev/full").unwrap();
    for arguments in [&["write", "--quiet"][..], &["--schema"]] {
        let Finished { status, stderr, .. } = child(arguments).stdout(full.try_clone().unwrap()).output().unwrap();
        assert_eq!(status.code(), Some(2));
        let expected =
            "error: cannot write standard output: no space left on the device; free some or name a path elsewhere\n";
        assert_eq!(String::from_utf8(stderr).unwrap(), expected);
    }
}

fn a_signal_leaves_no_file_and_gives_130() {
    if hang_ups_are_ignored() {
        return;
    }
    // All that end a program by themselves and are no fault of its own, but KILL, which nothing can answer.
    let everywhere = ["INT", "TERM", "HUP", "QUIT", "XCPU", "ALRM", "VTALRM", "PROF", "USR1", "USR2", "IO"];
    let on_linux: &[&str] = if cfg!(target_os = "linux") { &["PWR", "STKFLT"] } else { &[] };
    for signal in everywhere.iter().chain(on_linux) {
        let folder = tempfile::tempdir().unwrap();
        let out = folder.path().join("model.json");
        let mut child: Child = child(&["hang", "--out", out.to_str().unwrap()]).spawn().unwrap();
        while !out.with_extension("ready").exists() {
            std::thread::sleep(Duration::from_millis(5));
        }
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 2, "the temporary and the sign");
        let kill = Command::new("kill").args(["-s", *signal, &child.id().to_string()]).status().unwrap();
        assert!(kill.success());
        assert_eq!(child.wait().unwrap().code(), Some(130), "SIG{signal}");
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1, "only the sign");
    }
}

/// Under nohup a program answers no signals; said, so that a skipped test shows.
#[expect(clippy::print_stderr, reason = "a skipped test must be seen")]
fn hang_ups_are_ignored() -> bool {
    let alive = Command::new("sh").args(["-c", "kill -s HUP $$; echo alive"]).output().unwrap().stdout;
    if !alive.is_empty() {
        eprintln!("skipped: signals are not answered where hang-ups are ignored, as under nohup");
    }
    !alive.is_empty()
}

fn a_file_beyond_the_limit_of_the_system_is_one_line_and_leaves_nothing() {
    if hang_ups_are_ignored() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("model.json");
    // The system sends a signal that ends a program which does not expect it.
    let finished = Command::new("sh")
        .args(["-c", "ulimit -f 8; exec \"$0\" write --quiet --out \"$1\""])
        .args([std::env::current_exe().unwrap(), out.clone()])
        .env("PAM_CLI_TEST_CHILD", "1")
        .output()
        .unwrap();
    let stderr = String::from_utf8(finished.stderr).unwrap();
    assert_eq!(finished.status.code(), Some(2), "{stderr}");
    assert!(stderr.contains("no space left") && stderr.matches("cannot write").count() == 1, "{stderr}");
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
}

fn a_panic_leaves_no_file_and_gives_101() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("model.json");
    let (code, _, stderr) = finish(&["panic", "--out", out.to_str().unwrap()]);
    assert_eq!(code, Some(101));
    assert!(stderr.contains("a mistake of ours"), "{stderr}");
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
}

fn main() -> ExitCode {
    if std::env::var_os("PAM_CLI_TEST_CHILD").is_some() {
        return pam_cli::main_with_schema::<Args>(ARTIFACT, run);
    }
    exit_codes_and_notes();
    machines_get_json_lines();
    completions_and_the_manual_page_are_printed();
    schema_help_and_version_need_no_other_argument();
    a_closed_pipe_is_quiet_and_code_2();
    a_full_standard_output_is_one_line_and_code_2();
    a_signal_leaves_no_file_and_gives_130();
    a_file_beyond_the_limit_of_the_system_is_one_line_and_leaves_nothing();
    a_panic_leaves_no_file_and_gives_101();
    ExitCode::SUCCESS
}
