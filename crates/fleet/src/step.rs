//! What a program said of a campaign: its exit code and the messages that it left.

use std::path::Path;

use serde::Deserialize;

/// A program of the chain, in the order in which they run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Step {
    /// `pam-identify`.
    Identify,
    /// `pam-predict`, for every held-out recording.
    Predict,
    /// `pam-diagnose`.
    Diagnose,
    /// `pam-train-inverse`.
    TrainInverse,
}

impl Step {
    /// Every step.
    pub const ALL: [Self; 4] = [Self::Identify, Self::Predict, Self::Diagnose, Self::TrainInverse];

    /// Name of the files that it leaves, without their endings.
    pub fn name(self) -> &'static str {
        match self {
            Self::Identify => "identify",
            Self::Predict => "predict",
            Self::Diagnose => "diagnose",
            Self::TrainInverse => "train-inverse",
        }
    }

    /// Its artifact; predictions have none of one name.
    pub fn artifact(self) -> Option<&'static str> {
        match self {
            Self::Identify => Some("model.json"),
            Self::Predict => None,
            Self::Diagnose => Some("diagnosis.json"),
            Self::TrainInverse => Some("inverse.json"),
        }
    }
}

/// How a step ended.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Outcome {
    /// Exit code 0.
    Accepted,
    /// Exit code 1: done, and rejected for a reason in words. Of a diagnosis that is an answer like any other.
    Rejected(String),
    /// Exit code 2: refused, with the one line that names place and remedy.
    Refused(String),
    /// Not tried, since a step before it left nothing to work on.
    Skipped,
    /// There is no trace of it, or only half of one.
    Missing(String),
}

/// Exit code that stands for a step that was not tried.
const SKIPPED: &str = "skipped";

impl Outcome {
    /// Reads how `step` ended in the folder of a campaign.
    pub fn read(folder: &Path, step: Step) -> Self {
        let name = step.name();
        let code = match std::fs::read_to_string(folder.join(format!("{name}.exit"))) {
            Ok(code) => code,
            Err(_) => return Self::Missing(format!("{name} has not run to its end")),
        };
        let said = || Said::read(&folder.join(format!("{name}.jsonl")));
        let artifact_is_there = step.artifact().is_none_or(|artifact| folder.join(artifact).is_file());
        // The first line; sums of the artifacts follow.
        match code.lines().next().unwrap_or_default().trim() {
            "0" | "1" if !artifact_is_there => {
                Self::Missing(format!("{name} ran to its end and {} is gone", step.artifact().unwrap_or_default()))
            }
            "0" => Self::Accepted,
            "1" => Self::Rejected(said().last_warning.unwrap_or_else(|| format!("{name} rejected its result"))),
            "2" => {
                Self::Refused(said().error.unwrap_or_else(|| format!("{name} ended with exit code 2 and said nothing")))
            }
            SKIPPED => Self::Skipped,
            other => {
                Self::Missing(format!("{name}.exit holds \"{}\", which is no exit code of it", other.escape_default()))
            }
        }
    }

    /// The same for a table: `accepted`, `rejected`, `refused`, `skipped`, `missing`.
    pub fn word(&self) -> &'static str {
        match self {
            Self::Accepted => "accepted",
            Self::Rejected(_) => "rejected",
            Self::Refused(_) => "refused",
            Self::Skipped => "skipped",
            Self::Missing(_) => "missing",
        }
    }
}

/// A line of `pam-messages/1`, as much of it as is needed here.
#[derive(Deserialize)]
struct Line {
    level: String,
    message: Option<String>,
}

/// The lines that say why a step ended as it did.
struct Said {
    error: Option<String>,
    last_warning: Option<String>,
}

impl Said {
    /// Reads the messages of a step; whatever is no message is passed over, since a program that broke off may have left
    /// half a line.
    fn read(path: &Path) -> Self {
        let mut said = Self { error: None, last_warning: None };
        let bytes = std::fs::read(path).unwrap_or_default();
        for line in bytes.split(|byte| *byte == b'\n') {
            let Ok(Line { level, message: Some(message) }) = serde_json::from_slice(line) else { continue };
            match level.as_str() {
                "error" => said.error = Some(message),
                "warning" => said.last_warning = Some(message),
                _ => {}
            }
        }
        said
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_exit_code_and_the_last_word_say_how_a_step_ended() {
        let folder = tempfile::tempdir().expect("a folder");
        let outcome = |code: &str, said: &str| {
            std::fs::write(folder.path().join("predict.exit"), code).expect("a file");
            std::fs::write(folder.path().join("predict.jsonl"), said).expect("a file");
            Outcome::read(folder.path(), Step::Predict)
        };
        assert_eq!(outcome("0\n4038471504 75 predicted-1.csv\n", ""), Outcome::Accepted);
        let lines =
            "{\"level\":\"warning\",\"message\":\"late\"}\n{\"level\":\"error\",\"message\":\"a.csv:3:1: no\"}\n{\"lev";
        assert_eq!(outcome("2\n", lines), Outcome::Refused("a.csv:3:1: no".to_owned()));
        assert_eq!(outcome("1\n", lines), Outcome::Rejected("late".to_owned()));
        assert_eq!(outcome("skipped\n", ""), Outcome::Skipped);
        assert_eq!(outcome("137\n", "").word(), "missing");
        std::fs::write(folder.path().join("identify.exit"), "0\n").expect("a file");
        let gone = Outcome::Missing("identify ran to its end and model.json is gone".to_owned());
        assert_eq!(Outcome::read(folder.path(), Step::Identify), gone);
        assert_eq!(Outcome::read(folder.path(), Step::Diagnose).word(), "missing");
    }
}
