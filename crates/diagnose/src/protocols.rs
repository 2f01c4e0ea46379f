//! Commanded paths of the bench protocols, for a muscle of which only a fitted model is known.
//!
//! # Design
//! The virtual bench has the same protocols, made for a muscle whose truth it knows: where that goes slack bounds its
//! paths. Here the truth is not known, so the paths are worked out again from what is: the pressures and lengths that the
//! recordings of the model covered, and where eq. 11 says that the muscle is taut. Nothing of the bench is used, so neither
//! can leak into the other.
//!
//! Protocols are written in the numbers of a 267 mm muscle at 0 to 500 kPa and contractions of -0.5 to 21 %; another
//! muscle gets them scaled to what was covered.

use std::f64::consts::TAU;

use pam_core::force::ForceModel;

/// Rest length for which distances and speeds of the protocols are written, in m.
const REFERENCE_LENGTH_M: f64 = 0.267;
/// Pressure for which they are written.
const REFERENCE_KPA: f64 = 500.0;
/// Contractions for which they are written.
const REFERENCE_CONTRACTION: (f64, f64) = (-0.005, 0.21);
/// Rate at which the pressure goes from level to level, in kPa/s: slow enough that the direction follows.
const LEVEL_KPA_PER_S: f64 = 60.0;
/// Time from one take to the next, in s.
const PAUSE_S: f64 = 5.0;

/// Pressure and length at one time of a take.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Knot {
    pub time_s: f64,
    pub pressure_pa: f64,
    pub length_m: f64,
}

/// One uninterrupted stretch: straight between knots.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Take {
    /// Time before it that need not be recorded.
    pub pause_before_s: f64,
    pub knots: Vec<Knot>,
}

impl Take {
    pub(crate) fn duration_s(&self) -> f64 {
        self.knots.last().map_or(0.0, |knot| knot.time_s)
    }
}

/// A protocol.
pub(crate) struct Protocol {
    /// Name, that of the virtual bench.
    pub name: &'static str,
    /// What is done, in words.
    pub summary: &'static str,
    path: fn(&Reach<'_>) -> Vec<Take>,
}

impl Protocol {
    /// Takes within `reach`; empty where it leaves no room for them.
    pub(crate) fn takes(&self, reach: &Reach<'_>) -> Vec<Take> {
        let mut takes = (self.path)(reach);
        takes.retain(|take| take.knots.len() > 1);
        if let Some(first) = takes.first_mut() {
            first.pause_before_s = 0.0;
        }
        takes
    }
}

/// Every protocol.
pub(crate) static PROTOCOLS: [Protocol; 14] = [
    Protocol {
        name: "null",
        summary: "lowest pressure at rest for half a minute, then three slow stretches",
        path: null,
    },
    Protocol {
        name: "run-in",
        summary: "length triangles of growing stroke at one pressure, twice, an hour of rest, once more; with rubber that \
                  has rested",
        path: run_in,
    },
    Protocol {
        name: "isobaric-triangles",
        summary: "three length triangles over the whole stroke at each of seven pressures",
        path: isobaric_triangles,
    },
    Protocol {
        name: "rate-ladder",
        summary: "length triangles at five speeds from 0.5 to 50 mm/s, at three pressures",
        path: rate_ladder,
    },
    Protocol {
        name: "minor-loops",
        summary: "nested small length triangles and reversals at one pressure",
        path: minor_loops,
    },
    Protocol {
        name: "isometric-ramps",
        summary: "slow pressure ramps from the lowest pressure up and back at five lengths",
        path: isometric_ramps,
    },
    Protocol {
        name: "length-steps",
        summary: "fast length steps with holds of a minute at three pressures",
        path: length_steps,
    },
    Protocol {
        name: "pressure-steps",
        summary: "fast pressure steps with holds of a minute at three lengths",
        path: pressure_steps,
    },
    Protocol {
        name: "pressure-chirp",
        summary: "a pressure sweep from 0.05 to 10 Hz at three lengths, the length locked",
        path: pressure_chirp,
    },
    Protocol {
        name: "length-chirp",
        summary: "a length sweep from 0.05 to 8 Hz at three pressures",
        path: length_chirp,
    },
    Protocol {
        name: "multisine",
        summary: "pressure and length wander together without repeating, four minutes",
        path: multisine,
    },
    Protocol { name: "isotonic", summary: "slow pressure triangles under four constant loads", path: isotonic },
    Protocol {
        name: "endurance",
        summary: "two hundred cycles at two pressures in turn, with probe cycles before, between and after half an hour of \
                  rest",
        path: endurance,
    },
    Protocol {
        name: "dwell",
        summary: "slow moves with waits of 0.1 to 100 s before going on and before turning back",
        path: dwell,
    },
];

/// The protocol called `name`.
pub(crate) fn named(name: &str) -> Option<&'static Protocol> {
    PROTOCOLS.iter().find(|protocol| protocol.name == name)
}

/// Where the muscle may be taken.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Reach<'a> {
    /// What says where it is taut.
    pub model: &'a ForceModel,
    /// Lowest and highest pressure, in Pa.
    pub pressure_pa: (f64, f64),
    /// Shortest and longest length, in m.
    pub length_m: (f64, f64),
    /// Tension to be kept while it contracts, in N; `-∞` lets it go slack.
    pub lowest_tension_n: f64,
}

impl Reach<'_> {
    fn pressure(&self, kilopascal: f64) -> f64 {
        let (low, high) = self.pressure_pa;
        low + (kilopascal / REFERENCE_KPA).clamp(0.0, 1.0) * (high - low)
    }

    fn pressure_rate(&self, kilopascal_per_s: f64) -> f64 {
        kilopascal_per_s / REFERENCE_KPA * (self.pressure_pa.1 - self.pressure_pa.0).max(1e3)
    }

    fn distance(&self, millimeters: f64) -> f64 {
        millimeters * 1e-3 * self.model.muscle().rest_length_m / REFERENCE_LENGTH_M
    }

    fn length(&self, contraction: f64) -> f64 {
        let (short, long) = self.length_m;
        let (from, to) = REFERENCE_CONTRACTION;
        long + ((contraction - from) / (to - from)).clamp(0.0, 1.0) * (short - long)
    }

    fn is_taut(&self, pressure_pa: f64, length_m: f64) -> bool {
        self.lowest_tension_n == f64::NEG_INFINITY
            || self.model.force_n(pressure_pa, length_m, 1.0) >= self.lowest_tension_n
    }

    /// The length nearest to that of a contraction at which the muscle is taut; none if it is slack at any.
    fn taut_length(&self, pressure_pa: f64, contraction: f64) -> Option<f64> {
        let wanted = self.length(contraction);
        if self.is_taut(pressure_pa, wanted) {
            return Some(wanted);
        }
        let (mut slack, mut taut) = (wanted, self.length_m.1);
        if !self.is_taut(pressure_pa, taut) {
            return None;
        }
        while taut - slack > 1e-5 {
            let middle = 0.5 * (taut + slack);
            if self.is_taut(pressure_pa, middle) { taut = middle } else { slack = middle }
        }
        Some(taut)
    }

    /// The lowest pressure at which the muscle is taut at a length; none if it is slack at any.
    fn taut_pressure(&self, length_m: f64) -> Option<f64> {
        let (mut slack, mut taut) = self.pressure_pa;
        if self.is_taut(slack, length_m) {
            return Some(slack);
        }
        if !self.is_taut(taut, length_m) {
            return None;
        }
        while taut - slack > 10.0 {
            let middle = 0.5 * (taut + slack);
            if self.is_taut(middle, length_m) { taut = middle } else { slack = middle }
        }
        Some(taut)
    }
}

/// A take under construction: each call goes on from where the last one ended.
#[derive(Debug, Clone)]
struct Path {
    knots: Vec<Knot>,
    at: Knot,
}

impl Path {
    fn from(pressure_pa: f64, length_m: f64) -> Self {
        let at = Knot { time_s: 0.0, pressure_pa, length_m };
        Self { knots: vec![at], at }
    }

    fn go(&mut self, pressure_pa: f64, length_m: f64, duration_s: f64) {
        if duration_s > 0.0 {
            self.at = Knot { time_s: self.at.time_s + duration_s, pressure_pa, length_m };
            self.knots.push(self.at);
        }
    }

    fn hold(&mut self, duration_s: f64) {
        self.go(self.at.pressure_pa, self.at.length_m, duration_s);
    }

    fn go_to_length(&mut self, length_m: f64, speed_m_per_s: f64) {
        self.go(self.at.pressure_pa, length_m, (length_m - self.at.length_m).abs() / speed_m_per_s);
    }

    fn go_to_pressure(&mut self, pressure_pa: f64, rate_pa_per_s: f64) {
        self.go(pressure_pa, self.at.length_m, (pressure_pa - self.at.pressure_pa).abs() / rate_pa_per_s);
    }

    fn take(self, pause_before_s: f64) -> Take {
        Take { pause_before_s, knots: self.knots }
    }
}

/// There and back `cycles` times between where the path is and `short_m`.
fn triangles(path: &mut Path, short_m: f64, cycles: usize, speed_m_per_s: f64) {
    let long_m = path.at.length_m;
    for _ in 0..cycles {
        path.go_to_length(short_m, speed_m_per_s);
        path.go_to_length(long_m, speed_m_per_s);
    }
}

fn null(reach: &Reach<'_>) -> Vec<Take> {
    let rest_m = reach.length(0.015);
    let low_pa = reach.taut_pressure(rest_m).unwrap_or(reach.pressure_pa.0);
    let mut path = Path::from(low_pa, rest_m);
    path.hold(30.0);
    for _ in 0..3 {
        path.go_to_length(reach.length_m.1, reach.distance(1.0));
        path.go_to_length(rest_m, reach.distance(1.0));
    }
    path.hold(30.0);
    vec![path.take(0.0)]
}

fn run_in(reach: &Reach<'_>) -> Vec<Take> {
    let staircase = |path: &mut Path| {
        for contraction in [0.05, 0.10, 0.15, 0.20] {
            if let Some(short_m) = reach.taut_length(path.at.pressure_pa, contraction) {
                triangles(path, short_m, 3, reach.distance(5.0));
            }
        }
    };
    let mut fresh = Path::from(reach.pressure(300.0), reach.length_m.1);
    let mut rested = fresh.clone();
    staircase(&mut fresh);
    staircase(&mut fresh);
    staircase(&mut rested);
    vec![fresh.take(0.0), rested.take(3600.0)]
}

/// At each level that leaves room, what `act` does with the length that the level allows.
fn at_levels(
    reach: &Reach<'_>,
    levels_kpa: &[f64],
    deepest: f64,
    long_m: f64,
    act: impl Fn(&mut Path, f64),
) -> Vec<Take> {
    let mut path: Option<Path> = None;
    for &level_kpa in levels_kpa {
        let pressure_pa = reach.pressure(level_kpa);
        let Some(short_m) = reach.taut_length(pressure_pa, deepest).filter(|short_m| *short_m < long_m) else {
            continue;
        };
        let path = path.get_or_insert_with(|| Path::from(pressure_pa, long_m));
        path.go_to_length(long_m, reach.distance(5.0));
        path.go_to_pressure(pressure_pa, reach.pressure_rate(LEVEL_KPA_PER_S));
        act(path, short_m);
    }
    path.map(|path| path.take(0.0)).into_iter().collect()
}

fn isobaric_triangles(reach: &Reach<'_>) -> Vec<Take> {
    let levels_kpa = [300.0, 60.0, 500.0, 100.0, 400.0, 200.0, 30.0];
    at_levels(reach, &levels_kpa, 0.21, reach.length_m.1, |path, short_m| {
        let long_m = path.at.length_m;
        triangles(path, short_m, 2, reach.distance(5.0));
        path.go_to_length(short_m, reach.distance(5.0));
        path.hold(10.0);
        path.go_to_length(long_m, reach.distance(5.0));
        path.hold(10.0);
    })
}

fn rate_ladder(reach: &Reach<'_>) -> Vec<Take> {
    at_levels(reach, &[100.0, 300.0, 450.0], 0.15, reach.length(0.05), |path, short_m| {
        for speed_mm_per_s in [0.5, 1.5, 5.0, 15.0, 50.0] {
            triangles(path, short_m, 3, reach.distance(speed_mm_per_s));
        }
    })
}

fn minor_loops(reach: &Reach<'_>) -> Vec<Take> {
    let pressure_pa = reach.pressure(300.0);
    let (center_m, long_m) = (reach.length(0.10), reach.length(0.05));
    let Some(short_m) = reach.taut_length(pressure_pa, 0.15).filter(|short_m| *short_m < center_m) else {
        return Vec::new();
    };
    let room_m = (center_m - short_m).min(reach.length_m.1 - center_m);
    let mut path = Path::from(pressure_pa, long_m);
    for speed_mm_per_s in [2.0, 10.0] {
        let speed_m_per_s = reach.distance(speed_mm_per_s);
        for amplitude_mm in [10.0, 5.0, 2.0, 1.0, 0.5, 1.0, 2.0, 5.0, 10.0] {
            let amplitude_m = reach.distance(amplitude_mm).min(room_m);
            path.go_to_length(center_m - amplitude_m, speed_m_per_s);
            path.go_to_length(center_m + amplitude_m, speed_m_per_s);
            path.go_to_length(center_m, speed_m_per_s);
        }
    }
    path.go_to_length(long_m, reach.distance(5.0));
    for share in [1.0, 0.8, 0.6, 0.4, 0.2] {
        triangles(&mut path, long_m + share * (short_m - long_m), 1, reach.distance(5.0));
    }
    vec![path.take(0.0)]
}

fn length_steps(reach: &Reach<'_>) -> Vec<Take> {
    at_levels(reach, &[100.0, 300.0, 450.0], 0.20, reach.length_m.1, |path, _| {
        for contraction in [0.0, 0.12, 0.05, 0.20, 0.10, 0.02, 0.15, 0.0] {
            if let Some(length_m) = reach.taut_length(path.at.pressure_pa, contraction) {
                path.go_to_length(length_m, reach.distance(100.0));
                path.hold(60.0);
            }
        }
    })
}

/// A take at each contraction, from the lowest pressure at which the muscle is taut.
fn at_lengths(reach: &Reach<'_>, contractions: &[f64], act: impl Fn(&mut Path)) -> Vec<Take> {
    contractions
        .iter()
        .filter_map(|&contraction| {
            let length_m = reach.length(contraction);
            let mut path = Path::from(reach.taut_pressure(length_m)?, length_m);
            act(&mut path);
            Some(path.take(PAUSE_S))
        })
        .collect()
}

fn isometric_ramps(reach: &Reach<'_>) -> Vec<Take> {
    at_lengths(reach, &[0.0, 0.05, 0.10, 0.15, 0.20], |path| {
        let low_pa = path.at.pressure_pa;
        // Slow where the bladder comes to lie on the braid.
        let knee_pa = reach.pressure(120.0).max(low_pa);
        let (slow, fast) = (reach.pressure_rate(10.0), reach.pressure_rate(50.0));
        for _ in 0..2 {
            path.go_to_pressure(knee_pa, slow);
            path.go_to_pressure(reach.pressure_pa.1, fast);
            path.go_to_pressure(knee_pa, fast);
            path.go_to_pressure(low_pa, slow);
        }
        for _ in 0..3 {
            path.go_to_pressure(knee_pa, slow);
            path.go_to_pressure(low_pa, slow);
        }
    })
}

fn pressure_steps(reach: &Reach<'_>) -> Vec<Take> {
    at_lengths(reach, &[0.02, 0.10, 0.18], |path| {
        let low_pa = path.at.pressure_pa;
        for level_kpa in [100.0, 400.0, 200.0, 500.0, 300.0, 50.0, 350.0] {
            path.go_to_pressure(reach.pressure(level_kpa).max(low_pa), reach.pressure_rate(500.0));
            path.hold(60.0);
        }
    })
}

/// Follows `curve` (phase in rad, frequency in Hz and share of the time in) while the frequency rises by equal factors in
/// equal times; so many knots in every period.
fn chirp(path: &mut Path, from_hz: f64, to_hz: f64, duration_s: f64, curve: impl Fn(f64, f64, f64) -> (f64, f64)) {
    const KNOTS_PER_PERIOD: f64 = 20.0;
    let e_folds_per_s = (to_hz / from_hz).ln() / duration_s;
    let mut time_s = 0.0;
    while time_s < duration_s {
        let frequency_hz = from_hz * (e_folds_per_s * time_s).exp();
        let step_s = 1.0 / (KNOTS_PER_PERIOD * frequency_hz);
        time_s += step_s;
        let frequency_hz = from_hz * (e_folds_per_s * time_s).exp();
        let (pressure_pa, length_m) =
            curve(TAU * (frequency_hz - from_hz) / e_folds_per_s, frequency_hz, time_s / duration_s);
        path.go(pressure_pa, length_m, step_s);
    }
}

fn pressure_chirp(reach: &Reach<'_>) -> Vec<Take> {
    let high_pa = reach.pressure(400.0);
    [0.02, 0.10, 0.18]
        .iter()
        .filter_map(|&contraction| {
            let length_m = reach.length(contraction);
            let low_pa = reach.taut_pressure(length_m).filter(|low_pa| *low_pa < high_pa)?.max(reach.pressure(100.0));
            let (center_pa, amplitude_pa) = (0.5 * (low_pa + high_pa), 0.5 * (high_pa - low_pa));
            let mut path = Path::from(center_pa, length_m);
            // Above 1 Hz the swing gets smaller, as it does behind a valve.
            chirp(&mut path, 0.05, 10.0, 120.0, |phase, hertz, _| {
                (center_pa + amplitude_pa / hertz.max(1.0) * phase.sin(), length_m)
            });
            Some(path.take(PAUSE_S))
        })
        .collect()
}

fn length_chirp(reach: &Reach<'_>) -> Vec<Take> {
    at_levels(reach, &[100.0, 300.0, 450.0], 0.14, reach.length(0.06), |path, short_m| {
        let (pressure_pa, long_m) = (path.at.pressure_pa, path.at.length_m);
        let (center_m, amplitude_m) = (0.5 * (short_m + long_m), 0.5 * (long_m - short_m));
        path.go_to_length(center_m, reach.distance(5.0));
        chirp(path, 0.05, 8.0, 120.0, |phase, _, share| {
            (pressure_pa, center_m - amplitude_m * 0.075_f64.powf(share) * phase.sin())
        });
    })
}

/// A sum of sines up to `highest_hz` in [0, 1]; phases at steps of an irrational number neither repeat nor heap up.
fn wander(highest_hz: f64, step: f64, duration_s: f64) -> impl Fn(f64) -> f64 {
    const LINES: i32 = 14;
    // Above it lines get weaker, so that speeds stay those of a bench.
    const CORNER_HZ: f64 = 0.2;
    let highest_line = highest_hz * duration_s;
    let lines: Vec<(f64, f64, f64)> = (0..LINES)
        .map(|line| {
            let hertz = highest_line.powf(f64::from(line) / f64::from(LINES - 1)).round() / duration_s;
            let index = f64::from(line);
            (hertz, 1.0 / (1.0 + (hertz / CORNER_HZ).powi(2)).sqrt(), TAU * (index * index * step).fract())
        })
        .collect();
    let sum =
        move |time_s: f64| lines.iter().map(|(hertz, size, phase)| size * (TAU * hertz * time_s + phase).sin()).sum();
    let (low, high) = (0..4000)
        .map(|index| sum(f64::from(index) / 4000.0 * duration_s))
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value: f64| (low.min(value), high.max(value)));
    move |time_s| ((sum(time_s) - low) / (high - low)).clamp(0.0, 1.0)
}

fn multisine(reach: &Reach<'_>) -> Vec<Take> {
    const DURATION_S: f64 = 240.0;
    const STEP_S: f64 = 0.04;
    const INTERVALS: usize = 64;
    let pressure = wander(1.0, 0.618_034, DURATION_S);
    let length = wander(0.8, 0.414_214, DURATION_S);
    let long_m = reach.length(0.0);
    let Some(short_m) = reach.taut_length(reach.pressure(250.0), 0.21).filter(|short_m| *short_m < long_m) else {
        return Vec::new();
    };
    // The lowest pressure at which the muscle is taut, as a table over length.
    let floors_pa: Vec<f64> = (0..=INTERVALS)
        .map(|index| {
            let length_m = long_m + index as f64 / INTERVALS as f64 * (short_m - long_m);
            reach.taut_pressure(length_m).unwrap_or(reach.pressure_pa.1)
        })
        .collect();
    let at = |time_s: f64| {
        let share = length(time_s);
        let index = ((share * INTERVALS as f64) as usize).min(INTERVALS - 1);
        let floor_pa = floors_pa[index].max(floors_pa[index + 1]);
        (reach.pressure(15.0 + 475.0 * pressure(time_s)).max(floor_pa), long_m + share * (short_m - long_m))
    };
    let (pressure_pa, length_m) = at(0.0);
    let mut path = Path::from(pressure_pa, length_m);
    for index in 1..=(DURATION_S / STEP_S) as usize {
        let (pressure_pa, length_m) = at(index as f64 * STEP_S);
        path.go(pressure_pa, length_m, STEP_S);
    }
    vec![path.take(0.0)]
}

/// The length follows from the balance of forces, friction left out: the load cylinder of the real bench decides.
fn isotonic(reach: &Reach<'_>) -> Vec<Take> {
    let (short_m, long_m) = (reach.length(0.21), reach.length(0.0));
    let highest_n = reach.model.force_n(reach.pressure_pa.1, long_m, 0.0);
    let mut takes = Vec::new();
    // 20, 60, 120 and 250 N of the reference muscle, which pulls 900 N.
    for load_n in [0.022, 0.067, 0.13, 0.28].map(|share| share * highest_n) {
        let length_at = |pressure_pa: f64| {
            let surplus_n = |length_m| reach.model.force_n(pressure_pa, length_m, 0.0) - load_n;
            let (mut slack, mut taut) = (short_m, long_m);
            if surplus_n(short_m) >= 0.0 {
                return short_m;
            }
            while taut - slack > 1e-6 {
                let middle = 0.5 * (slack + taut);
                if surplus_n(middle) >= 0.0 { taut = middle } else { slack = middle }
            }
            taut
        };
        let loaded = Reach { lowest_tension_n: load_n, ..*reach };
        let Some(low_pa) = loaded.taut_pressure(long_m) else { continue };
        let high_pa = loaded.taut_pressure(short_m).unwrap_or(reach.pressure_pa.1);
        if high_pa - low_pa < 0.02 * reach.pressure_pa.1 {
            continue;
        }
        let mut path = Path::from(low_pa, length_at(low_pa));
        const STEPS: usize = 60;
        for way in 0..4 {
            for index in 1..=STEPS {
                let share = index as f64 / STEPS as f64;
                let share = if way % 2 == 0 { share } else { 1.0 - share };
                let pressure_pa = low_pa + share * (high_pa - low_pa);
                let duration_s = (high_pa - low_pa) / STEPS as f64 / reach.pressure_rate(25.0);
                path.go(pressure_pa, length_at(pressure_pa), duration_s);
            }
        }
        takes.push(path.take(PAUSE_S));
    }
    takes
}

fn endurance(reach: &Reach<'_>) -> Vec<Take> {
    let long_m = reach.length(0.02);
    let probe_pa = reach.pressure(200.0);
    let Some(probe_m) = reach.taut_length(probe_pa, 0.18).filter(|short_m| *short_m < long_m) else {
        return Vec::new();
    };
    let rate_pa_per_s = reach.pressure_rate(50.0);
    let probe = |path: &mut Path| {
        path.go_to_pressure(probe_pa, rate_pa_per_s);
        triangles(path, probe_m, 1, reach.distance(5.0));
    };
    let mut path = Path::from(probe_pa, long_m);
    probe(&mut path);
    for block in 1..=20 {
        let block_pa = reach.pressure(if block % 2 == 1 { 150.0 } else { 400.0 });
        let Some(short_m) = reach.taut_length(block_pa, 0.18).filter(|short_m| *short_m < long_m) else { continue };
        path.go_to_pressure(block_pa, rate_pa_per_s);
        // One second from end to end.
        triangles(&mut path, short_m, 10, long_m - short_m);
        if block % 5 == 0 {
            probe(&mut path);
        }
    }
    let mut takes = vec![path.take(0.0)];
    for _ in 0..3 {
        let mut path = Path::from(probe_pa, long_m);
        probe(&mut path);
        takes.push(path.take(600.0));
    }
    takes
}

fn dwell(reach: &Reach<'_>) -> Vec<Take> {
    let pressure_pa = reach.pressure(300.0);
    let (long_m, short_m) = (reach.length(0.08), reach.length(0.12));
    if !reach.is_taut(pressure_pa, short_m) {
        return Vec::new();
    }
    let mut path = Path::from(pressure_pa, long_m);
    for wait_s in [0.1, 1.0, 10.0, 100.0] {
        for share in [0.5, 1.0] {
            path.go_to_length(long_m + share * (short_m - long_m), reach.distance(1.0));
            path.hold(wait_s);
        }
        path.go_to_length(long_m, reach.distance(1.0));
        path.hold(wait_s);
    }
    vec![path.take(0.0)]
}
