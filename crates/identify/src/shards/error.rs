//! Why shards cannot be put together.

use crate::error::IdentifyError;

/// Why shards cannot be put together; every message names the place and the remedy.
#[derive(Debug, thiserror::Error)]
pub enum ShardError {
    /// Something about the recordings.
    #[error(transparent)]
    Identify(#[from] IdentifyError),
    /// A shard of a recording is not there.
    #[error("{recording}: shard {number} of {of} is missing; name its summary, too")]
    Missing {
        /// Recording.
        recording: String,
        /// Number of the shard.
        number: usize,
        /// Shards of the recording.
        of: usize,
    },
    /// The same rows twice.
    #[error("{path}: is there twice ({as_one} and {as_other}); name every shard once")]
    Twice {
        /// Path of the shard.
        path: String,
        /// What it is said to be.
        as_one: String,
        /// What it is said to be as well.
        as_other: String,
    },
    /// Shards say that the recording was cut into different numbers of them.
    #[error("{recording}: one shard says that there are {one} of them, another {other}; write their summaries anew")]
    Count {
        /// Recording.
        recording: String,
        /// One number.
        one: usize,
        /// The other.
        other: usize,
    },
    /// A shard begins before the one before it has ended.
    #[error(
        "{recording}: shard {number} begins at {begins_s:.3} s, before shard {before} ends at {ends_s:.3} s: they overlap, or \
         are in another order; shards of one recording go on in one time, which dates that count from every file's first row do not"
    )]
    Overlap {
        /// Recording.
        recording: String,
        /// Number of the shard.
        number: usize,
        /// When it begins, in s.
        begins_s: f64,
        /// Number of the one before.
        before: usize,
        /// When that ends, in s.
        ends_s: f64,
    },
    /// Shards that were made otherwise.
    #[error("{path}: was made with another {what} than {other}; write its summary anew")]
    Differs {
        /// Path of the shard.
        path: String,
        /// What is another.
        what: &'static str,
        /// The one that it differs from.
        other: String,
    },
    /// A summary that answers another question.
    #[error(
        "{path}: answers pass {found}, and pass {asked} is asked for; run it again with --summary-only and --agreement"
    )]
    Pass {
        /// Path of the shard.
        path: String,
        /// Pass that it answers.
        found: u32,
        /// Pass that is asked for.
        asked: u32,
    },
    /// A shard that the agreement does not know.
    #[error(
        "{path}: the agreement is of other shards; name those that it began with, or begin anew with an agreement that is \
         not there yet"
    )]
    Unknown {
        /// Path of the shard.
        path: String,
    },
    /// Rows that a summary should hold and does not.
    #[error("{path}: its summary lacks what pass {pass} asks for; write it anew")]
    Lacks {
        /// Path of the shard.
        path: String,
        /// Pass that it should answer.
        pass: u32,
    },
    /// A clock that is faster than the edges are long.
    #[error("{recording}: {rate_hz:.0} rows per second are more than shards can be cut at; identify it in one")]
    TooFast {
        /// Recording.
        recording: String,
        /// Rows per second.
        rate_hz: f64,
    },
}
