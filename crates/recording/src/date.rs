//! Time stamps as dates: `2026-11-23T10:15:02.125`, with a blank for the T, with an offset or a Z, or the time of day
//! alone; and as loggers in German write them, `23.11.2026 10:15:02,125`.

use jiff::civil;
use jiff::fmt::temporal::DateTimeParser;

const PARSER: DateTimeParser = DateTimeParser::new();

/// Seconds since the beginning of 1970, or of the day where there is only a time of day; none where `field` is no stamp.
pub(crate) fn stamp_s(field: &[u8]) -> Option<f64> {
    let mut rearranged = [0_u8; 64];
    let text = match field {
        // Day, month and year, by dots: no country writes the month first that way.
        [d1, d2, b'.', m1, m2, b'.', y1, y2, y3, y4, rest @ ..] if rest.len() < 48 => {
            let date = [*y1, *y2, *y3, *y4, b'-', *m1, *m2, b'-', *d1, *d2];
            rearranged[..10].copy_from_slice(&date);
            rearranged[10..10 + rest.len()].copy_from_slice(rest);
            &rearranged[..10 + rest.len()]
        }
        [b'0'..=b'9', b'0'..=b'9', b':', ..] => return PARSER.parse_time(field).ok().map(seconds_of_day),
        _ => field,
    };
    // A number is no date, however it is written.
    if text.len() < 16 || text.get(4) != Some(&b'-') {
        return None;
    }
    let pieces = PARSER.parse_pieces(text).ok()?;
    let since = civil::date(1970, 1, 1).until((jiff::Unit::Day, pieces.date())).ok()?;
    let offset_s = pieces.to_numeric_offset().map_or(0, |offset| offset.seconds());
    Some(f64::from(since.get_days()) * 86_400.0 - f64::from(offset_s) + seconds_of_day(pieces.time()?))
}

fn seconds_of_day(time: civil::Time) -> f64 {
    let whole = i32::from(time.hour()) * 3600 + i32::from(time.minute()) * 60 + i32::from(time.second());
    f64::from(whole) + f64::from(time.subsec_nanosecond()) * 1e-9
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stamps_of_many_loggers_mean_the_same_instant() {
        let instant = 1_795_428_902.125;
        for text in [
            "2026-11-23T10:15:02.125",
            "2026-11-23 10:15:02.125",
            "2026-11-23T10:15:02,125",
            "2026-11-23T10:15:02.125Z",
            "2026-11-23T12:15:02.125+02:00",
            "23.11.2026 10:15:02,125",
            "23.11.2026T10:15:02.125",
        ] {
            assert_eq!(stamp_s(text.as_bytes()), Some(instant), "{text}");
        }
        assert_eq!(stamp_s(b"10:15:02.125"), Some(36_902.125));
    }

    #[test]
    fn what_is_no_stamp_is_none() {
        for text in ["", "12.5", "2026", "2026-11-23", "11/23/2026 10:15", "23.13.2026 10:15:02", "1:2", "20261123"] {
            assert_eq!(stamp_s(text.as_bytes()), None, "{text}");
        }
    }
}
