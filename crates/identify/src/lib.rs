//! Recordings and a force model in, parameters with uncertainty out.
