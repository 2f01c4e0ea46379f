//! Recordings in every dialect, compressed or not; then the gate, the look for faults, and a short fit.
//!
//! The first byte chooses the options, the others are the file.

#![no_main]

use libfuzzer_sys::fuzz_target;
use pam_fuzz::{fit_shortly, nominal_model, nominal_muscle, with_file};
use pam_identification::predict::{augmented_forces_n, outside, prepare};
use pam_recording::quality::RecordingQuality;
use pam_recording::{ReadOptions, read_recording};

fn options(choice: u8) -> ReadOptions {
    let mut options = ReadOptions {
        skip_bad_rows: choice & 1 != 0,
        force_required: choice & 2 != 0,
        // A recording larger than memory, with eight rows instead of millions.
        memory_rows: if choice & 4 != 0 { 8 } else { ReadOptions::default().memory_rows },
        ..ReadOptions::default()
    };
    if choice & 8 != 0 {
        options.columns = Some("time_s,pressure_kPa,length_mm,force_N,-".parse().expect("columns"));
    }
    if choice & 16 != 0 {
        options.map = vec!["pressure_bar=P [V]".parse().expect("a map"), "time_ms=t".parse().expect("a map")];
    }
    if choice & 32 != 0 {
        options.fixed = vec!["length_mm=250".parse().expect("a constant")];
    }
    if choice & 64 != 0 {
        options.calibrate = vec!["force_N = -2.5 * ai0 + 3".parse().expect("a calibration")];
    }
    options
}

fuzz_target!(|data: &[u8]| {
    let Some((&choice, bytes)) = data.split_first() else { return };
    let read = || with_file(bytes, |path| read_recording(path, &options(choice)));
    let Ok(recording) = read() else { return };
    let rows = recording.samples.n_rows();
    assert_eq!(recording.segments.iter().map(ExactSizeIterator::len).sum::<usize>(), rows);
    RecordingQuality::of(&recording).expect("samples that were just written");
    let model = nominal_model();
    if let Ok(prepared) = prepare(recording, &model) {
        let _ = outside(&prepared, &model.domain);
        let augmented = model.augmented_model();
        let _ = augmented_forces_n(&prepared, &augmented, model.direction);
    }
    // A fit takes a hundred times as long as all of the above.
    if bytes.len() % 16 == 0
        && let Ok(recording) = read()
    {
        fit_shortly(nominal_muscle(), recording, choice & 128 != 0);
    }
});
