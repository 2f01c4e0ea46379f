//! How often the same sentence is chosen where blocks of recording are drawn anew.

use super::field::{Field, Products};
use super::screen::Said;
use pam_muscle::effects::Sentence;
use rayon::prelude::*;

/// Draws of blocks.
const DRAWS: u64 = 64;
/// Share of the draws in which what a sentence says must be chosen, whatever its numbers and its scale: the driver, and the driver with
/// its memory. Of the 47 first terms that this was chosen by, 39 of nameless mismatches and 8 of healthy muscles, 31 of the 32 with the
/// right driver are within the former, two of seven with a wrong one, and four of the healthy ones. Of seven with the right driver and a
/// wrong memory two are within the latter.
const LEAST_OF_DRIVER: f64 = 2.0 / 3.0;
/// See [`LEAST_OF_DRIVER`].
const LEAST_OF_MEMORY: f64 = 0.5;

/// Whether draws choose the driver of `said[index]`, and its memory, often enough to be believed, where they choose each in its share
/// of `shares`.
pub(super) fn is_steady(said: &[Said], shares: &[f64], index: usize) -> bool {
    let of = |is_alike: &dyn Fn(&Said) -> bool| -> f64 {
        said.iter().zip(shares).filter(|(other, _)| is_alike(other)).map(|(_, share)| share).sum()
    };
    of(&|other| other.has_driver_of(&said[index])) >= LEAST_OF_DRIVER
        && of(&|other| other.has_words_of(&said[index])) >= LEAST_OF_MEMORY
}

/// In how many draws each sentence of `said` is the best, of all draws: fitted to the blocks that were drawn, with repetition,
/// and judged on those that were not.
pub(super) fn chosen(field: &Field<'_>, said: &[Said]) -> Vec<f64> {
    let products: Vec<Option<Products>> = said.par_iter().map(|said| products(field, &said.sentence)).collect();
    let alone = field.alone();
    let winners: Vec<usize> = (0..DRAWS)
        .into_par_iter()
        .filter_map(|draw| {
            let times = times(draw, field.n_blocks());
            let drawn = field.drawn(&times)?;
            let nothing = field.out_of_bag(&alone, &drawn, &times)?;
            let gain = |products: &Option<Products>| -> f64 {
                let held_out = products.as_ref().and_then(|products| field.out_of_bag(products, &drawn, &times));
                held_out.map_or(f64::NEG_INFINITY, |held_out| nothing.log_ratio(&held_out))
            };
            let gains: Vec<f64> = products.iter().map(gain).collect();
            (0..gains.len()).max_by(|left, right| gains[*left].total_cmp(&gains[*right]))
        })
        .collect();
    let of = winners.len().max(1) as f64;
    (0..said.len()).map(|index| winners.iter().filter(|winner| **winner == index).count() as f64 / of).collect()
}

fn products(field: &Field<'_>, sentence: &Sentence) -> Option<Products> {
    field.products(&field.arguments(sentence), sentence.scale, &sentence.shape)
}

/// How often each of `n` blocks is drawn, `n` times with repetition. The draws are the same in every run.
fn times(draw: u64, n: usize) -> Vec<f64> {
    let mut times = vec![0.0; n];
    for index in 0..n {
        let block = (mixed((draw << 32) + index as u64) % n as u64) as usize;
        times[block] += 1.0;
    }
    times
}

/// A number that looks drawn at random (Steele, Lea and Flood, 2014, "SplitMix").
fn mixed(seed: u64) -> u64 {
    let mut z = seed.wrapping_add(1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

#[cfg(test)]
mod tests {
    use pam_muscle::effects::sentence::{Curve, Driver, Recall, Scale};

    use super::*;

    fn said(driver: Driver, memory: Recall, scale: Scale) -> Said {
        Said { sentence: Sentence { driver, memory, scale, shape: Curve::Line, seen: [0.0, 1.0] }, evidence: 9.0 }
    }

    #[test]
    fn a_driver_is_believed_that_two_draws_of_three_choose_and_a_memory_that_half_of_them_do() {
        let lag = |time_constant_s, scale| said(Driver::Pressure, Recall::Lag { time_constant_s }, scale);
        let plain = said(Driver::Pressure, Recall::None, Scale::One);
        let other = said(Driver::Contraction, Recall::None, Scale::One);
        let said = [lag(0.3, Scale::One), lag(0.5, Scale::Pressure), plain, other];
        // Numbers and scale are not asked for.
        assert!(is_steady(&said, &[0.0, 0.5, 0.17, 0.33], 0));
        assert!(!is_steady(&said, &[0.25, 0.24, 0.18, 0.33], 0), "the memory");
        assert!(!is_steady(&said, &[0.3, 0.3, 0.06, 0.34], 0), "the driver");
        assert!(!is_steady(&said, &[0.3, 0.3, 0.2, 0.2], 2), "another memory of the same driver");
    }

    #[test]
    fn a_draw_takes_as_many_blocks_as_there_are_and_leaves_a_third_out() {
        let n = 32;
        let left_out: usize = (0..DRAWS).map(|draw| times(draw, n).iter().filter(|times| **times == 0.0).count()).sum();
        assert!((0..DRAWS).all(|draw| times(draw, n).iter().sum::<f64>() == n as f64));
        let share = left_out as f64 / (DRAWS as f64 * n as f64);
        assert!((share - (-1.0_f64).exp()).abs() < 0.03, "{share}");
        assert_ne!(times(0, n), times(1, n));
    }
}
