//! Exit codes, closed pipes and signals, each in a process of its own: this test is its own child.

#![expect(clippy::unwrap_used, reason = "a test without a harness is still a test")]

use std::fs;
use std::io::{Read as _, Write as _};
use std::path::PathBuf;
use std::process::{Child, Command, ExitCode, Output as Finished, Stdio};
use std::time::Duration;

use clap::Parser;
use pam_cli::{Output, Verdict};

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

/// What the child would write.
#[derive(schemars::JsonSchema)]
#[expect(dead_code, reason = "only its schema is used")]
struct Artifact {
    rmse_n: f64,
}

fn run(args: &Args) -> anyhow::Result<Verdict> {
    let console = args.run.start()?;
    console.note("a note\non two lines");
    console.warn("a warning");
    let mut output = Output::open(&args.out)?;
    match args.task.as_str() {
        "reject" => return Ok(Verdict::Rejected),
        "fail" => anyhow::bail!("first line\nsecond line"),
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
    for signal in ["INT", "TERM"] {
        let folder = tempfile::tempdir().unwrap();
        let out = folder.path().join("model.json");
        let mut child: Child = child(&["hang", "--out", out.to_str().unwrap()]).spawn().unwrap();
        while !out.with_extension("ready").exists() {
            std::thread::sleep(Duration::from_millis(5));
        }
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 2, "the temporary and the sign");
        let kill = Command::new("kill").args(["-s", signal, &child.id().to_string()]).status().unwrap();
        assert!(kill.success());
        assert_eq!(child.wait().unwrap().code(), Some(130));
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1, "only the sign");
    }
}

fn main() -> ExitCode {
    if std::env::var_os("PAM_CLI_TEST_CHILD").is_some() {
        return pam_cli::main_with_schema::<Args, Artifact>(run);
    }
    exit_codes_and_notes();
    schema_help_and_version_need_no_other_argument();
    a_closed_pipe_is_quiet_and_code_2();
    a_full_standard_output_is_one_line_and_code_2();
    a_signal_leaves_no_file_and_gives_130();
    ExitCode::SUCCESS
}
