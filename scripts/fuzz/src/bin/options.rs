//! What a command line says about columns: lists, names, constants, calibrations.

#![no_main]

use libfuzzer_sys::fuzz_target;
use pam_recording::{Calibration, ColumnMap, Columns, FixedChannel};

fuzz_target!(|text: &str| {
    let _ = text.parse::<Columns>().map_err(|error| error.to_string());
    let _ = text.parse::<ColumnMap>().map_err(|error| error.to_string());
    if let Ok(fixed) = text.parse::<FixedChannel>().map_err(|error| error.to_string()) {
        assert!(fixed.value.is_finite());
    }
    if let Ok(line) = text.parse::<Calibration>().map_err(|error| error.to_string()) {
        assert!(line.gain.is_finite() && line.gain != 0.0 && line.offset.is_finite());
    }
});
