//! Shards give what one process gives, wherever a recording is cut.
//!
//! The figures of `scripts/fleet/RESULTS.md` under "Shards" are printed here, with
//! `cargo test --release -p pam-identification --test shards -- --ignored --nocapture`.

#![expect(clippy::print_stdout, clippy::unwrap_used, reason = "a test that fails may panic, and says what it measured")]

use pam_artifact::Tool;
use pam_artifact::agreement::AgreementArtifact;
use pam_artifact::model::ModelArtifact;
use pam_artifact::summary::{Shard, SummaryArtifact};
use pam_identification::fit::FitOptions;
use pam_identification::identify::{Request, check};
use pam_identification::shards::{Head, ShardError, Step, advance, summarize};
use pam_muscle::MuscleFile;
use pam_recording::{CHUNK_ROWS, Recording, Repairs, Samples, sha256_hex};
use pam_virtual_bench::{Bench, Concealed, Options, TrueMuscle, command};
use rand::{RngExt, SeedableRng};

/// Passes after which a question should have been settled.
const MOST_PASSES: usize = 12;

/// Columns of a recording that is cut.
#[derive(Default, Clone)]
struct Log {
    time_s: Vec<f64>,
    pressure_pa: Vec<f64>,
    length_m: Vec<f64>,
    force_n: Vec<f64>,
}

impl Log {
    fn n_rows(&self) -> usize {
        self.time_s.len()
    }

    /// Goes on with `next`, `pause_s` after the last row.
    fn append(&mut self, next: &Self, pause_s: f64) {
        let shift_s = self.time_s.last().map_or(0.0, |last| last + pause_s - next.time_s[0]);
        self.time_s.extend(next.time_s.iter().map(|time_s| time_s + shift_s));
        self.pressure_pa.extend(&next.pressure_pa);
        self.length_m.extend(&next.length_m);
        self.force_n.extend(&next.force_n);
    }

    /// Rows as a file of them alone is read: gaps split it.
    fn recording(&self, name: &str, rows: std::ops::Range<usize>) -> Recording {
        let time_s = &self.time_s[rows.clone()];
        let breaks = (1..time_s.len()).filter(|&row| time_s[row] - time_s[row - 1] > 0.2);
        let bounds: Vec<usize> = std::iter::once(0).chain(breaks).chain([time_s.len()]).collect();
        let [pressure_pa, length_m, force_n] =
            [&self.pressure_pa, &self.length_m, &self.force_n].map(|column| &column[rows.clone()]);
        Recording {
            path: name.to_owned(),
            sha256: sha256_hex(format!("{name} {rows:?}").as_bytes()),
            samples: Samples::from_columns(time_s, pressure_pa, length_m, force_n),
            segments: bounds.windows(2).map(|pair| pair[0]..pair[1]).collect(),
            repairs: Repairs { gaps: bounds.len() as u64 - 2, ..Repairs::default() },
            ignored_columns: Vec::new(),
        }
    }
}

/// What the bench logs of a protocol, with an effect concealed where one is named.
fn log(protocol: &str, duration_scale: f64, seed: u64, effect: Option<&str>) -> Log {
    let muscle = TrueMuscle::nominal();
    let options = Options { duration_scale, seed, ..Options::default() };
    let concealed: Vec<Concealed> =
        effect.map(|id| Concealed { id: id.to_owned(), severity: 1.0 }).into_iter().collect();
    let bench = Bench::new(muscle.clone(), command(protocol, &muscle, &options).unwrap());
    let log = bench.with_effects(&concealed, 5).unwrap().record(seed);
    Log { time_s: log.time_s, pressure_pa: log.pressure_pa, length_m: log.length_m, force_n: log.force_n }
}

/// Protocols one after the other until there are `n_rows`, `pause_s` apart.
fn long(n_rows: usize, pause_s: f64, effect: Option<&str>) -> Log {
    let protocols =
        ["isobaric-triangles", "isometric-ramps", "minor-loops", "length-steps", "pressure-steps", "multisine"];
    let mut all = Log::default();
    for seed in 1.. {
        for protocol in protocols {
            all.append(&log(protocol, 0.3, seed, effect), pause_s);
            if all.n_rows() >= n_rows {
                return all;
            }
        }
    }
    all
}

fn request(estimation: Vec<Recording>) -> Request {
    let muscle = TrueMuscle::nominal();
    let file = MuscleFile {
        name: None,
        muscle: muscle.muscle().clone(),
        fit: Vec::new(),
        strand_modulus_pa: muscle.contact_modulus_pa(),
    };
    Request::of(estimation, file, FitOptions::default())
}

fn tool() -> Tool {
    Tool { name: "test".to_owned(), version: "1".to_owned() }
}

fn whole(recordings: Vec<Recording>) -> ModelArtifact {
    let checked = check(request(recordings)).unwrap();
    let config = checked.config();
    checked.identify().unwrap().artifact(tool(), Vec::new(), config, 1)
}

/// A shard and its rows.
fn shards_of(log: &Log, name: &str, cuts: &[usize]) -> Vec<(Shard, Recording)> {
    let bounds: Vec<usize> = std::iter::once(0).chain(cuts.iter().copied()).chain([log.n_rows()]).collect();
    let of = bounds.len() - 1;
    let shard = |(index, pair): (usize, &[usize])| {
        let recording = log.recording(name, pair[0]..pair[1]);
        let (path, sha256) = (format!("{name}-{}.csv", index + 1), recording.sha256.clone());
        (Shard { recording: name.to_owned(), number: index + 1, of, path, sha256 }, recording)
    };
    bounds.windows(2).enumerate().map(shard).collect()
}

fn summaries(
    shards: &[(Shard, Recording)],
    agreement: Option<&AgreementArtifact>,
) -> Result<Vec<SummaryArtifact>, ShardError> {
    let head = Head { tool: tool(), inputs: Vec::new(), reading_sha256: String::new() };
    let muscle = request(Vec::new()).muscle;
    let of =
        |(shard, recording): &(Shard, Recording)| summarize(recording, shard.clone(), &muscle, agreement, head.clone());
    shards.iter().map(of).collect()
}

/// The model of shards, how many passes it took, and the share of all rows that summaries held as they are.
fn sharded(shards: &[(Shard, Recording)]) -> (ModelArtifact, usize, f64) {
    let mut agreement: Option<AgreementArtifact> = None;
    let n_rows: usize = shards.iter().map(|(_, recording)| recording.samples.n_rows()).sum();
    for pass in 1..=MOST_PASSES {
        let answers = summaries(shards, agreement.as_ref()).unwrap();
        let handed: usize = answers.iter().flat_map(|answer| &answer.edges).map(|rows| rows.time_s.len()).sum();
        match advance(request(Vec::new()), agreement.take(), &answers, &|| {}).unwrap() {
            Step::Ask(next) => agreement = Some(*next),
            Step::Done(found, config) => {
                return (found.artifact(tool(), Vec::new(), config, 1), pass, handed as f64 / n_rows as f64);
            }
        }
    }
    panic!("not settled after {MOST_PASSES} passes");
}

/// Largest relative difference of a value, and of a standard error; and of the figures of the fit.
fn difference(one: &ModelArtifact, other: &ModelArtifact) -> [f64; 3] {
    let apart = |one: f64, other: f64| (one - other).abs() / one.abs().max(f64::MIN_POSITIVE);
    assert_eq!(one.direction, other.direction);
    assert_eq!(one.fit.estimation.n_samples, other.fit.estimation.n_samples);
    assert_eq!(one.fit.estimation.n_unsettled, other.fit.estimation.n_unsettled);
    assert_eq!(one.domain, other.domain);
    for (one, other) in one.quality.iter().zip(&other.quality) {
        assert_eq!((&one.channels, one.period_s, one.duration_s), (&other.channels, other.period_s, other.duration_s));
    }
    let mut largest = [0.0_f64; 3];
    for (one, other) in one.parameters.iter().zip(&other.parameters) {
        assert_eq!((&one.name, one.status), (&other.name, other.status));
        if one.value != other.value {
            largest[0] = largest[0].max(apart(one.value, other.value));
        }
        if let Some((one, other)) = one.stderr.zip(other.stderr) {
            largest[1] = largest[1].max(apart(one, other));
        }
    }
    for (one, other) in one.composites.iter().zip(&other.composites) {
        largest[0] = largest[0].max(apart(one.value, other.value));
    }
    let figures = |model: &ModelArtifact| {
        let fit = &model.fit.estimation;
        [fit.rmse_n, fit.rmse_all_n, fit.max_n, fit.fit_percent, model.fit.noise_floor_n, model.fit.effective_samples]
    };
    for (one, other) in figures(one).into_iter().zip(figures(other)) {
        largest[2] = largest[2].max(apart(one, other));
    }
    largest
}

/// Cuts `n_cuttings` times at random, one to five cuts each, and says how large a difference was found.
fn prove(name: &str, log: &Log, beside: &Log, n_cuttings: u64, special: &[usize]) {
    let expected = whole(vec![log.recording(name, 0..log.n_rows()), beside.recording("beside", 0..beside.n_rows())]);
    let (mut largest, mut most_passes, mut most_handed) = ([0.0_f64; 3], 0, 0.0_f64);
    for seed in 0..n_cuttings {
        let mut generator = rand_pcg::Pcg64::seed_from_u64(seed);
        let mut cuts: Vec<usize> =
            (0..generator.random_range(1..5)).map(|_| generator.random_range(1..log.n_rows())).collect();
        // One of the places that matter: in a motion, in a hold, at a gap, at a border.
        cuts.push(special[seed as usize % special.len()]);
        cuts.sort_unstable();
        cuts.dedup();
        let mut shards = shards_of(log, name, &cuts);
        shards.extend(shards_of(beside, "beside", &[]));
        let (found, passes, handed) = sharded(&shards);
        let now = difference(&expected, &found);
        assert!(now.iter().all(|difference| *difference < 1e-9), "{name} cut at {cuts:?}: {now:?}");
        largest = std::array::from_fn(|index| largest[index].max(now[index]));
        most_passes = most_passes.max(passes);
        most_handed = most_handed.max(handed);
    }
    println!(
        "{name}: {} rows, {n_cuttings} cuttings, at most {most_passes} passes; largest relative difference of a parameter \
         {:.1e}, of a standard error {:.1e}, of a figure of the fit {:.1e}; rows handed over {:.1} %",
        log.n_rows(),
        largest[0],
        largest[1],
        largest[2],
        100.0 * most_handed
    );
}

/// Rows in the middle of the longest rest and of the longest motion.
fn middles(log: &Log) -> [usize; 2] {
    let longest = |still: bool| {
        let (mut best, mut start) = (0..0, 0);
        for row in 10..log.n_rows() {
            let moves = (log.length_m[row] - log.length_m[row - 10]).abs() > 2e-5;
            if moves == still {
                start = row;
            } else if row - start > best.len() {
                best = start..row;
            }
        }
        usize::midpoint(best.start, best.end)
    };
    [longest(true), longest(false)]
}

/// A log with gaps, and where to cut it: in a rest, in a motion, at a gap, beside one, at the border of a chunk.
fn gapped(n_rows: usize, effect: Option<&str>) -> (Log, Vec<usize>) {
    let log = long(n_rows, 3.0, effect);
    let [rest, motion] = middles(&log);
    let at_gap = (n_rows / 3..log.n_rows()).find(|&row| log.time_s[row] - log.time_s[row - 1] > 1.0).unwrap();
    (log, vec![rest, motion, at_gap, at_gap + 1, 4 * CHUNK_ROWS])
}

#[test]
fn shards_of_a_recording_with_gaps_give_what_it_gives() {
    let beside = log("isobaric-triangles", 0.5, 77, None);
    let (long, special) = gapped(120_000, None);
    prove("with gaps", &long, &beside, 6, &special);
}

#[test]
fn shards_give_the_same_where_an_effect_is_concealed() {
    let effect = Some("presliding-hysteresis");
    let beside = log("isobaric-triangles", 0.5, 77, effect);
    let (long, special) = gapped(120_000, effect);
    prove("with a concealed effect", &long, &beside, 4, &special);
}

#[test]
#[ignore = "takes minutes; prints the figures of RESULTS.md"]
fn fifty_cuttings_give_what_the_whole_gives() {
    for effect in [None, Some("presliding-hysteresis")] {
        let beside = log("isobaric-triangles", 0.5, 77, effect);
        let (with_gaps, special) = gapped(300_000, effect);
        let name = if effect.is_none() { "with gaps" } else { "with gaps and a concealed effect" };
        prove(name, &with_gaps, &beside, 20, &special);
        let without = long(1_400_000, 0.005, effect);
        let [rest, motion] = middles(&without);
        let name = if effect.is_none() { "without a gap" } else { "without a gap, with a concealed effect" };
        prove(name, &without, &beside, 5, &[rest, motion, 1 << 18, (1 << 18) + 1, 1 << 19]);
    }
}
