//! Table and results in, plan, sheet and page out.

use anyhow::Context as _;
use pam_artifact::{Tool, readable_json};
use pam_cli::{Console, Output, Verdict};
use pam_fleet_survey::plan::FleetPlan;
use pam_fleet_survey::sheet::write_sheet;
use pam_fleet_survey::survey::Survey;
use pam_fleet_survey::table::read_table;
use pam_report::fleet_page;

use crate::args::Args;
use crate::page::page;

pub(crate) fn run(args: &Args) -> anyhow::Result<Verdict> {
    let console = args.run.start()?;
    let inputs = || [Some(&args.table), args.muscle.as_ref()].into_iter().flatten();
    let open = |path: Option<&std::path::PathBuf>| match path.filter(|_| !args.run.check) {
        Some(path) => anyhow::Ok(Some(Output::open(path)?.apart_from(inputs())?)),
        None => Ok(None),
    };
    let (plan_out, sheet_out, page_out) =
        (open(args.plan.as_ref())?, open(args.out.as_ref())?, open(args.report.as_ref())?);
    let tool = Tool { name: env!("CARGO_PKG_NAME").to_owned(), version: env!("CARGO_PKG_VERSION").to_owned() };
    let rows = read_table(&args.table, args.muscle.as_deref())?;
    let plan = FleetPlan::new(tool, &args.table, &rows)?;
    drop(rows);
    let apart = |out: Option<Output>| out.map(|out| out.apart_from(named_in(&plan))).transpose();
    let (plan_out, sheet_out, page_out) = (apart(plan_out)?, apart(sheet_out)?, apart(page_out)?);
    if args.run.check {
        console.note(format!("{}: {} campaigns", args.table.display(), plan.campaigns.len()));
        return Ok(Verdict::Accepted);
    }
    let mut outputs = Vec::new();
    if let Some(out) = plan_out {
        outputs.push((out, readable_json(&plan)?));
    }
    let mut verdict = Verdict::Accepted;
    if let (Some(results), Some(out)) = (&args.results, sheet_out) {
        anyhow::ensure!(
            results.is_dir(),
            "{}: no such folder; --results is where the campaigns' folders lie",
            results.display()
        );
        let survey = survey(plan, results, &console);
        if !survey.is_complete() {
            verdict = Verdict::Rejected;
        }
        summarize(&survey, &console);
        let mut sheet = Vec::new();
        write_sheet(&mut sheet, &survey).context("cannot write the sheet")?;
        outputs.push((out, sheet));
        if let Some(out) = page_out {
            let way = way(out.path(), results);
            outputs.push((out, fleet_page(&page(&survey, way.as_deref()))?.into_bytes()));
        }
    }
    pam_cli::publish(outputs, &console)?;
    Ok(verdict)
}

/// Recordings and muscle files that a plan names.
fn named_in(plan: &FleetPlan) -> impl Iterator<Item = &str> {
    plan.campaigns.iter().flat_map(|campaign| {
        let files = campaign.estimation.iter().chain(&campaign.holdout).chain(std::iter::once(&campaign.dimensions));
        files.map(String::as_str)
    })
}

fn survey(plan: FleetPlan, results: &std::path::Path, console: &Console) -> Survey {
    let progress = console.progress("reading results", plan.campaigns.len() as u64);
    Survey::new(plan, results, &mut |done| progress.set(done as u64))
}

/// Says on standard error what a person wants to know first.
fn summarize(survey: &Survey, console: &Console) {
    let refused = survey.records.iter().filter(|record| record.refusals().next().is_some()).count();
    console.note(format!(
        "{} campaigns: {} stand out, {refused} were refused or are missing",
        survey.records.len(),
        survey.standing.len()
    ));
}

/// The way from the page to the results, as a reference; none where the results do not lie beside or below it, since a page
/// that is handed on would lead nowhere.
fn way(page: &std::path::Path, results: &std::path::Path) -> Option<String> {
    let parent = page.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(std::path::Path::new("."));
    let (from, to) = (parent.canonicalize().ok()?, results.canonicalize().ok()?);
    let parts: Option<Vec<&str>> = to.strip_prefix(from).ok()?.iter().map(|part| part.to_str()).collect();
    // Characters that a reference would have to spell otherwise are rare in folders, and a missing link costs little.
    let plain = |part: &&str| part.chars().all(|character| character.is_alphanumeric() || "._-".contains(character));
    let parts = parts.filter(|parts| parts.iter().all(plain))?;
    Some(parts.iter().map(|part| format!("{part}/")).collect())
}
