//! Curves of panels a and b through means at levels of the other channel.

use super::Role;

/// Means of one recording at one level, in one direction.
#[derive(Debug)]
pub(super) struct Mean {
    pub(super) level: usize,
    pub(super) contracting: bool,
    pub(super) at: f64,
    pub(super) force_n: f64,
    pub(super) model_n: f64,
    pub(super) role: Role,
}

/// One level in one direction, over recordings.
#[derive(Debug)]
pub(super) struct Curve {
    pub(super) level: usize,
    pub(super) contracting: bool,
    /// Modelled force over the abscissa.
    pub(super) model: Vec<(f64, f64)>,
    /// Abscissa and measured force at the right end.
    pub(super) end: (f64, f64),
}

/// Curves through means; recordings closer than `same` are averaged.
pub(super) fn curves(means: &[Mean], same: f64) -> Vec<Curve> {
    let levels = means.iter().map(|mean| mean.level + 1).max().unwrap_or(0);
    let mut curves = Vec::new();
    for level in 0..levels {
        for contracting in [true, false] {
            let mut sorted: Vec<&Mean> =
                means.iter().filter(|mean| mean.level == level && mean.contracting == contracting).collect();
            sorted.sort_by(|a, b| a.at.total_cmp(&b.at));
            let groups = sorted.chunk_by(|a, b| b.at - a.at <= same);
            let mut model = Vec::new();
            let mut end = (f64::NAN, f64::NAN);
            for group in groups {
                let count = group.len() as f64;
                let mean = |of: fn(&Mean) -> f64| group.iter().map(|mean| of(mean)).sum::<f64>() / count;
                end = (mean(|mean| mean.at), mean(|mean| mean.force_n));
                model.push((end.0, mean(|mean| mean.model_n)));
            }
            if !model.is_empty() {
                curves.push(Curve { level, contracting, model, end });
            }
        }
    }
    curves
}
