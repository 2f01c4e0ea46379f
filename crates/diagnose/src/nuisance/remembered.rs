//! Rows of nuisances and their products with one another, which every fit over the same instants has in common.

use std::ops::Range;
use std::sync::{Arc, Mutex, PoisonError};

use nalgebra::DMatrix;

/// Sets of instants whose blocks are kept: all that count, and those that a search for a shape looks at.
const KEPT: usize = 2;

/// Nuisances over the instants of a block.
#[derive(Debug)]
pub(crate) struct NuisanceBlock {
    /// The row of an instant in each column.
    pub(crate) rows: Arc<DMatrix<f64>>,
    /// Products of the nuisances with one another.
    pub(crate) products: DMatrix<f64>,
}

/// Blocks of the sets of instants that were last asked for.
#[derive(Debug, Default)]
pub(super) struct RememberedBlocks {
    known: Mutex<Vec<Known>>,
}

#[derive(Debug)]
struct Known {
    listed: Vec<usize>,
    ranges: Vec<Range<usize>>,
    blocks: Arc<Vec<NuisanceBlock>>,
}

impl RememberedBlocks {
    /// Blocks of the instants `listed`, of which each is one of `ranges`: known ones, or what `make` makes.
    pub(super) fn of(
        &self,
        listed: &[usize],
        ranges: &[Range<usize>],
        make: impl FnOnce() -> Vec<NuisanceBlock>,
    ) -> Arc<Vec<NuisanceBlock>> {
        let lock = || self.known.lock().unwrap_or_else(PoisonError::into_inner);
        let same = |known: &&Known| known.ranges == ranges && known.listed == listed;
        let known = lock().iter().find(same).map(|known| known.blocks.clone());
        known.unwrap_or_else(|| {
            // Not under the lock: what makes them in parallel may ask for others meanwhile.
            let blocks = Arc::new(make());
            let mut kept = lock();
            kept.truncate(KEPT - 1);
            kept.insert(0, Known { listed: listed.to_vec(), ranges: ranges.to_vec(), blocks: blocks.clone() });
            blocks
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_are_made_once_for_every_set_of_instants() {
        let remembered = RememberedBlocks::default();
        let made = std::cell::Cell::new(0);
        let ask = |listed: &[usize]| {
            let block = 0..listed.len();
            let products = remembered.of(listed, std::slice::from_ref(&block), || {
                made.set(made.get() + 1);
                let rows = DMatrix::from_element(1, listed.len(), 1.0);
                vec![NuisanceBlock { products: &rows * rows.transpose(), rows: Arc::new(rows) }]
            });
            assert_eq!(products[0].products[(0, 0)], listed.len() as f64);
            made.get()
        };
        assert_eq!((ask(&[1, 2]), ask(&[3]), ask(&[1, 2]), ask(&[3])), (1, 2, 2, 2));
        // The one that was asked for first makes way.
        assert_eq!((ask(&[4, 5, 6]), ask(&[3]), ask(&[1, 2])), (3, 3, 4));
    }
}
