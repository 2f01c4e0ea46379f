//! The proof on real muscles.
