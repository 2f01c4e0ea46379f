//! What an effect looks like: a nominal muscle along a path that shows it, with the effect and without.

use std::f64::consts::TAU;
use std::ops::Range;

use pam_identification::search_space::{Free, LATEX_RATIO};
use pam_muscle::effects::{AugmentedModel, Effect, Moment, Seen, Term};
use pam_muscle::force::{BaseParameters, ForceModel, Form, Parameter};
use pam_muscle::motion::Instant;
use pam_muscle::shift::shifted;
use pam_muscle::{Coordinate, Muscle};

use crate::coordinates::{History, moving_limits};

/// An effect along a path, all columns as long.
#[derive(Debug, Clone, PartialEq)]
pub struct Signature {
    /// What the path is, in words.
    pub path: &'static str,
    /// What changes along the path, to lay the loop out over.
    pub driven: Driven,
    /// Values of it, SI.
    pub driven_values: Vec<f64>,
    /// Rows of a slow and of a fast cycle, where all cycles of the path would hide one another.
    pub cycles: Option<[Range<usize>; 2]>,
    /// Coordinate that tells the effect.
    pub coordinate: Coordinate,
    /// Values of it, SI.
    pub coordinate_values: Vec<f64>,
    /// Force of eq. 11, in N.
    pub without_n: Vec<f64>,
    /// Force with the effect, in N.
    pub with_n: Vec<f64>,
}

/// What a path changes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Driven {
    /// Contraction ratio.
    Contraction,
    /// Gauge pressure.
    Pressure,
    /// Time: holds, drifts and what comes cycle by cycle.
    Time,
}

/// Root mean square that amplitudes are chosen for, in N, as far as physics allows.
const SIZE_N: f64 = 10.0;

/// The muscle of `configs/muscle-nominal.toml`, and the modulus of its strands in Pa.
pub fn nominal() -> (Muscle, f64) {
    let muscle = Muscle::nominal();
    (muscle, 3e9)
}

/// Signature of `effect`, with a shape from the middle of where a fit looks first.
pub fn signature(effect: &'static dyn Effect) -> Signature {
    let (muscle, modulus_pa) = nominal();
    let base = nominal_model(&muscle, modulus_pa);
    let path = Path::of(effect.page().protocol, effect.page().coordinate);
    let instants = path.instants(&muscle, &base);
    let without_n: Vec<f64> = instants.iter().map(|instant| instant.force_n).collect();
    let shapes = effect.first_shapes(&Seen::of(instants.iter()));
    let shape = match shapes.get(shapes.len() / 2) {
        Some(shape) => shape.clone(),
        // An event: in the middle of the first recording.
        None => vec![0.0, 0.5 * path.duration_s],
    };
    let along = |amplitudes: Vec<f64>| {
        let term = Term::new(effect, shape.clone(), amplitudes);
        forces_n(&AugmentedModel::new(base.clone(), vec![term]), &instants)
    };
    let n_amplitudes = effect.amplitudes().len();
    let amplitudes = effect
        .amplitudes()
        .iter()
        .enumerate()
        .map(|(index, amplitude)| {
            let mut unit = vec![0.0; n_amplitudes];
            unit[index] = amplitude.range.1;
            let largest_n = rms(&along(unit), &without_n);
            amplitude.range.1 * (SIZE_N / n_amplitudes as f64 / largest_n.max(f64::MIN_POSITIVE)).min(1.0)
        })
        .collect();
    let with_n = along(amplitudes);
    let coordinate = effect.page().coordinate;
    let mut history = History::new(moving_limits(instants.iter().map(|instant| &instant.moment)));
    let coordinate_values = instants
        .iter()
        .map(|Instant { moment, force_n, .. }| {
            history.push(moment);
            match coordinate {
                Coordinate::Time => moment.time_s,
                Coordinate::Pressure => moment.pressure_pa,
                Coordinate::Contraction => moment.contraction_ratio,
                Coordinate::Speed => moment.speed_m_per_s.abs(),
                Coordinate::TravelSinceReversal => history.travel_m,
                Coordinate::TimeSinceLastMove => history.rest_s,
                Coordinate::Cycle => history.cycle,
                Coordinate::Force => *force_n,
            }
        })
        .collect();
    let driven_value = |moment: &Moment| match path.driven {
        Driven::Contraction => moment.contraction_ratio,
        Driven::Pressure => moment.pressure_pa,
        Driven::Time => moment.time_s,
    };
    Signature {
        path: path.words,
        driven: path.driven,
        driven_values: instants.iter().map(|instant| driven_value(&instant.moment)).collect(),
        cycles: path.is_chirp.then(|| chirp_cycles(&instants)),
        coordinate,
        coordinate_values,
        without_n,
        with_n,
    }
}

/// Eq. 11 with nominal parameters.
fn nominal_model(muscle: &Muscle, modulus_pa: f64) -> ForceModel {
    let mut parameters = BaseParameters { theta: [0.0; 8] };
    for parameter in Parameter::ALL {
        parameters.theta[parameter.index()] = Free::One(parameter).ranges(modulus_pa).nominal;
    }
    let sum_pa = Free::BladderSum.ranges(modulus_pa).nominal;
    parameters.theta[Parameter::C10.index()] = sum_pa / (1.0 + LATEX_RATIO);
    parameters.theta[Parameter::C01.index()] = sum_pa * LATEX_RATIO / (1.0 + LATEX_RATIO);
    ForceModel::new(muscle, modulus_pa, Form::Corrected, parameters)
}

fn forces_n(model: &AugmentedModel, instants: &[Instant]) -> Vec<f64> {
    let mut memory = model.start();
    let mut last_n = instants.first().map_or(0.0, |instant| {
        let moment = &instant.moment;
        model.settled_force_n(moment.pressure_pa, moment.length_m, moment.direction)
    });
    shifted(instants, model.delays_s())
        .into_iter()
        .map(|moment| {
            last_n = memory.force_n(model, Moment { force_n: last_n, ..moment });
            last_n
        })
        .collect()
}

/// Root mean square of the differences of two forces, in their unit.
pub(crate) fn rms(left: &[f64], right: &[f64]) -> f64 {
    let squares: f64 = left.iter().zip(right).map(|(left, right)| (left - right).powi(2)).sum();
    (squares / left.len().max(1) as f64).sqrt()
}

/// A path of pressure and contraction.
struct Path {
    words: &'static str,
    driven: Driven,
    duration_s: f64,
    /// Whether cycles grow faster along it.
    is_chirp: bool,
    /// Gauge pressure in Pa and contraction ratio at a time in s.
    at: fn(f64) -> (f64, f64),
}

impl Path {
    /// A short form of the protocol of that name, which moves along the coordinate.
    fn of(protocol: &str, coordinate: Coordinate) -> Self {
        let path = |words, driven, duration_s, at| Self { words, driven, duration_s, is_chirp: false, at };
        match protocol {
            _ if coordinate == Coordinate::Speed => {
                let chirp = path("length chirp at 300 kPa", Driven::Contraction, 30.0, |t| {
                    (300e3, 0.1 - 0.06 * chirp_phase(t).cos())
                });
                Self { is_chirp: true, ..chirp }
            }
            "pressure-chirp" => path("pressure steps at one length", Driven::Time, 6.0, |t| {
                (100e3 + 250e3 * smooth_step((t - 1.0) / 0.1) - 250e3 * smooth_step((t - 3.5) / 0.1), 0.08)
            }),
            "isobaric-triangles" => path("slow length triangles at 150 and 350 kPa", Driven::Contraction, 80.0, |t| {
                (if t < 40.0 { 150e3 } else { 350e3 }, 0.26 * triangle(t / 40.0))
            }),
            "minor-loops" => path("nested length triangles at 300 kPa", Driven::Contraction, 32.0, |t| {
                // Ever smaller strokes around the same middle.
                let stroke = [0.08, 0.04, 0.02, 0.01][((t / 8.0) as usize).min(3)];
                (300e3, 0.08 + stroke * (triangle(t / 8.0 + 0.25) - 0.5))
            }),
            "isometric-ramps" => {
                path("slow pressure ramps at a contraction of 5 and 15 %", Driven::Pressure, 60.0, |t| {
                    (450e3 * triangle(t / 30.0), if t < 30.0 { 0.05 } else { 0.15 })
                })
            }
            "isotonic" => path("slow length triangles at 100, 250 and 400 kPa", Driven::Contraction, 90.0, |t| {
                ([100e3, 250e3, 400e3][((t / 30.0) as usize).min(2)], 0.02 + 0.14 * triangle(t / 30.0))
            }),
            "length-steps" => path("length steps of 10 mm and holds at 300 kPa", Driven::Time, 60.0, |t| {
                (300e3, 0.05 + 0.0375 * smooth_step((t - 10.0) / 0.2) - 0.0375 * smooth_step((t - 35.0) / 0.2))
            }),
            "pressure-steps" => path("pressure steps and holds at one length", Driven::Time, 60.0, |t| {
                (100e3 + 250e3 * smooth_step((t - 10.0) / 0.2) - 250e3 * smooth_step((t - 35.0) / 0.2), 0.08)
            }),
            "run-in" => path("length triangles of growing stroke at 300 kPa", Driven::Contraction, 60.0, |t| {
                let stroke = [0.06, 0.06, 0.12, 0.12, 0.18, 0.18][((t / 10.0) as usize).min(5)];
                (300e3, stroke * triangle(t / 10.0))
            }),
            "endurance" => path("cycles of length at 400 kPa for ten minutes", Driven::Time, 600.0, |t| {
                (400e3, 0.1 - 0.08 * (TAU * 0.05 * t).cos())
            }),
            // The null protocol, and whatever is new.
            _ => path("slow length triangles at 100 kPa for ten minutes", Driven::Time, 600.0, |t| {
                (100e3, 0.02 + 0.06 * triangle(t / 60.0))
            }),
        }
    }

    /// The path every 5 ms, or every 20 ms where it is long, with the force of `base`.
    fn instants(&self, muscle: &Muscle, base: &ForceModel) -> Vec<Instant> {
        let step_s = if self.duration_s > 200.0 { 0.02 } else { 0.005 };
        let n = (self.duration_s / step_s) as usize;
        let (mut direction, mut slide_m) = (1.0, 0.0);
        let mut last: Option<(f64, f64)> = None;
        (0..n)
            .map(|index| {
                let time_s = index as f64 * step_s;
                let (pressure_pa, contraction_ratio) = (self.at)(time_s);
                let [before, after] = [time_s - step_s, time_s + step_s].map(|time_s| (self.at)(time_s.max(0.0)));
                let length_m = muscle.length_m(contraction_ratio);
                let (last_pa, last_ratio) = last.unwrap_or((pressure_pa, contraction_ratio));
                last = Some((pressure_pa, contraction_ratio));
                let contracted_m = (contraction_ratio - last_ratio) * muscle.rest_length_m;
                // Where the length stands still, the pressure moves the strands.
                let slide_m_per_pa = base.slide_m_per_pa(length_m);
                let slid_m = if contracted_m == 0.0 { slide_m_per_pa * (pressure_pa - last_pa) } else { contracted_m };
                if slid_m.abs() > 1e-12 {
                    direction = slid_m.signum();
                }
                slide_m += slid_m;
                let per_s = muscle.rest_length_m / (2.0 * step_s);
                let bend = after.1 - 2.0 * contraction_ratio + before.1;
                Instant {
                    row: index,
                    moment: Moment {
                        recording: 0,
                        time_s,
                        step_s: if index == 0 { 0.0 } else { step_s },
                        pressure_pa,
                        pressure_rate_pa_per_s: (after.0 - before.0) / (2.0 * step_s),
                        length_m,
                        contraction_ratio,
                        speed_m_per_s: (after.1 - before.1) * per_s,
                        slide_speed_m_per_s: if contracted_m == 0.0 {
                            slide_m_per_pa * (after.0 - before.0) / (2.0 * step_s)
                        } else {
                            (after.1 - before.1) * per_s
                        },
                        acceleration_m_per_s2: bend * muscle.rest_length_m / (step_s * step_s),
                        direction,
                        came: true,
                        slide_m,
                        rest_slide_m: 0.0,
                        force_n: 0.0,
                        warmth_k: 0.0,
                    },
                    force_n: base.force_n(pressure_pa, length_m, direction),
                    knee: false,
                    settled: true,
                }
            })
            .collect()
    }
}

/// 0 at whole numbers, 1 halfway between.
fn triangle(phase: f64) -> f64 {
    1.0 - (2.0 * phase.rem_euclid(1.0) - 1.0).abs()
}

/// 0 below 0, 1 above 1, without a corner.
fn smooth_step(share: f64) -> f64 {
    let share = share.clamp(0.0, 1.0);
    share * share * (3.0 - 2.0 * share)
}

/// Phase of a chirp from 0.05 to 3 Hz within 30 s.
fn chirp_phase(time_s: f64) -> f64 {
    let growth_per_s = 60.0_f64.ln() / 30.0;
    TAU * 0.05 * (growth_per_s * time_s).exp_m1() / growth_per_s
}

/// Rows of the first and of the last whole cycle of the chirp.
fn chirp_cycles(instants: &[Instant]) -> [Range<usize>; 2] {
    let cycle = |instant: &Instant| (chirp_phase(instant.moment.time_s) / TAU).floor();
    let last = instants.last().map_or(0.0, cycle) - 1.0;
    [0.0, last].map(|wanted| {
        let start = instants.partition_point(|instant| cycle(instant) < wanted);
        start..instants.partition_point(|instant| cycle(instant) <= wanted)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use pam_muscle::MuscleFile;
    use pam_muscle::effects::CATALOGUE;

    #[test]
    fn the_nominal_muscle_is_that_of_the_configuration() {
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../configs/muscle-nominal.toml");
        let file = MuscleFile::read(std::path::Path::new(path)).expect("a muscle file");
        let (muscle, modulus_pa) = nominal();
        assert_eq!(modulus_pa, file.strand_modulus_pa);
        assert!((muscle.braid_angle_rad - file.muscle.braid_angle_rad).abs() < 1e-12);
        assert!((muscle.strand_length_m() - file.muscle.strand_length_m()).abs() < 1e-12);
        assert_eq!(
            (muscle.strand_count, muscle.strand_diameter_m),
            (file.muscle.strand_count, file.muscle.strand_diameter_m)
        );
    }

    #[test]
    fn every_effect_of_the_catalogue_shows_on_its_path() {
        for effect in CATALOGUE {
            let id = effect.page().id;
            let found = signature(*effect);
            let n = found.with_n.len();
            assert!(n > 1000 && found.coordinate_values.len() == n && found.driven_values.len() == n, "{id}");
            assert!(found.with_n.iter().chain(&found.coordinate_values).all(|value| value.is_finite()), "{id}");
            let size_n = rms(&found.with_n, &found.without_n);
            assert!(size_n > 0.3 && size_n < 200.0, "{id}: {size_n} N");
            for cycle in found.cycles.into_iter().flatten() {
                let ends = found.driven_values[cycle.clone()]
                    .iter()
                    .fold((1.0_f64, 0.0_f64), |(low, high), ratio| (low.min(*ratio), high.max(*ratio)));
                assert!(ends.0 < 0.041 && ends.1 > 0.159, "{id}: {cycle:?} is no whole cycle: {ends:?}");
            }
        }
    }

    #[test]
    fn friction_that_builds_up_shows_after_a_reversal_alone() {
        let effect = pam_muscle::effects::effect("presliding-hysteresis").expect("an id");
        let found = signature(effect);
        let residual_n = |at: usize| (found.with_n[at] - found.without_n[at]).abs();
        let largest = |near: bool| {
            let here = |at: &usize| (found.coordinate_values[*at] < 3e-3) == near;
            (0..found.with_n.len()).filter(here).map(residual_n).fold(0.0, f64::max)
        };
        assert!(largest(true) > 3.0 * largest(false), "{} {}", largest(true), largest(false));
    }
}
