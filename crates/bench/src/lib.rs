//! The virtual bench: protocols, true mechanisms, sensors.
