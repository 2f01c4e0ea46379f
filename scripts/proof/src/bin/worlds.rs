//! Write cases of the independent bench: recordings, muscle files, and the truth apart.

use std::path::PathBuf;

use anyhow::{Context, Result, ensure};
use clap::{Parser, ValueEnum};
use pam_worlds::case::{CaseKind, Request};
use pam_worlds::catalogue::Half;
use pam_worlds::world::Bench;

/// Write cases of a virtual bench that shares nothing with the fitter.
///
/// Every case is a world of its own: muscle, rubber, friction, sensors and protocols are drawn, and one effect is concealed in
/// it, or two, none, or one that no catalogue has. Equal seeds write equal bytes.
#[derive(Debug, Parser)]
#[command(version, after_help = "Example:\n  worlds --out out/worlds --cases 100 --seed 1 --half choose")]
struct Args {
    /// Folder to write to.
    #[arg(long, value_name = "DIR")]
    out: PathBuf,

    /// Cases to draw.
    #[arg(long, value_name = "N", default_value_t = 100)]
    cases: usize,

    /// Seed of every draw.
    #[arg(long, value_name = "S", default_value_t = 1)]
    seed: u64,

    /// Half of the forms: one to choose methods by, one to report outcomes on; or the third part, with other worlds as well.
    #[arg(long, default_value = "choose")]
    half: HalfArg,

    /// Only one of the two benches.
    #[arg(long)]
    bench: Option<BenchArg>,

    /// Only cases of one kind.
    #[arg(long)]
    kind: Option<KindArg>,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum HalfArg {
    Choose,
    Report,
    Sealed,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum BenchArg {
    Lumped,
    Slices,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum KindArg {
    Nothing,
    One,
    Two,
    Nameless,
}

fn run(args: &Args) -> Result<()> {
    ensure!(args.cases > 0, "no cases asked for");
    let request = Request {
        seed: args.seed,
        cases: args.cases,
        half: match args.half {
            HalfArg::Choose => Half::Choose,
            HalfArg::Report => Half::Report,
            HalfArg::Sealed => Half::Sealed,
        },
        bench: args.bench.map(|bench| match bench {
            BenchArg::Lumped => Bench::Lumped,
            BenchArg::Slices => Bench::Slices,
        }),
        kind: args.kind.map(|kind| match kind {
            KindArg::Nothing => CaseKind::Nothing,
            KindArg::One => CaseKind::One,
            KindArg::Two => CaseKind::Two,
            KindArg::Nameless => CaseKind::Nameless,
        }),
    };
    pam_worlds::write::write_all(&args.out, &request)
        .with_context(|| format!("cannot write {}", args.out.display()))?;
    Ok(())
}

fn main() -> Result<()> {
    run(&Args::parse())
}
