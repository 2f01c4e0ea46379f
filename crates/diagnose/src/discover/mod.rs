//! A mismatch without a name gets an equation.
//!
//! Where something is left that no effect of the catalogue explains, the [sentence](pam_muscle::effects::sentence) of the grammar
//! that foretells held-out blocks best, for its degrees of freedom, is fitted jointly with the base and what was named. It is
//! written only where held-out recordings, or where there are none the blocks, are foretold better with it: at the rate of the
//! recordings, as programs will evaluate it, by more than the standard error of the gain, and better than by the model as given.
//! Where they deny the best, the next is asked for, and of those that blocks hardly tell apart they choose one. Where draws of the
//! blocks do not agree on its driver and its memory, nothing is written: it would follow the recordings, and say the wrong thing.
//!
//! In reading order: [`discovery`] goes on as long as something gains; [`lexicon`] is what sentences are made of, [`field`]
//! judges one, [`screen`] finds the best, [`joined`] fits it with everything else, [`held_error`](crate::held_error) asks what
//! was held out, [`replaced`] whether it takes the place of a name, [`bends`] whether the term is another form of what was named,
//! [`stability`] whether other draws of blocks would choose it; [`written`], [`curve`], [`nearest`] and [`said`] are what a person reads
//! of it.

mod bends;
mod curve;
mod discovery;
mod field;
mod joined;
mod lexicon;
mod nearest;
mod replaced;
mod said;
mod screen;
mod stability;
mod written;

pub(crate) use discovery::{Discovery, HeldAgainst};
pub(crate) use replaced::beside_names;
pub(crate) use written::statement;
