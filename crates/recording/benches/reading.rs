//! Cost of reading a recording beside walking over the same file with `csv` and parsing each field.

#![expect(clippy::unwrap_used, reason = "a benchmark may panic")]

use std::fmt::Write as _;
use std::path::Path;

use divan::Bencher;
use divan::counter::ItemsCount;
use pam_recording::{ReadOptions, read_recording};

const N_ROWS: usize = 1_000_000;

fn main() {
    divan::main();
}

/// A log as the virtual bench writes it at 1 kHz: pressure in a triangle, length and force after it.
fn write_log(path: &Path) {
    let mut text = "time_s,pressure_kPa,length_mm,force_N\n".to_owned();
    for row in 0..N_ROWS {
        let phase = (row % 20_000) as f64 / 10_000.0 - 1.0;
        let (pressure_kpa, length_mm) = (600.0 * phase.abs(), 200.0 - 30.0 * phase * phase);
        let force_n = 3.0 * pressure_kpa - 20.0 * (200.0 - length_mm);
        writeln!(text, "{:.3},{pressure_kpa:.2},{length_mm:.3},{force_n:.2}", row as f64 * 1e-3).unwrap();
    }
    std::fs::write(path, text).unwrap();
}

fn bench_on_log(bencher: Bencher<'_, '_>, read: impl Fn(&Path) -> usize + Sync) {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("log.csv");
    write_log(&path);
    bencher.counter(ItemsCount::new(N_ROWS)).bench(|| {
        let n_rows = read(&path);
        assert_eq!(n_rows, N_ROWS);
    });
}

/// Splits, parses, checks, hashes, repairs and keeps.
#[divan::bench(sample_count = 15)]
fn recording(bencher: Bencher<'_, '_>) {
    bench_on_log(bencher, |path| read_recording(path, &ReadOptions::default()).unwrap().samples.n_rows());
}

/// Splits, parses and keeps.
#[divan::bench(sample_count = 15)]
fn csv_records(bencher: Bencher<'_, '_>) {
    bench_on_log(bencher, |path| {
        let mut reader = csv::Reader::from_path(path).unwrap();
        let mut columns: [Vec<f64>; 4] = Default::default();
        let mut record = csv::ByteRecord::new();
        while reader.read_byte_record(&mut record).unwrap() {
            for (column, field) in columns.iter_mut().zip(&record) {
                column.push(std::str::from_utf8(field).unwrap().parse::<f64>().unwrap());
            }
        }
        divan::black_box(&columns)[0].len()
    });
}
