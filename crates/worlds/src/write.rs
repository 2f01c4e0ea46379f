//! Files: one folder a case, and the truth apart from them.

use std::fmt::Write as _;
use std::fs;
use std::io;
use std::path::Path;

use rayon::prelude::*;
use serde::Serialize;

use crate::case::{Case, Request, Truth};
use crate::draw::Dice;
use crate::sensors::Log;

/// The one file of truth.
#[derive(Debug, Serialize)]
struct TruthFile<'a> {
    seed: u64,
    half: &'static str,
    cases: &'a [Truth],
}

fn recording_csv(log: &Log) -> String {
    let mut text = String::with_capacity(48 * log.time_s.len());
    let with_temperature = !log.temperature_c.is_empty();
    text.push_str("time_s,pressure_kPa,length_mm,force_N");
    text.push_str(if with_temperature { ",temperature_C\n" } else { "\n" });
    for index in 0..log.time_s.len() {
        let (time_s, pressure_kpa) = (log.time_s[index], 1e-3 * log.pressure_pa[index]);
        let (length_mm, force_n) = (1e3 * log.length_m[index], log.force_n[index]);
        let _ = write!(text, "{time_s:.6},{pressure_kpa:.4},{length_mm:.5},{force_n:.4}");
        if with_temperature {
            let _ = write!(text, ",{:.3}", log.temperature_c[index]);
        }
        text.push('\n');
    }
    text
}

fn truth_csv(log: &Log) -> String {
    let mut text = String::with_capacity(12 * log.time_s.len());
    text.push_str("force_N\n");
    for force_n in &log.true_force_n {
        let _ = writeln!(text, "{force_n:.5}");
    }
    text
}

fn write_case(folder: &Path, request: &Request, index: usize) -> io::Result<Truth> {
    let case = Case::draw(request, index);
    let (files, apart) = (folder.join(&case.truth.case), folder.join("truth").join(&case.truth.case));
    fs::create_dir_all(&files)?;
    fs::create_dir_all(&apart)?;
    let muscle_toml = case.world.caliper.muscle_toml(&case.world.muscle, &mut Dice::new(case.caliper_seed, 3));
    fs::write(files.join("muscle.toml"), muscle_toml)?;
    for (recording, log) in case.logs.iter().enumerate() {
        let name = if recording < case.world.estimation {
            format!("e{}.csv", recording + 1)
        } else {
            let name = format!("h{}.csv", recording - case.world.estimation + 1);
            fs::write(apart.join(&name), truth_csv(log))?;
            name
        };
        fs::write(files.join(name), recording_csv(log))?;
    }
    Ok(case.truth)
}

/// Writes all cases of a request into a folder, and `truth.json` beside them. Returns the truth.
pub fn write_all(folder: &Path, request: &Request) -> io::Result<Vec<Truth>> {
    let cases: Vec<Truth> = (0..request.cases)
        .into_par_iter()
        .map(|index| write_case(folder, request, index))
        .collect::<io::Result<_>>()?;
    let half = request.half.name();
    let mut text = serde_json::to_string_pretty(&TruthFile { seed: request.seed, half, cases: &cases })?;
    text.push('\n');
    fs::write(folder.join("truth.json"), text)?;
    Ok(cases)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::CaseKind;
    use crate::catalogue::Half;

    #[test]
    fn equal_seeds_write_equal_bytes_on_any_number_of_threads() {
        let request = Request { seed: 5, cases: 2, half: Half::Choose, bench: None, kind: Some(CaseKind::Nameless) };
        let (first, again) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
        let truths = write_all(first.path(), &request).unwrap();
        let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
        pool.install(|| write_all(again.path(), &request)).unwrap();
        let mut names = vec!["truth.json".to_owned()];
        for truth in &truths {
            names.push(format!("{}/muscle.toml", truth.case));
            names.push(format!("{}/e1.csv", truth.case));
            names.push(format!("{}/h1.csv", truth.case));
            names.push(format!("truth/{}/h1.csv", truth.case));
        }
        for name in names {
            let (one, other) =
                (fs::read(first.path().join(&name)).unwrap(), fs::read(again.path().join(&name)).unwrap());
            assert!(!one.is_empty() && one == other, "{name}");
        }
    }

    #[test]
    fn an_effect_that_no_world_shows_gives_way_to_another() {
        let request = Request { seed: 32, cases: 14, half: Half::Choose, bench: None, kind: None };
        let case = Case::draw(&request, 5);
        assert_eq!(case.truth.given_up, ["end-taper"]);
        assert!(case.truth.kind == CaseKind::One && case.truth.concealed[0] != "end-taper", "{:?}", case.truth);
        assert_eq!(case.truth.redraws, case.truth.redraws_by_reason.values().sum::<usize>());
    }

    #[test]
    fn what_is_concealed_shows_and_the_muscle_stays_taut() {
        for half in [Half::Choose, Half::Report, Half::Sealed] {
            let request = Request { seed: 9, cases: 2, half, bench: None, kind: Some(CaseKind::One) };
            for index in 0..request.cases {
                let case = Case::draw(&request, index);
                assert!(case.truth.severity_over_floor.iter().all(|size| *size >= 1.2), "{:?}", case.truth);
                if case.truth.concealed[0] != "slack" {
                    let low =
                        case.logs.iter().flat_map(|log| &log.true_force_n).filter(|force_n| **force_n < -3.0).count();
                    let all: usize = case.logs.iter().map(|log| log.true_force_n.len()).sum();
                    assert!(low < all / 100 + 1, "{:?}", case.truth);
                }
            }
        }
    }
}
