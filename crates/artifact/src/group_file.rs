//! The file of a group: muscles of one rig, each with its model and its recordings.
//!
//! ```toml
//! [[muscle]]
//! name = "short"
//! model = "short/model.json"
//! logs = ["short/triangles.csv", "short/ramps.csv"]
//! holdout = ["short/multisine.csv"]
//! ```
//!
//! Paths are relative to the file; `holdout` may be left out.

use std::collections::BTreeSet;
use std::path::PathBuf;

use pam_recording::spelling::toml_fault;
use serde::Deserialize;

/// Muscles that a group needs: with one of them nothing is shared.
const LEAST: usize = 2;

/// Why a group is refused; says the place and the remedy.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum GroupError {
    /// It is no TOML, or has other keys.
    #[error("line {line}, column {column}: {reason}")]
    Text {
        /// Line, from 1.
        line: usize,
        /// Column, from 1.
        column: usize,
        /// Why.
        reason: String,
    },
    /// There are too few muscles to share anything.
    #[error("it has {found} [[muscle]]; a group has {LEAST} muscles of one rig at least")]
    Few {
        /// Muscles found.
        found: usize,
    },
    /// Two muscles are called the same.
    #[error("two muscles are called \"{name}\"; give each a name of its own")]
    Twice {
        /// Their name.
        name: String,
    },
    /// A muscle has no recording.
    #[error("muscle \"{name}\" has no recording; name some in its logs")]
    NoLogs {
        /// Its name.
        name: String,
    },
    /// A recording is named twice.
    #[error("{} is named twice; every recording is of one muscle, and fitted or held out", path.display())]
    Recording {
        /// The recording.
        path: PathBuf,
    },
}

/// A muscle of a group.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GroupMember {
    /// Name, by which it is called in what is said.
    pub name: String,
    /// Model, as pam-identify wrote it; relative to the file.
    pub model: PathBuf,
    /// Recordings to diagnose.
    pub logs: Vec<PathBuf>,
    /// Recordings to hold out.
    #[serde(default)]
    pub holdout: Vec<PathBuf>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Written {
    #[serde(default)]
    muscle: Vec<GroupMember>,
}

/// The muscles that `text` names, in its order.
///
/// # Errors
/// [`GroupError`] says what cannot be, and what would do.
pub fn group_members(text: &str) -> Result<Vec<GroupMember>, GroupError> {
    let written: Written = toml::from_str(text).map_err(|error| {
        let (line, column, reason) = toml_fault(text, &error);
        GroupError::Text { line, column, reason }
    })?;
    let members = written.muscle;
    if members.len() < LEAST {
        return Err(GroupError::Few { found: members.len() });
    }
    let (mut names, mut paths) = (BTreeSet::new(), BTreeSet::new());
    for member in &members {
        let name = || member.name.clone();
        if !names.insert(&member.name) {
            return Err(GroupError::Twice { name: name() });
        }
        if member.logs.is_empty() {
            return Err(GroupError::NoLogs { name: name() });
        }
        if let Some(path) = member.logs.iter().chain(&member.holdout).find(|path| !paths.insert(*path)) {
            return Err(GroupError::Recording { path: path.clone() });
        }
    }
    Ok(members)
}

#[cfg(test)]
mod tests {
    use super::*;

    const TWO: &str = r#"
        [[muscle]]
        name = "short"
        model = "short/model.json"
        logs = ["short/1.csv"]
        holdout = ["short/2.csv"]

        [[muscle]]
        name = "long"
        model = "long/model.json"
        logs = ["long/1.csv"]
    "#;

    #[test]
    fn muscles_come_in_the_order_of_the_file() {
        let members = group_members(TWO).unwrap();
        assert_eq!(members.iter().map(|member| member.name.as_str()).collect::<Vec<_>>(), ["short", "long"]);
        assert_eq!((members[0].holdout.len(), members[1].holdout.len()), (1, 0));
    }

    #[test]
    fn what_shares_nothing_or_is_named_twice_is_refused_with_the_remedy() {
        let said = |text: &str| group_members(text).unwrap_err().to_string();
        assert!(said("").contains("it has 0 [[muscle]]"));
        assert!(said(&TWO.replace("\"long\"", "\"short\"")).contains("two muscles are called \"short\""));
        assert!(said(&TWO.replace("[\"long/1.csv\"]", "[]")).contains("\"long\" has no recording"));
        assert!(said(&TWO.replace("long/1.csv", "short/2.csv")).contains("short/2.csv is named twice"));
        assert!(said(&TWO.replace("logs = [\"long", "log = [\"long")).contains("did you mean `logs`?"));
    }
}
