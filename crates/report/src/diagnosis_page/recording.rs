//! The samples of one recording.

/// Samples of one recording, thinned to some ten thousand; all columns have one entry per sample. Samples with a
/// force that is not finite are left out.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct PageRecording {
    /// Name to show, such as the file's.
    pub name: String,
    /// Time, in s.
    pub time_s: Vec<f64>,
    /// Gauge pressure, in kPa.
    pub pressure_kpa: Vec<f64>,
    /// Contraction, in %.
    pub contraction_percent: Vec<f64>,
    /// Size of the speed, in mm/s.
    pub speed_mm_per_s: Vec<f64>,
    /// Travel since the last reversal, in mm.
    pub travel_mm: Vec<f64>,
    /// Time since the last move, in s.
    pub rest_s: Vec<f64>,
    /// Cycle of motion, counted from 1.
    pub cycle: Vec<f64>,
    /// Measured tension, in N.
    pub force_n: Vec<f64>,
    /// Tension of the base model, in N.
    pub base_force_n: Vec<f64>,
    /// Tension of base model and effects, in N, where there are effects.
    pub model_force_n: Option<Vec<f64>>,
    /// Whether the direction of motion is settled; samples that are not are drawn over time alone.
    pub settled: Vec<bool>,
    /// Stretches of time to mark, from and to, in s.
    pub stretches: Vec<(f64, f64)>,
    /// Whether nothing was fitted to it.
    pub held_out: bool,
}

impl PageRecording {
    /// Columns drawn over time alone: force as measured and of two models, and whether a sample counts.
    pub fn over_time(
        name: String,
        [time_s, force_n, base_force_n, model_force_n]: [Vec<f64>; 4],
        settled: Vec<bool>,
    ) -> Self {
        let none = vec![0.0; time_s.len()];
        Self {
            name,
            pressure_kpa: none.clone(),
            contraction_percent: none.clone(),
            speed_mm_per_s: none.clone(),
            travel_mm: none.clone(),
            rest_s: none.clone(),
            cycle: none,
            time_s,
            force_n,
            base_force_n,
            model_force_n: Some(model_force_n),
            settled,
            ..Self::default()
        }
    }
}
