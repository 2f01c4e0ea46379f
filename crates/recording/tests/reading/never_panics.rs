//! Whatever the bytes, the reader answers with a recording or with one line.

use pam_recording::{Calibration, ColumnMap, Columns, FixedChannel, ReadOptions};
use proptest::prelude::*;

use super::{options, read, rows};

/// Reads, and checks what must hold of any answer.
fn check(text: &[u8], options: &ReadOptions) {
    match read(text, options) {
        Ok(recording) => {
            let rows = rows(&recording);
            assert!(rows.len() >= 2);
            assert!(rows.windows(2).all(|pair| pair[1][0] > pair[0][0]), "time goes on");
            assert!(rows.iter().flat_map(|row| &row[..3]).all(|value| value.is_finite()));
            let mut next = 0;
            for segment in &recording.segments {
                assert!(segment.start == next && segment.end > segment.start);
                next = segment.end;
            }
            assert_eq!(next, rows.len());
            assert_eq!(recording.repairs.gaps as usize + 1, recording.segments.len());
        }
        Err(error) => {
            let message = error.to_string();
            assert!(message.starts_with("log.csv:"), "{message:?}");
            assert!(message.len() > 20 && message.len() < 2000, "{message:?}");
            assert!(!message.contains(char::is_control), "{message:?}");
        }
    }
}

fn every_way(text: &[u8]) {
    for options in [
        ReadOptions::default(),
        options(["--skip-bad-rows"]),
        options(["--columns time_s,pressure_kPa,length_mm,force_N", "--skip-bad-rows"]),
        options(["--columns force_N,-,time_ms", "--fixed pressure_kPa=1", "--calibrate length_mm = 2 * force_N"]),
    ] {
        check(text, &options);
    }
}

/// A small log with a choice of separator and line end.
fn log() -> impl Strategy<Value = Vec<u8>> {
    let rows = prop::collection::vec((0_u16..50, -5.0..5.0_f64, any::<bool>()), 0..60);
    (rows, prop::sample::select(vec![",", ";", "\t"]), prop::sample::select(vec!["\n", "\r\n"])).prop_map(
        |(rows, separator, end)| {
            let mut text = ["time_ms", "pressure_kPa", "length_mm", "force_N"].join(separator) + end;
            let mut time_ms = 0;
            for (step, value, far) in rows {
                time_ms += if far { u32::from(step) * 10 } else { u32::from(step) % 3 };
                text += &[time_ms.to_string(), "100".to_owned(), "200".to_owned(), value.to_string()].join(separator);
                text += end;
            }
            text.into_bytes()
        },
    )
}

/// Damage that loggers, editors and serial links do to a file.
fn mutation() -> impl Strategy<Value = (prop::sample::Index, Vec<u8>, usize)> {
    let pieces =
        ["\"", ",", ";", "\n", "\r", "\0", "nan", "-", "1e999", "#", "\u{feff}", "time_s", "99999999", "0", " "];
    let piece = prop_oneof![
        prop::sample::select(pieces.map(|piece| piece.as_bytes().to_vec()).to_vec()),
        prop::collection::vec(any::<u8>(), 0..8),
    ];
    (any::<prop::sample::Index>(), piece, 0_usize..12)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 256, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn random_bytes(text in prop::collection::vec(any::<u8>(), 0..400)) {
        every_way(&text);
    }

    #[test]
    fn random_text(text in "[-0-9.,;\t\n\r\"# etimfornghps_NkPa]{0,300}") {
        every_way(text.as_bytes());
    }

    #[test]
    fn broken_logs(log in log(), mutations in prop::collection::vec(mutation(), 0..6)) {
        let mut text = log;
        for (index, piece, dropped) in mutations {
            let from = index.index(text.len() + 1).min(text.len());
            let to = (from + dropped).min(text.len());
            text.splice(from..to, piece);
        }
        every_way(&text);
    }

    #[test]
    fn compressed_bytes(text in prop::collection::vec(any::<u8>(), 0..200)) {
        every_way(&[b"\x1f\x8b\x08".as_slice(), &text].concat());
    }

    #[test]
    fn options_of_any_text(text in "[-a-z0-9 =*/+._,\"\\[\\]()%é]{0,40}", target in "(pressure_kPa|force_N|time_s|x)? ?=?") {
        let text = target + &text;
        let messages = [
            text.parse::<Columns>().err().map(|error| error.to_string()),
            text.parse::<ColumnMap>().err().map(|error| error.to_string()),
            text.parse::<FixedChannel>().err().map(|error| error.to_string()),
            text.parse::<Calibration>().err().map(|error| error.to_string()),
        ];
        for message in messages.into_iter().flatten() {
            prop_assert!(message.len() > 20 && !message.contains('\n'), "{message:?}");
        }
    }
}
