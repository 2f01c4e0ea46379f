//! What the bench hands over: a log, and beside it the truth that no logger sees.

use std::io::Write;

/// One run of the bench; all columns have the same number of rows.
#[derive(Debug, Clone, PartialEq)]
pub struct BenchRecording {
    /// Time stamps, in s.
    pub time_s: Vec<f64>,
    /// Gauge pressure as measured, in Pa.
    pub pressure_pa: Vec<f64>,
    /// Length as measured, in m.
    pub length_m: Vec<f64>,
    /// Tension as measured, in N.
    pub force_n: Vec<f64>,
    /// Pressure at the gauge, in Pa.
    pub true_pressure_pa: Vec<f64>,
    /// Length at the drive, in m.
    pub true_length_m: Vec<f64>,
    /// Tension of the muscle, in N.
    pub true_force_n: Vec<f64>,
    /// Pressure that the gauge would log without noise and quantization, in Pa: late or wrong where an effect makes it so.
    pub ideal_pressure_pa: Vec<f64>,
    /// Length that would be logged without noise and quantization, in m.
    pub ideal_length_m: Vec<f64>,
    /// Tension that the load cell would log without noise and quantization, in N.
    pub ideal_force_n: Vec<f64>,
    /// Direction of the braid's motion: +1 contracting, -1 extending.
    pub true_direction: Vec<f64>,
    pub(crate) decimals: Decimals,
}

/// Decimals with which each column is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Decimals {
    pub(crate) time_s: usize,
    pub(crate) pressure_kpa: usize,
    pub(crate) length_mm: usize,
    pub(crate) force_n: usize,
}

impl BenchRecording {
    /// Number of rows.
    pub fn n_samples(&self) -> usize {
        self.time_s.len()
    }

    /// Writes the log, without the truth: `time_s,pressure_kPa,length_mm,force_N`, each with the decimals
    /// that its sensor resolves.
    ///
    /// # Errors
    /// Those of `out`.
    pub fn write_csv(&self, out: &mut impl Write) -> std::io::Result<()> {
        let decimals = self.decimals;
        let mut table = csv::Writer::from_writer(out);
        table.write_record(["time_s", "pressure_kPa", "length_mm", "force_N"]).map_err(io_error)?;
        for index in 0..self.n_samples() {
            let row = [
                (self.time_s[index], decimals.time_s),
                (without_minus_zero(self.pressure_pa[index] * 1e-3), decimals.pressure_kpa),
                (self.length_m[index] * 1e3, decimals.length_mm),
                (without_minus_zero(self.force_n[index]), decimals.force_n),
            ];
            table.write_record(row.map(|(value, decimals)| format!("{value:.decimals$}"))).map_err(io_error)?;
        }
        table.flush()
    }
}

/// The error of what is written to, which the writer of the table wraps.
fn io_error(error: csv::Error) -> std::io::Error {
    match error.into_kind() {
        csv::ErrorKind::Io(error) => error,
        kind => std::io::Error::other(format!("{kind:?}")),
    }
}

/// A reading of nothing is written without a sign.
fn without_minus_zero(value: f64) -> f64 {
    value + 0.0
}
