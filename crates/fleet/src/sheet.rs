//! One row per campaign, as CSV: what a spreadsheet or another program goes on with.

use std::io::Write;

use crate::control::Chart;
use crate::record::{Record, verdict_word};
use crate::step::Step;
use crate::survey::Survey;

/// Writes the survey as CSV: names, outcomes, verdict and effects, residuals, then value, standard error and distance of
/// every quantity that some campaign has, each with its unit in the header.
///
/// # Errors
/// Those of the writer.
pub fn write_sheet(out: impl Write, survey: &Survey) -> Result<(), csv::Error> {
    let mut table = csv::WriterBuilder::new().from_writer(out);
    let mut quantities: Vec<(&str, &str)> = Vec::new();
    for chart in &survey.charts {
        if !quantities.iter().any(|(name, _)| *name == chart.name) {
            quantities.push((&chart.name, &chart.unit));
        }
    }
    let mut header: Vec<String> = ["muscle", "rig", "date", "make", "folder"].map(str::to_owned).to_vec();
    header.extend(Step::ALL.map(|step| step.name().replace('-', "_")));
    let own = ["reason_of_refusal", "verdict", "effects", "rmse_N", "holdout_rmse_N", "noise_N", "rmse_after_N"];
    header.extend(own.map(str::to_owned));
    header.extend(["stands_out", "reasons"].map(str::to_owned));
    for (name, unit) in &quantities {
        let unit = if *unit == "1" { String::new() } else { format!(" ({unit})") };
        header.extend([format!("{name}{unit}"), format!("{name} stderr{unit}"), format!("{name} distance")]);
    }
    table.write_record(&header)?;
    let mut reasons: Vec<&[crate::survey::Reason]> = vec![&[]; survey.records.len()];
    for standing in &survey.standing {
        reasons[standing.record] = &standing.reasons;
    }
    // A chart holds its points in the order of the records, so one walk along all of them serves every row.
    let mut walks: Vec<(&Chart, usize)> = survey.charts.iter().map(|chart| (chart, 0)).collect();
    for (index, record) in survey.records.iter().enumerate() {
        let mut row = fields(record);
        let words: Vec<&str> = reasons[index].iter().map(|reason| reason.words.as_str()).collect();
        row.extend([if words.is_empty() { "no" } else { "yes" }.to_owned(), words.join("; ")]);
        let mut values = vec![[const { String::new() }; 3]; quantities.len()];
        for (chart, next) in &mut walks {
            let Some(point) = chart.points.get(*next).filter(|point| point.record == index) else { continue };
            *next += 1;
            if let Some(place) = quantities.iter().position(|(name, _)| *name == chart.name) {
                let distance = chart.location.map_or(String::new(), |_| format!("{:.3}", point.distance));
                values[place] =
                    [point.value.to_string(), point.stderr.map_or(String::new(), |e| e.to_string()), distance];
            }
        }
        row.extend(values.into_iter().flatten());
        table.write_record(&row)?;
    }
    table.flush()?;
    Ok(())
}

/// What does not depend on other campaigns.
fn fields(record: &Record) -> Vec<String> {
    let campaign = &record.campaign;
    let mut row: Vec<String> =
        [&campaign.muscle, &campaign.rig, &campaign.date, &campaign.make, &campaign.id].map(String::clone).to_vec();
    row.extend(record.outcomes.iter().map(|outcome| outcome.word().to_owned()));
    let reasons: Vec<String> = record.refusals().map(|(step, reason)| format!("{}: {reason}", step.name())).collect();
    row.push(reasons.join("; "));
    let newtons = |value: Option<f64>| value.map_or(String::new(), |value| format!("{value:.4}"));
    let (diagnosed, identified) = (record.diagnosed.as_ref(), record.identified.as_ref());
    row.push(diagnosed.map_or("", |diagnosed| verdict_word(diagnosed.verdict)).to_owned());
    let effects = diagnosed.map_or(&[][..], |diagnosed| &diagnosed.effects);
    let ids: Vec<&str> = effects.iter().map(|effect| effect.id.as_str()).collect();
    row.push(ids.join("; "));
    row.push(newtons(identified.map(|identified| identified.rmse_n)));
    row.push(newtons(identified.and_then(|identified| identified.holdout_rmse_n)));
    row.push(newtons(identified.map(|identified| identified.noise_n)));
    row.push(newtons(diagnosed.map(|diagnosed| diagnosed.rmse_after_n)));
    row
}
