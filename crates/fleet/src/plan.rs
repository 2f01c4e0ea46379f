//! `pam-fleet-plan/1`: what is to be done, one campaign after another.
//!
//! A campaign is everything that was recorded of one muscle on one rig at one date: the smallest thing that gets a model
//! of its own, and the point of a control chart.

use std::collections::BTreeMap;
use std::path::Path;

use pam_artifact::Tool;
#[cfg(feature = "schemas")]
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use sha2::{Digest as _, Sha256};

use crate::error::{TableError, TableErrorKind};
use crate::table::{Role, Row};

/// Schema name and version.
pub const SCHEMA: &str = "pam-fleet-plan/1";

/// A table of recordings, checked and put together for whatever runs the programs.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct FleetPlan {
    /// `pam-fleet-plan/1`.
    #[cfg_attr(feature = "schemas", schemars(extend("const" = SCHEMA)))]
    pub schema: String,
    /// Program that wrote it.
    pub tool: Tool,
    /// Campaigns in order of muscle, rig and date.
    pub campaigns: Vec<Campaign>,
}

/// One muscle on one rig at one date.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Campaign {
    /// Name of the folder of its results: letters, digits, `.`, `_` and `-` only.
    pub id: String,
    /// Muscle.
    pub muscle: String,
    /// Rig.
    pub rig: String,
    /// Date, ISO 8601.
    pub date: String,
    /// Make of the muscle; empty where the table does not say.
    pub make: String,
    /// Muscle file with its dimensions.
    pub dimensions: String,
    /// Recordings to fit, in the order of the table.
    pub estimation: Vec<String>,
    /// Recordings held out, in the order of the table.
    pub holdout: Vec<String>,
}

impl FleetPlan {
    /// Puts the rows of a table together; `table` is the name to complain about. Paths are made absolute.
    ///
    /// # Errors
    /// [`TableError`] where a campaign has nothing to estimate from, or a muscle two makes or dimensions.
    pub fn new(tool: Tool, table: &Path, rows: &[Row]) -> Result<Self, TableError> {
        let refuse = |line: u64, kind| TableError { path: table.to_owned(), line, column: 1, kind };
        let mut campaigns: BTreeMap<(&str, &str, &str), (u64, Campaign)> = BTreeMap::new();
        let mut muscles: BTreeMap<&str, &Row> = BTreeMap::new();
        for row in rows {
            let first = *muscles.entry(&row.muscle).or_insert(row);
            for (what, differs) in
                [("make", first.make != row.make), ("dimensions", first.dimensions != row.dimensions)]
            {
                if differs {
                    return Err(refuse(row.line, TableErrorKind::Contradiction { what, first: first.line }));
                }
            }
            let (_, campaign) =
                campaigns.entry((&row.muscle, &row.rig, &row.date)).or_insert_with(|| (row.line, empty_campaign(row)));
            match row.role {
                Role::Estimation => campaign.estimation.push(absolute(&row.path)),
                Role::Holdout => campaign.holdout.push(absolute(&row.path)),
            }
        }
        if let Some((line, Campaign { muscle, rig, date, .. })) =
            campaigns.values().find(|(_, campaign)| campaign.estimation.is_empty())
        {
            let (muscle, rig, date) = (muscle.clone(), rig.clone(), date.clone());
            return Err(refuse(*line, TableErrorKind::NoEstimation { muscle, rig, date }));
        }
        let campaigns = campaigns.into_values().map(|(_, campaign)| campaign).collect();
        Ok(Self { schema: SCHEMA.to_owned(), tool, campaigns })
    }
}

fn empty_campaign(row: &Row) -> Campaign {
    Campaign {
        id: folder_name([&row.muscle, &row.rig, &row.date]),
        muscle: row.muscle.clone(),
        rig: row.rig.clone(),
        date: row.date.clone(),
        make: row.make.clone(),
        dimensions: absolute(&row.dimensions),
        estimation: Vec::new(),
        holdout: Vec::new(),
    }
}

fn absolute(path: &Path) -> String {
    // It fails for an empty path alone, which a table does not let through.
    std::path::absolute(path).unwrap_or_else(|_| path.to_owned()).display().to_string()
}

/// A folder name that says what it holds. Names that a file system or a shell might take amiss are spelled with `_` and
/// told apart by a digest, so that a row more in the table renames no folder.
fn folder_name(names: [&str; 3]) -> String {
    let plain = |character: char| character.is_ascii_alphanumeric() || matches!(character, '.' | '_' | '-');
    let spelled: Vec<String> = names
        .iter()
        .map(|name| name.chars().map(|character| if plain(character) { character } else { '_' }).collect())
        .collect();
    let folder = spelled.join("--");
    let unambiguous =
        names.iter().all(|name| name.chars().all(plain) && !name.contains("--") && !name.starts_with(['.', '-']));
    if unambiguous && folder.len() < 120 {
        return folder;
    }
    let digest = Sha256::digest(names.join("\n"));
    let digest: String = digest.iter().take(4).map(|byte| format!("{byte:02x}")).collect();
    let folder: String = folder.trim_start_matches(['.', '-']).chars().take(100).collect();
    format!("{folder}-{digest}")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(line: u64, names: [&str; 3], role: Role) -> Row {
        let [muscle, rig, date] = names.map(str::to_owned);
        let (path, dimensions) = (format!("/logs/{line}.csv").into(), "/m.toml".into());
        Row { line, path, muscle, rig, date, role, make: String::new(), dimensions }
    }

    fn plan(rows: &[Row]) -> Result<FleetPlan, TableError> {
        FleetPlan::new(Tool { name: "pam-fleet".to_owned(), version: "1".to_owned() }, "t.csv".as_ref(), rows)
    }

    #[test]
    fn rows_of_one_muscle_rig_and_date_are_one_campaign() {
        let (march, april) = (["b", "r", "2026-03-01"], ["b", "r", "2026-04-01"]);
        let rows = [
            row(2, april, Role::Estimation),
            row(3, march, Role::Holdout),
            row(4, march, Role::Estimation),
            row(5, ["a", "r", "2026-03-01"], Role::Estimation),
        ];
        let plan = plan(&rows).expect("a plan");
        let ids: Vec<&str> = plan.campaigns.iter().map(|campaign| campaign.id.as_str()).collect();
        assert_eq!(ids, ["a--r--2026-03-01", "b--r--2026-03-01", "b--r--2026-04-01"]);
        assert_eq!((&*plan.campaigns[1].estimation[0], &*plan.campaigns[1].holdout[0]), ("/logs/4.csv", "/logs/3.csv"));
    }

    #[test]
    fn a_campaign_needs_something_to_estimate_from_and_a_muscle_one_make() {
        let only_held_out =
            plan(&[row(2, ["m", "r", "2026-03-01"], Role::Holdout)]).expect_err("a refusal").to_string();
        let other_make = Row { make: "b".to_owned(), ..row(3, ["m", "s", "2026-03-01"], Role::Estimation) };
        let two_makes = plan(&[row(2, ["m", "r", "2026-03-01"], Role::Estimation), other_make]).expect_err("a refusal");
        insta::assert_snapshot!(format!("{only_held_out}\n{two_makes}"), @r"
        t.csv:2:1: m on r at 2026-03-01 has no recording for estimation; give one of its rows the role estimation
        t.csv:3:1: make differs from that of the same muscle in line 2; a muscle has one
        ");
    }

    #[test]
    fn folders_are_plain_and_stay_apart() {
        let names = [["a b", "r", "d"], ["a_b", "r", "d"], ["a", "b--r", "d"], ["a--b", "r", "d"], ["../x", "r", "d"]];
        let folders: std::collections::BTreeSet<String> = names.into_iter().map(folder_name).collect();
        assert_eq!(folders.len(), names.len());
        assert!(folders.iter().all(|name| !name.contains('/') && !name.starts_with('.')), "{folders:?}");
    }
}
