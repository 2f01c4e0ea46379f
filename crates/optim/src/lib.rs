//! Particle swarm and least squares over plain slices; knows no muscle.
