//! The diagnosis goes by physics alone: other names and another order of the recordings change nothing.

#![expect(clippy::print_stdout, clippy::unwrap_used, reason = "a test may panic, and says where it was skipped")]

use std::path::Path;

use pam_artifact::DiagnosisArtifact;
use pam_artifact::diagnosis::Verdict;
use pam_proof::case::Kind;
use pam_proof::draw::{self, Plan};
use pam_proof::folder::{self, DIAGNOSIS, Recordings};
use pam_proof::programs::Programs;

fn diagnosed(programs: &Programs, folder: &Path, recordings: &Recordings) -> (Verdict, Vec<String>) {
    programs.identify(folder, recordings).unwrap();
    programs.diagnose(folder, recordings).unwrap();
    let (artifact, _) = DiagnosisArtifact::read(&folder.join(DIAGNOSIS)).unwrap();
    (artifact.verdict, artifact.effects.into_iter().map(|effect| effect.id).collect())
}

/// The same recordings under names that suggest something else, in reverse order.
fn renamed(folder: &Path, recordings: &Recordings) -> Recordings {
    let rename = |files: &[String], name: &str| -> Vec<String> {
        let rename = |(index, file): (usize, &String)| {
            let new = format!("{name}-{index}.csv");
            std::fs::rename(folder.join(file), folder.join(&new)).unwrap();
            new
        };
        files.iter().enumerate().map(rename).rev().collect()
    };
    Recordings { estimation: rename(&recordings.estimation, "inertia"), holdout: rename(&recordings.holdout, "slack") }
}

#[test]
fn other_names_and_another_order_give_the_same_answers() {
    let Ok(programs) = Programs::beside(None) else {
        println!("skipped: the programs are not built");
        return;
    };
    for (index, id) in [None, Some("pressure-lag")].into_iter().enumerate() {
        let kind = if id.is_some() { Kind::Single } else { Kind::Nothing };
        let case = draw::case(&Plan { index: index as u64, kind, id, colored: false }, 11).unwrap();
        let scratch = tempfile::tempdir().unwrap();
        let recordings = folder::write(&case, scratch.path()).unwrap();
        let first = diagnosed(&programs, scratch.path(), &recordings);
        let second = diagnosed(&programs, scratch.path(), &renamed(scratch.path(), &recordings));
        assert_eq!(first, second, "{id:?}");
    }
}
