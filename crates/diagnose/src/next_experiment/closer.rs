//! What to record where structure is left that has no name.

use pam_artifact::diagnosis::{NextExperiment, Region};
use pam_artifact::model::Domain;
use pam_muscle::Coordinate;

use super::plan::{planned, run_it};
use super::setpoints::Setpoints;
use crate::protocols::{self, Reach};
use crate::state::State;
use crate::words;

/// The protocol that dwells on where structure is left, over that place and as much again to either side.
pub(super) fn look_closer(
    region: &Region,
    left_n: f64,
    state: &State,
    domain: &Domain,
) -> Option<(NextExperiment, Setpoints)> {
    let name = match region.coordinate {
        Coordinate::Time => "null",
        Coordinate::Pressure => "isometric-ramps",
        Coordinate::Contraction => "isobaric-triangles",
        Coordinate::Speed => "rate-ladder",
        Coordinate::TravelSinceReversal => "minor-loops",
        Coordinate::TimeSinceLastMove => "length-steps",
        Coordinate::Cycle => "run-in",
        Coordinate::Force => "isotonic",
    };
    let whole = Reach::of(domain, &state.model, state.hangs_slack());
    let around = |(low, high): (f64, f64), from: f64, to: f64| {
        let margin = to - from;
        let narrow = ((from - margin).max(low), (to + margin).min(high));
        if narrow.1 > narrow.0 { narrow } else { (low, high) }
    };
    let narrow = match region.coordinate {
        Coordinate::Pressure => Reach { pressure_pa: around(whole.pressure_pa, region.from, region.to), ..whole },
        Coordinate::Contraction => {
            let [short_m, long_m] = [region.to, region.from].map(|ratio| state.model.muscle().length_m(ratio));
            Reach { length_m: around(whole.length_m, short_m, long_m), ..whole }
        }
        _ => whole,
    };
    let protocol = protocols::named(name)?;
    let reach = if protocol.takes(&narrow).is_empty() { whole } else { narrow };
    let instruction = format!(
        "{} It dwells on what has no name yet, {}; two such recordings, one of them held out, tell whether it comes back.",
        run_it(protocol, &reach),
        words::place(region)
    );
    Some(planned(protocol, &reach, vec!["unexplained".to_owned()], left_n, instruction))
        .filter(|(_, setpoints)| !setpoints.points.is_empty())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rehearsal::tests::{Given, domain};

    #[test]
    fn a_region_without_a_name_is_looked_at_more_closely() {
        let given = Given::of(&["isobaric-triangles"], &[]);
        let state = given.setting().fit(Vec::new(), &given.start, &given.model).expect("a fit");
        let region = Region {
            coordinate: Coordinate::Contraction,
            from: 0.10,
            to: 0.13,
            unit: "1".to_owned(),
            share_of_excess: 0.8,
            p_value: 1e-6,
            recording: None,
        };
        let (experiment, setpoints) = look_closer(&region, 2.0, &state, &domain()).expect("an experiment");
        assert_eq!(experiment.protocol, "isobaric-triangles");
        let muscle = state.model.muscle();
        for point in &setpoints.points {
            let ratio = muscle.contraction_ratio(point.length_mm * 1e-3);
            assert!((0.07 - 1e-9..0.16 + 1e-9).contains(&ratio), "{ratio}");
        }
    }
}
